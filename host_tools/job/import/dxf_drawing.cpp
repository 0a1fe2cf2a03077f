// Sections are found by their names; unknown ones are skipped.
#include "host_tools/job/import/dxf_drawing.hpp"

#include <cctype>
#include <charconv>
#include <cmath>

#include "firmware/base/inch.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/number_text/number_text.hpp"
#include "host_tools/job/import/dxf_text.hpp"
#include "host_tools/job/import/dxf_units.hpp"

#include "fmt/format.h"

namespace cusp::import {
using number_text::number_of;

namespace {

std::string_view trimmed(std::string_view text)
{
    const auto first = text.find_first_not_of(" \t\r");
    const auto last = text.find_last_not_of(" \t\r");
    return first == std::string_view::npos ? std::string_view{}
                                           : text.substr(first, last - first + 1);
}

std::string upper(std::string_view text)
{
    std::string out{text};
    std::transform(out.begin(), out.end(), out.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return out;
}

}  // namespace

DxfDrawing::DxfDrawing(std::string file, double millimetres)
    : file_{std::move(file)}, text_{dxf_text(files::text_of_file(file_), file_)}, unit_{millimetres}
{
    groups_ = groups();
    read_unit();
    read_layers();
    read_blocks();
    bool found = false;
    entities_ = section("ENTITIES", found);
    if (!found) {
        throw InputError(file_ + ": no DXF drawing with an ENTITIES section");
    }
}

void DxfDrawing::refuse(int line, const std::string& reason) const
{
    throw InputError(fmt::format("{}:{}: {}", file_, line, reason));
}

std::vector<DxfGroup> DxfDrawing::groups() const
{
    std::vector<DxfGroup> out;
    std::string_view rest{text_};
    int line = 0;
    const auto next = [&] {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view text = trimmed(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
        ++line;
        return text;
    };
    while (!rest.empty()) {
        const std::string_view code = next();
        if (code.empty() && rest.empty()) {
            break;
        }
        int number = 0;
        const auto [end, error] = std::from_chars(code.data(), code.data() + code.size(), number);
        if (error != std::errc{} || end != code.data() + code.size()) {
            refuse(line, fmt::format("\"{}\" is no DXF group code", code.substr(0, 40)));
        }
        if (rest.empty()) {
            refuse(line, "the drawing ends after a group code");
        }
        const std::string_view text = next();
        out.push_back({number, text, line});
    }
    return out;
}

// The objects of one section, each from its code 0 on.
std::vector<DxfEntity> DxfDrawing::section(std::string_view wanted, bool& found) const
{
    std::vector<DxfEntity> out;
    bool inside = false;
    bool names_section = false;
    for (const DxfGroup& group : groups_) {
        if (names_section && group.code == 2) {
            inside = group.value == wanted;
            found = found || inside;
        }
        names_section = group.code == 0 && group.value == "SECTION";
        if (group.code == 0 && group.value == "ENDSEC") {
            inside = false;
        } else if (inside && group.code == 0) {
            out.push_back({group.value, group.line, {}});
        } else if (inside && !out.empty()) {
            out.back().groups.push_back(group);
        }
    }
    return out;
}

// The first group of a variable of the header; nullptr: there is none.
const DxfGroup* DxfDrawing::header_value(std::string_view name) const
{
    bool asked = false;
    for (const DxfGroup& group : groups_) {
        if (asked && group.code != 9) {
            return &group;
        }
        asked = group.code == 9 && group.value == name;
        if (group.code == 0 && group.value == "ENDSEC") {
            break;  // of the header, the first section
        }
    }
    return nullptr;
}

void DxfDrawing::read_unit()
{
    const double assumed = unit_;
    const DxfGroup* insertion = header_value("$INSUNITS");
    const DxfGroup* measurement = header_value("$MEASUREMENT");
    if (insertion != nullptr && number(*insertion) != 0) {
        const double code = number(*insertion);
        const bool small = std::abs(code) < 1000;
        const DxfUnit* unit = small ? dxf_unit(static_cast<int>(code)) : nullptr;
        if (unit == nullptr || code != std::floor(code)) {
            refuse(insertion->line,
                   fmt::format("$INSUNITS {:g} names no unit: known are 0 (none) to 24", code));
        }
        if (unit->millimetres == 0) {
            refuse(insertion->line, fmt::format("$INSUNITS {:g}: the drawing is in {}: no unit of "
                                                "parts",
                                                code, unit->name));
        }
        unit_ = unit->millimetres;
        unit_name_ = unit->name;
        unit_note_ = fmt::format("$INSUNITS {:g} says {}", code, unit_name_);
    } else if (measurement != nullptr) {
        const bool metric = number(*measurement) != 0;
        unit_ = metric ? 1.0 : kMillimetresPerInch;
        unit_name_ = metric ? "millimetres" : "inches";
        unit_note_ = fmt::format("no $INSUNITS, its $MEASUREMENT says {}", unit_name_);
    }
    unit_note_ = unit_ == assumed ? ""
                                  : fmt::format("{}: {}: 1 unit of the drawing is {:.10g} mm",
                                                file_, unit_note_, unit_);
}

template <class Visit>
void DxfDrawing::each_group(const Visit& visit) const
{
    const auto each = [&](const std::vector<DxfEntity>& entities) {
        for (const DxfEntity& entity : entities) {
            for (const DxfGroup& group : entity.groups) {
                visit(group);
            }
        }
    };
    each(entities_);
    for (const auto& [name, block] : blocks_) {
        each(block.entities);
    }
}

double DxfDrawing::resolution() const
{
    std::size_t most = 0;
    each_group([&](const DxfGroup& group) {
        const bool coordinate =
            group.code == 10 || group.code == 11 || group.code == 20 || group.code == 21;
        const std::size_t point = group.value.find('.');
        if (coordinate && point != std::string_view::npos) {
            const bool exponent = group.value.find_first_of("eE") != std::string_view::npos;
            const std::size_t last = group.value.find_last_not_of('0');
            most = std::max(most, exponent ? group.value.size() : last - point);
        }
    });
    constexpr std::size_t kMostDigits = 22;
    const auto digits = static_cast<int>(std::min(most, kMostDigits));
    return digits == 0 ? 0 : unit_ * elementary::power_of_ten(-digits);
}

bool DxfDrawing::has_depth() const
{
    bool found = false;
    each_group([&](const DxfGroup& group) {
        // z of points, elevation, x and y of the direction of extrusion
        const bool asked = (group.code >= 30 && group.code <= 33) || group.code == 38 ||
                           group.code == 210 || group.code == 220;
        found = found || (asked && group.value.find_first_of("123456789") < group.value.size());
    });
    return found;
}

void DxfDrawing::read_layers()
{
    bool found = false;
    for (const DxfEntity& table : section("TABLES", found)) {
        if (table.type != "LAYER") {
            continue;
        }
        const bool frozen = (flags(table, 70) & 1U) != 0;
        if (frozen || value(table, 62, 1) < 0) {
            hidden_.insert(text(table, 2, ""));
        }
    }
}

void DxfDrawing::read_blocks()
{
    bool found = false;
    DxfBlock* open = nullptr;
    for (DxfEntity& entity : section("BLOCKS", found)) {
        if (entity.type == "BLOCK") {
            const std::string name = upper(text(entity, 2, ""));
            open = &blocks_[name];
            *open = {std::move(entity), {}};
        } else if (entity.type == "ENDBLK") {
            open = nullptr;
        } else if (open != nullptr) {
            open->entities.push_back(std::move(entity));
        }
    }
}

const DxfBlock* DxfDrawing::block(std::string_view name) const
{
    const auto at = blocks_.find(upper(name));
    return at == blocks_.end() ? nullptr : &at->second;
}

std::set<std::string> DxfDrawing::layers() const
{
    std::set<std::string> names;
    const auto add = [&names](const std::vector<DxfEntity>& entities) {
        for (const DxfEntity& entity : entities) {
            names.emplace(text(entity, 8, "0"));
        }
    };
    add(entities_);
    for (const auto& [name, block] : blocks_) {
        add(block.entities);
    }
    return names;
}

std::string_view DxfDrawing::text(const DxfEntity& entity, int code, std::string_view otherwise)
{
    for (const DxfGroup& group : entity.groups) {
        if (group.code == code) {
            return group.value;
        }
    }
    return otherwise;
}

double DxfDrawing::number(const DxfGroup& group) const
{
    const auto value = number_of(group.value);
    if (!value || !std::isfinite(*value)) {
        refuse(group.line, fmt::format("\"{}\" is not a number", group.value.substr(0, 40)));
    }
    return *value;
}

double DxfDrawing::value(const DxfEntity& entity, int code, double otherwise) const
{
    for (const DxfGroup& group : entity.groups) {
        if (group.code == code) {
            return number(group);
        }
    }
    return otherwise;
}

double DxfDrawing::required(const DxfEntity& entity, int code) const
{
    const bool there = std::any_of(entity.groups.begin(), entity.groups.end(),
                                   [&](const DxfGroup& group) { return group.code == code; });
    if (!there) {
        refuse(entity.line, fmt::format("{} without group {}", entity.type, code));
    }
    return value(entity, code, 0);
}

std::vector<double> DxfDrawing::values(const DxfEntity& entity, int code) const
{
    std::vector<double> out;
    for (const DxfGroup& group : entity.groups) {
        if (group.code == code) {
            out.push_back(number(group));
        }
    }
    return out;
}

}  // namespace cusp::import
