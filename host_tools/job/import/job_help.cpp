// Names and keys in columns, their help folded to the width of a terminal.
#include <algorithm>
#include <sstream>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/job_key_tables.hpp"
#include "host_tools/job/import/job_schema.hpp"
#include "host_tools/job/import/nearest_name.hpp"
#include "host_tools/job/job/operation_keys.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

using job::Key;
using job::KeyTable;
using Rows = std::vector<std::pair<std::string, std::string>>;

namespace {

// Marks of docs/job_file.md mean nothing in a terminal, nor does what stands below there.
std::string plain(std::string text)
{
    text.erase(std::remove(text.begin(), text.end(), '`'), text.end());
    const std::string elsewhere = ", below)";
    for (std::size_t at = 0; (at = text.find(elsewhere, at)) != std::string::npos;) {
        text.replace(at, elsewhere.size(), ", in docs/job_file.md)");
    }
    return text == "see below" ? "see docs/job_file.md" : text;
}

// Names, and beside them what they mean.
std::string columns(const Rows& rows)
{
    constexpr std::size_t kWidth = 100;
    std::size_t indent = 0;
    for (const auto& [name, meaning] : rows) {
        indent = std::max(indent, name.size() + 4);
    }
    std::string out;
    for (const auto& [name, meaning] : rows) {
        std::string line = fmt::format("  {:<{}}", name, indent - 2);
        std::istringstream words{plain(meaning)};
        for (std::string word; words >> word;) {
            if (line.size() > indent && line.size() + 1 + word.size() > kWidth) {
                out += line + "\n";
                line = std::string(indent, ' ');
            }
            line += (line.size() > indent ? " " : "") + word;
        }
        out += line + "\n";
    }
    return out;
}

// "(length above 0; 5 mm)"
std::string value_words(const Key& key)
{
    std::string form = key.choices.empty() ? form_of(key.kind).words
                                           : fmt::format("{}", fmt::join(key.choices, " | "));
    if (!key.choices.empty() || key.members != nullptr) {
        // no limits
    } else if (key.range.high < job::kLargest) {
        form += fmt::format(" {:g} to {:g}", key.range.low, key.range.high);
    } else if (key.range.low == 0) {
        form += key.range.above_low ? " above 0" : " 0 or more";
    }
    return key.otherwise == "none" ? form : fmt::format("{}; {}", form, plain(key.otherwise));
}

std::string lines_of(const std::vector<Key>& keys)
{
    Rows rows;
    for (const Key& key : keys) {
        rows.emplace_back(key.name, fmt::format("{} ({})", key.help, value_words(key)));
    }
    return columns(rows);
}

// With the tables that it has as members, where these are written in braces.
std::string table_help(const std::string& head, const std::vector<Key>& keys)
{
    std::string out = fmt::format(
        "{}\nIn brackets: kind and limits of the value; what holds without the key. Lengths are in "
        "the "
        "units of the job.\n\n{}",
        plain(head), lines_of(keys));
    for (const Key& key : keys) {
        if (key.kind == job::KeyKind::kTable && key.members != nullptr) {
            out += fmt::format("\n{}: {}\n{}", key.name, plain(key.members().help),
                               lines_of(key.members().keys));
        }
    }
    return out;
}

// Tables by their names: those of the file, and what all operations have.
std::vector<KeyTable> named_tables()
{
    std::vector<KeyTable> tables;
    for (const Key& key : job_table().keys) {
        if (key.members != nullptr) {
            tables.push_back(key.members());
        }
    }
    tables.push_back(machine_table());
    tables.push_back(material_table());
    tables.push_back(
        {"operation", "What every operation has, whatever its strategy.", job::common_keys()});
    return tables;
}

}  // namespace

std::string job_help(const job::Strategies& strategies)
{
    Rows cuts;
    for (const job::Strategy* const strategy : strategies) {
        cuts.emplace_back(strategy->name, strategy->help);
    }
    Rows tables;
    Rows single;
    for (const Key& key : job_table().keys) {
        (key.kind == job::KeyKind::kTable || key.kind == job::KeyKind::kTables ? tables : single)
            .emplace_back(key.name, key.help);
    }
    return fmt::format(
        "Strategies of an [[operation]]; --help-job NAME lists the keys of one:\n{}\n"
        "Tables of a job; --help-job NAME lists their keys:\n{}\n"
        "Keys beside the tables:\n{}",
        columns(cuts), columns(tables), columns(single));
}

std::string job_help(const job::Strategies& strategies, const std::string& name)
{
    if (const job::Strategy* const strategy = find_strategy(strategies, name)) {
        return table_help(fmt::format("strategy = \"{}\": {}.", name, strategy->help),
                          keys_of(*strategy));
    }
    std::vector<std::string> names = names_of(strategies);
    for (const KeyTable& table : named_tables()) {
        if (table.name == name) {
            return table_help(fmt::format("[{}]: {}", name, table.help), table.keys);
        }
        names.push_back(table.name);
    }
    constexpr std::size_t kFew = 3;
    throw InputError(
        fmt::format("--help-job {}: no strategy or table of that name; the nearest "
                    "are {}",
                    name, fmt::join(nearest_names(name, names, kFew), ", ")));
}

}  // namespace cusp::import
