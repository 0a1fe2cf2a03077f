// Typed access to a TOML table; every error names its place.
#include "host_tools/job/import/job_table.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/job_text.hpp"
#include "host_tools/job/import/nearest_name.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {
namespace {

std::string range_in_words(job::Range range)
{
    const char* low = range.above_low ? "above" : "at least";
    return fmt::format("{} {:g} and at most {:g}", low, range.low, range.high);
}

// As in the file, in one line. toml++ 3.2 can't write lists: it takes the logarithm of fractions for a count of columns.
std::string text_of(const toml::node& node)
{
    std::vector<std::string> parts;
    if (const toml::array* const list = node.as_array()) {
        std::transform(list->begin(), list->end(), std::back_inserter(parts), text_of);
        return fmt::format("[{}]", fmt::join(parts, ", "));
    }
    if (const toml::table* const members = node.as_table()) {
        for (const auto& member : *members) {
            parts.push_back(
                fmt::format("{} = {}", std::string{member.first.str()}, text_of(member.second)));
        }
        return fmt::format("{{{}}}", fmt::join(parts, ", "));
    }
    std::ostringstream text;
    node.visit([&](const auto& value) { text << value; });
    return text.str();
}

}  // namespace

toml::table parsed_toml(const std::string& text, const std::string& file)
{
    check_plain_text(text, file);
    try {
        return toml::parse(text, file);
    } catch (const toml::parse_error& error) {
        const auto line = error.source().begin.line;
        throw InputError(fmt::format("{}:{}: not TOML: {}", file, line, error.description()),
                         {file, line});
    }
}

JobTable::JobTable(const toml::table& table,
                   std::string file,
                   std::string place,
                   std::vector<job::Key> known,
                   std::vector<job::Key> elsewhere)
    : table_{table},
      file_{std::move(file)},
      place_{std::move(place)},
      known_{std::move(known)},
      elsewhere_{std::move(elsewhere)}
{
    refuse_unknown_keys();
}

// The line of the table if it has no such key.
toml::source_index JobTable::line_of(const char* key) const
{
    const toml::node* node = table_.get(key);
    return std::max((node != nullptr ? node->source() : table_.source()).begin.line,
                    toml::source_index{1});
}

std::string JobTable::place_of(const char* key) const
{
    const std::string dot = place_.empty() ? "" : place_ + ": ";
    return fmt::format("{}:{}: {}{}", file_, line_of(key), dot, key);
}

void JobTable::refuse(const char* key, const std::string& reason, const std::string& limit) const
{
    const toml::node* node = table_.get(key);
    throw InputError(
        fmt::format("{}: {}", place_of(key), reason),
        {file_, line_of(key), key, node == nullptr ? "" : text_of(*node), limit, place_});
}

const job::Key& JobTable::key_of(const char* key) const
{
    const job::Key* found = job::find_key(known_, key);
    found = found == nullptr ? job::find_key(elsewhere_, key) : found;
    if (found == nullptr) {
        throw std::logic_error(fmt::format("the key {} is read but not known", key));
    }
    return *found;
}

const toml::node* JobTable::find(const char* key)
{
    key_of(key);
    read_.insert(key);
    return table_.get(key);
}

double JobTable::checked(const toml::node& node, const char* key) const
{
    const job::Range range = key_of(key).range;
    const auto value = node.value<double>();
    if (!value || !node.is_number()) {
        refuse(key, "a number is needed");
    }
    const bool low_enough = *value <= range.high;
    const bool high_enough = range.above_low ? *value > range.low : *value >= range.low;
    if (!low_enough || !high_enough) {
        const std::string limit = range_in_words(range);
        refuse(key, fmt::format("is {:g}, it must be {}", *value, limit), limit);
    }
    return *value;
}

std::optional<double> JobTable::number(const char* key)
{
    const toml::node* node = find(key);
    return node == nullptr ? std::nullopt : std::optional{checked(*node, key)};
}

std::optional<double> JobTable::length(const char* key, double millimetres)
{
    const auto value = number(key);
    return value ? std::optional{*value * millimetres} : std::nullopt;
}

std::optional<int> JobTable::whole_number(const char* key)
{
    const std::optional<double> value = number(key);
    if (!value) {
        return std::nullopt;
    }
    if (*value != std::floor(*value)) {
        refuse(key, fmt::format("is {:g}, a whole number is needed", *value));
    }
    return static_cast<int>(*value);
}

