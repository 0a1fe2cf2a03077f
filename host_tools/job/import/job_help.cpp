// Keys in columns: name, kind, default, help.
#include <algorithm>

#include "host_tools/job/import/job_key_tables.hpp"
#include "host_tools/job/import/job_schema.hpp"
#include "host_tools/job/job/operation_keys.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

using job::Key;
using job::KeyTable;

namespace {

// Marks of docs/job_file.md mean nothing in a terminal.
std::string plain(std::string text)
{
    text.erase(std::remove(text.begin(), text.end(), '`'), text.end());
    return text;
}

std::string kind_of(const Key& key)
{
    return key.choices.empty() ? words_of(key.kind)
                               : fmt::format("{}", fmt::join(key.choices, "|"));
}

std::string lines_of(const std::vector<Key>& keys)
{
    std::size_t name = 0;
    std::size_t kind = 0;
    std::size_t otherwise = 0;
    for (const Key& key : keys) {
        name = std::max(name, key.name.size());
        kind = std::max(kind, kind_of(key).size());
        otherwise = std::max(otherwise, plain(key.otherwise).size());
    }
    std::string out;
    for (const Key& key : keys) {
        out += fmt::format("  {:<{}}  {:<{}}  {:<{}}  {}\n", key.name, name, kind_of(key), kind,
                           plain(key.otherwise), otherwise, plain(key.help));
    }
    return out;
}

std::string table_help(const KeyTable& table)
{
    std::string out =
        fmt::format("{}{}\n{}\n", table.name.empty() ? "" : fmt::format("[{}] ", table.name),
                    table.help, lines_of(table.keys));
    for (const Key& key : table.keys) {
        out += key.members == nullptr ? "" : table_help(key.members());
    }
    return out;
}

}  // namespace

std::string job_help(const job::Strategies& strategies)
{
    std::size_t width = 0;
    for (const job::Strategy* const strategy : strategies) {
        width = std::max(width, strategy->name.size());
    }
    std::string out =
        "Columns: key, kind, default, meaning. Lengths are in the units of the job.\n\n" +
        table_help(job_table()) + "[[operation]] Keys of every operation.\n" +
        lines_of(job::common_keys()) + "\nStrategies (--help-job STRATEGY: its keys):\n";
    for (const job::Strategy* const strategy : strategies) {
        out += fmt::format("  {:<{}}  {}\n", strategy->name, width, strategy->help);
    }
    return out;
}

std::string strategy_help(const job::Strategy& strategy)
{
    std::string out = fmt::format("strategy = \"{}\": {}\n{}", strategy.name, strategy.help,
                                  lines_of(job::keys_of(strategy)));
    for (const Key& key : strategy.own) {
        out += key.members == nullptr ? "" : "\n" + table_help(key.members());
    }
    return out;
}

}  // namespace cusp::import
