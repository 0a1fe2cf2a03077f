// A set-up has a name, a work offset of its own, and a flip.
#include "host_tools/job/import/setup_reader.hpp"

#include <algorithm>
#include <cctype>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/job_key_tables.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

using job::Flip;
using job::Setup;

namespace {

constexpr int kFirstOffset = 54;
constexpr int kLastOffset = 59;

// Names are parts of file names.
bool is_plain(const std::string& name)
{
    return !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '_' || c == '-';
    });
}

Setup read_setup(JobTable& keys, std::size_t index)
{
    Setup setup;
    setup.name = keys.text("name").value();
    if (!is_plain(setup.name)) {
        keys.refuse("name",
                    fmt::format("is \"{}\": letters, digits, _ and - only, for it is part of the "
                                "program's file name",
                                setup.name));
    }
    const int by_place = std::min(kFirstOffset + static_cast<int>(index), kLastOffset);
    const std::string offset = keys.choice("offset").value_or(fmt::format("G{}", by_place));
    setup.offset = std::stoi(offset.substr(1));
    setup.flip = keys.chosen("flip", {Flip::kX, Flip::kY}).value_or(Flip::kNone);
    return setup;
}

}  // namespace

SetupTables::SetupTables(JobTable& top,
                         const std::string& file,
                         const std::vector<job::Key>& operation_keys)
    : file_{file}, operation_keys_{operation_keys}
{
    for (JobTable& keys : top.each("setup", setup_table())) {
        const Setup setup = read_setup(keys, setups_.size());
        for (const Setup& other : setups_) {
            if (other.name == setup.name) {
                keys.refuse("name",
                            fmt::format("is \"{}\", and so is that of another set-up", setup.name));
            }
            if (other.offset == setup.offset) {
                keys.refuse("offset",
                            fmt::format("is G{}, and so is that of the set-up \"{}\": each has "
                                        "its own, by which a program says what it is for",
                                        setup.offset, other.name));
            }
        }
        keys.check_all_read();
        setups_.push_back(setup);
    }
}

std::string SetupTables::names() const
{
    std::vector<std::string> all;
    std::transform(setups_.begin(), setups_.end(), std::back_inserter(all),
                   [](const Setup& setup) { return "\"" + setup.name + "\""; });
    return fmt::format("{}", fmt::join(all, ", "));
}

std::size_t SetupTables::place_of(JobTable& table) const
{
    const auto name = table.text("setup");
    if (!name) {
        return 0;
    }
    const auto found = std::find_if(setups_.begin(), setups_.end(),
                                    [&](const Setup& setup) { return setup.name == *name; });
    if (found == setups_.end()) {
        table.refuse("setup", fmt::format("is \"{}\", {}", *name,
                                          setups_.empty() ? "but the job has no [[setup]]"
                                                          : "set-ups of the job are " + names()));
    }
    return static_cast<std::size_t>(found - setups_.begin());
}

std::size_t SetupTables::place_of(const toml::table& operation, std::size_t index) const
{
    JobTable table{operation, file_, fmt::format("operation {}", index), operation_keys_};
    return place_of(table);
}

void SetupTables::check_used(const std::vector<const toml::table*>& operations) const
{
    std::vector<bool> used(std::max<std::size_t>(1, setups_.size()), false);
    for (std::size_t i = 0; i < operations.size(); ++i) {
        used[place_of(*operations[i], i + 1)] = true;
    }
    for (std::size_t i = 0; i < setups_.size(); ++i) {
        if (!used[i]) {
            throw InputError(
                fmt::format("{}: setup {}: no operation is in \"{}\": say setup = \"{}\" in "
                            "those that are",
                            file_, i + 1, setups_[i].name, setups_[i].name));
        }
    }
}

Similarity SetupTables::turn_of(const Setup& setup, const job::Job& job, bool has_top) const
{
    if (std::all_of(setups_.begin(), setups_.end(),
                    [](const Setup& s) { return s.flip == Flip::kNone; })) {
        return {};
    }
    if (!job.stock_x || !job.stock_y || !job.stock_bottom || !has_top) {
        throw InputError(
            fmt::format("{}: a set-up with a flip needs the stock's box, about whose middle "
                        "it is turned over: x and y or an outline, top and bottom in [stock]",
                        file_));
    }
    const Vec3d signs = job::turn_signs(Flip::kNone, setup.flip);
    Similarity turn;
    turn.axes = {Vec3d{signs.x, 0, 0}, Vec3d{0, signs.y, 0}, Vec3d{0, 0, signs.z}};
    const auto shift = [](double sign, double low, double high) {
        return sign < 0 ? low + high : 0.0;
    };
    turn.shift = {shift(signs.x, (*job.stock_x)[0], (*job.stock_x)[1]),
                  shift(signs.y, (*job.stock_y)[0], (*job.stock_y)[1]),
                  shift(signs.z, *job.stock_bottom, job.stock_top)};
    return turn;
}

}  // namespace cusp::import