std::optional<bool> JobTable::flag(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) {
        return std::nullopt;
    }
    if (!node->is_boolean()) {
        refuse(key, "true or false is needed");
    }
    return node->value<bool>();
}

bool JobTable::is_text(const char* key) const
{
    const toml::node* node = table_.get(key);
    const toml::array* list = node == nullptr ? nullptr : node->as_array();
    return list == nullptr ? node != nullptr && node->is_string()
                           : !list->empty() && list->front().is_string();
}

std::optional<std::string> JobTable::text(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) {
        return std::nullopt;
    }
    if (!node->is_string()) {
        refuse(key, "a text in quotes is needed");
    }
    return node->value<std::string>();
}

std::optional<std::string> JobTable::choice(const char* key)
{
    const std::optional<std::string> value = text(key);
    const std::vector<std::string>& allowed = key_of(key).choices;
    if (value && std::find(allowed.begin(), allowed.end(), *value) == allowed.end()) {
        refuse(key,
               fmt::format("is \"{}\", known are \"{}\"", *value, fmt::join(allowed, "\", \"")));
    }
    return value;
}

std::optional<std::vector<double>> JobTable::one_or_more(const char* key)
{
    const toml::node* node = find(key);
    if (node != nullptr && node->is_number()) {
        return std::vector<double>{checked(*node, key)};
    }
    return numbers(key);
}

std::optional<std::vector<double>> JobTable::numbers(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) {
        return std::nullopt;
    }
    if (!node->is_array()) {
        refuse(key, "a list of numbers is needed");
    }
    std::vector<double> out;
    for (const toml::node& entry : *node->as_array()) {
        out.push_back(checked(entry, key));
    }
    return out;
}

std::optional<std::vector<std::array<double, 2>>> JobTable::pairs(const char* key,
                                                                  const char* words)
{
    const toml::node* node = find(key);
    if (node == nullptr) {
        return std::nullopt;
    }
    const auto refuse_form = [&] {
        refuse(key, fmt::format("a list of pairs is needed: [{}, ...]", words));
    };
    if (!node->is_array()) {
        refuse_form();
    }
    std::vector<std::array<double, 2>> out;
    for (const toml::node& entry : *node->as_array()) {
        const toml::array* pair = entry.as_array();
        if (pair == nullptr || pair->size() != 2) {
            refuse_form();
        }
        out.push_back({checked((*pair)[0], key), checked((*pair)[1], key)});
    }
    return out;
}

std::optional<std::array<double, 2>> JobTable::interval(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) {
        return std::nullopt;
    }
    if (!node->is_array()) {
        const double value = checked(*node, key);
        return std::array{value, value};
    }
    const std::vector<double> ends = *numbers(key);
    if (ends.size() != 2 || ends[0] > ends[1]) {
        refuse(key, "a number is needed, or two: [least, greatest]");
    }
    return std::array{ends[0], ends[1]};
}

std::optional<std::array<double, 2>> JobTable::extent(const char* key, double millimetres)
{
    const auto ends = numbers(key);
    if (!ends) {
        return std::nullopt;
    }
    if (ends->size() != 2 || !((*ends)[0] < (*ends)[1])) {
        refuse(key, "two numbers [min, max] are needed, min below max");
    }
    return std::array{(*ends)[0] * millimetres, (*ends)[1] * millimetres};
}

std::optional<std::vector<std::string>> JobTable::texts(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) {
        return std::nullopt;
    }
    std::vector<std::string> out;
    if (node->is_string()) {
        out.push_back(*node->value<std::string>());
    } else if (node->is_array()) {
        for (const toml::node& entry : *node->as_array()) {
            if (entry.is_string()) {
                out.push_back(*entry.value<std::string>());
            }
        }
    }
    if (node->is_array() ? out.size() != node->as_array()->size() : out.empty()) {
        refuse(key, "a list of texts in quotes is needed");
    }
    const std::vector<std::string>& allowed = key_of(key).choices;
    for (const std::string& each : out) {
        if (!allowed.empty() && std::find(allowed.begin(), allowed.end(), each) == allowed.end()) {
            refuse(key, fmt::format("holds \"{}\", known are \"{}\"", each,
                                    fmt::join(allowed, "\" and \"")));
        }
    }
    return out;
}

const toml::table* JobTable::table(const char* key)
{
    const toml::node* node = find(key);
    if (node != nullptr && !node->is_table()) {
        refuse(key, fmt::format("a table [{}] is needed", key));
    }
    return node == nullptr ? nullptr : node->as_table();
}

