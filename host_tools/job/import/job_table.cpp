// Typed access to a TOML table; every error names its place.
#include "host_tools/job/import/job_table.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "firmware/base/inch.hpp"
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
                   double unit,
                   std::vector<job::Key> elsewhere)
    : table_{table},
      file_{std::move(file)},
      place_{std::move(place)},
      known_{std::move(known)},
      unit_{unit},
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
    return form_of(key_of(key).kind).has_unit ? *value * unit_ : *value;
}

std::optional<double> JobTable::number(const char* key)
{
    const toml::node* node = find(key);
    return node == nullptr ? std::nullopt : std::optional{checked(*node, key)};
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

std::optional<std::size_t> JobTable::place_among_choices(const char* key,
                                                         const std::string& word) const
{
    const std::vector<std::string>& all = key_of(key).choices;
    const auto found = std::find(all.begin(), all.end(), word);
    return found == all.end() ? std::nullopt
                              : std::optional{static_cast<std::size_t>(found - all.begin())};
}

std::optional<std::vector<double>> JobTable::numbers(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) {
        return std::nullopt;
    }
    const job::KindForm& form = form_of(key_of(key).kind);
    std::vector<double> out;
    if (node->is_number() && form.one_or_list) {
        out.push_back(checked(*node, key));
    } else if (!node->is_array()) {
        refuse(key, "a list of numbers is needed");
    } else {
        for (const toml::node& entry : *node->as_array()) {
            out.push_back(checked(entry, key));
        }
    }
    const std::vector<std::size_t>& counts = form.counts;
    if (!counts.empty() && std::find(counts.begin(), counts.end(), out.size()) == counts.end()) {
        refuse(key, fmt::format("has {} numbers, needed: {}, {}", out.size(), form.words,
                                key_of(key).plain_help()));
    }
    return out;
}

std::optional<std::vector<std::array<double, 2>>> JobTable::pairs(const char* key)
{
    const toml::node* node = find(key);
    if (node == nullptr) {
        return std::nullopt;
    }
    const auto refuse_form = [&] {
        refuse(key, fmt::format("a list of pairs is needed: {}", key_of(key).plain_help()));
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
    const auto ends = numbers(key);
    if (ends && (ends->empty() || ends->size() > 2 || ends->front() > ends->back())) {
        refuse(key, "a number is needed, or two: [least, greatest]");
    }
    return ends ? std::optional{std::array{ends->front(), ends->back()}} : std::nullopt;
}

std::optional<std::array<double, 2>> JobTable::extent(const char* key)
{
    const auto ends = numbers(key);
    if (ends && !(ends->front() < ends->back())) {
        refuse(key, "two numbers [min, max] are needed, min below max");
    }
    return ends ? std::optional{std::array{ends->front(), ends->back()}} : std::nullopt;
}

std::optional<Vec2d> JobTable::point(const char* key)
{
    const auto at = numbers(key);
    return at ? std::optional{Vec2d{(*at)[0], (*at)[1]}} : std::nullopt;
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
    JobTable members{table, file_, fmt::format("{}: {}", place_, key), std::move(known), unit_};
    members.check();
    return members;
}

std::vector<JobTable> JobTable::each(const char* key, const job::KeyTable& known)
{
    std::vector<JobTable> out;
    for (const toml::table* const table : tables(key)) {
        out.emplace_back(*table, file_, fmt::format("{} {}", key, out.size() + 1), known.keys,
                         unit_);
        out.back().check();
    }
    return out;
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

job::KeyValues JobTable::values(const std::vector<job::Key>& keys)
{
    job::KeyValues out;
    for (const job::Key& key : keys) {
        if (auto given = value(key)) {
            out.set(key.name, std::move(*given));
        }
    }
    return out;
}

void JobTable::take_unit()
{
    unit_ = choice_or_default("units") == "inch" ? kMillimetresPerInch : 1.0;
}

// No value where the key is absent and has no default, or where it is a table or a tool.
std::optional<job::KeyValues::Value> JobTable::value(const job::Key& key)
{
    using Value = std::optional<job::KeyValues::Value>;
    const char* const name = key.name.c_str();
    const auto wrapped = [](auto given) -> Value {
        return given ? Value{std::move(*given)} : std::nullopt;
    };
    switch (key.kind) {
        case job::KeyKind::kCount:
            whole_number(name);
            [[fallthrough]];
        case job::KeyKind::kLength:
        case job::KeyKind::kRate:
        case job::KeyKind::kNumber:
        case job::KeyKind::kAngle: {
            const auto given = number(name);
            return !given && key.has_number_otherwise() ? Value{key.number_otherwise()}
                                                        : wrapped(given);
        }
        case job::KeyKind::kFlag:
            return flag_or_default(name);
        case job::KeyKind::kText:
            return wrapped(text(name));
        case job::KeyKind::kChoice:
            return choice_or_default(name);
        case job::KeyKind::kFiles:
        case job::KeyKind::kTexts:
            return wrapped(texts(name));
        case job::KeyKind::kExtent:
            extent(name);
            return wrapped(numbers(name));
        case job::KeyKind::kInterval:
            interval(name);
            return wrapped(numbers(name));
        case job::KeyKind::kLengths:
        case job::KeyKind::kTwo:
        case job::KeyKind::kThree:
        case job::KeyKind::kTurn:
        case job::KeyKind::kMargin:
        case job::KeyKind::kNumbers:
            return wrapped(numbers(name));
        case job::KeyKind::kPairs:
            pairs(name);
            break;
        case job::KeyKind::kTool:
            is_text(name) ? static_cast<void>(text(name)) : static_cast<void>(whole_number(name));
            break;
        case job::KeyKind::kTools:
            is_text(name) ? static_cast<void>(texts(name)) : static_cast<void>(numbers(name));
            break;
        case job::KeyKind::kTable:
            table(name);
            break;
        case job::KeyKind::kTables:
            tables(name);
            break;
    }
    return std::nullopt;
}

double JobTable::number_or_default(const char* key)
{
    const auto value = number(key);
    return value ? *value : key_of(key).number_otherwise();
}

int JobTable::whole_number_or_default(const char* key)
{
    const auto value = whole_number(key);
    return value ? *value : static_cast<int>(key_of(key).number_otherwise());
}

bool JobTable::flag_or_default(const char* key)
{
    return flag(key).value_or(key_of(key).otherwise == "true");
}

std::string JobTable::choice_or_default(const char* key)
{
    return choice(key).value_or(key_of(key).otherwise);
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