const toml::table* JobTable::inline_table(const char* key)
{
    const toml::node* node = find(key);
    if (node != nullptr && !node->is_table()) {
        refuse(key, fmt::format("values in braces are needed: {} = {{ ... }}", key));
    }
    return node == nullptr ? nullptr : node->as_table();
}

JobTable JobTable::inner(const toml::table& table,
                         const char* key,
                         std::vector<job::Key> known) const
{
    return {table, file_, fmt::format("{}: {}", place_, key), std::move(known)};
}

std::vector<const toml::table*> JobTable::tables(const char* key)
{
    const toml::node* node = find(key);
    std::vector<const toml::table*> out;
    if (node == nullptr) {
        return out;
    }
    if (node->is_table()) {
        out.push_back(node->as_table());
    } else if (node->is_array_of_tables()) {
        for (const toml::node& entry : *node->as_array()) {
            out.push_back(entry.as_table());
        }
    } else {
        refuse(key, fmt::format("tables [[{}]] are needed", key));
    }
    return out;
}

job::KeyValues JobTable::values(const std::vector<job::Key>& keys, double millimetres)
{
    job::KeyValues out;
    for (const job::Key& key : keys) {
        if (auto given = value(key, millimetres)) {
            out.set(key.name, std::move(*given));
        }
    }
    return out;
}

void JobTable::check_values()
{
    const std::set<std::string> read = read_;
    values(known_, 1.0);
    read_ = read;  // looked at, not used
}

// No value where the key is absent and has no default, or where it is a table or a tool.
std::optional<job::KeyValues::Value> JobTable::value(const job::Key& key, double millimetres)
{
    using Value = std::optional<job::KeyValues::Value>;
    const char* const name = key.name.c_str();
    const auto list = [](std::optional<std::vector<double>> numbers, double unit) -> Value {
        for (std::size_t i = 0; numbers && i < numbers->size(); ++i) {
            (*numbers)[i] *= unit;
        }
        return numbers ? Value{std::move(*numbers)} : std::nullopt;
    };
    const auto number_or_none = [&](double unit) -> Value {
        const auto given = length(name, unit);
        return given                        ? Value{*given}
               : key.has_number_otherwise() ? Value{key.number_otherwise()}
                                            : std::nullopt;
    };
    switch (key.kind) {
        case job::KeyKind::kLength:
        case job::KeyKind::kRate:
            return number_or_none(millimetres);
        case job::KeyKind::kCount:
            whole_number(name);
            return number_or_none(1.0);
        case job::KeyKind::kNumber:
        case job::KeyKind::kAngle:
            return number_or_none(1.0);
        case job::KeyKind::kFlag:
            return flag_or_default(name);
        case job::KeyKind::kText: {
            auto given = text(name);
            return given ? Value{std::move(*given)} : std::nullopt;
        }
        case job::KeyKind::kChoice:
            return choice_or_default(name);
        case job::KeyKind::kFiles:
        case job::KeyKind::kTexts: {
            auto given = texts(name);
            return given ? Value{std::move(*given)} : std::nullopt;
        }
        case job::KeyKind::kLengths:
        case job::KeyKind::kMargin:
        case job::KeyKind::kInterval:
        case job::KeyKind::kExtent:
            return list(one_or_more(name), millimetres);
        case job::KeyKind::kNumbers:
            return list(one_or_more(name), 1.0);
        case job::KeyKind::kPairs:
        case job::KeyKind::kTool:
        case job::KeyKind::kTools:
        case job::KeyKind::kTable:
        case job::KeyKind::kTables:
            break;
    }
    return std::nullopt;
}

void JobTable::refuse_unknown_keys() const
{
    for (const auto& entry : table_) {
        const std::string key{entry.first.str()};
        if (job::find_key(known_, key) != nullptr || job::find_key(elsewhere_, key) != nullptr) {
            continue;
        }
        std::vector<std::string> names;
        std::transform(known_.begin(), known_.end(), std::back_inserter(names),
                       [](const job::Key& each) { return each.name; });
        refuse(key.c_str(), fmt::format("unknown key; the nearest known one is {}",
                                        nearest_names(key, names, 1).front()));
    }
}

void JobTable::check_all_read() const
{
    for (const job::Key& key : known_) {
        if (read_.count(key.name) == 0) {
            throw std::logic_error("the key " + key.name + " is known but never read");
        }
    }
}

}  // namespace cusp::import
