// Which keys of a table go together, and which it has to have.
#include <algorithm>

#include "host_tools/job/import/job_table.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {
namespace {

// The choices, or the kind of the value.
std::string words_of_value(const job::Key& key)
{
    return key.choices.empty() ? form_of(key.kind).words
                               : fmt::format("\"{}\"", fmt::join(key.choices, "\" or \""));
}

}  // namespace

bool JobTable::has_as(const std::string& rule) const
{
    const std::size_t equals = rule.find(" = ");
    const toml::node* const node = table_.get(rule.substr(0, equals));
    if (node == nullptr || equals == std::string::npos) {
        return node != nullptr;
    }
    const std::string value = node->is_string() ? fmt::format("\"{}\"", *node->value<std::string>())
                                                : fmt::format("{}", node->value_or(false));
    return rule.substr(equals) == " = " + value;
}

void JobTable::check_rules(const job::Key& key) const
{
    const auto has = [&](const std::string& rule) {
        return has_as(rule);
    };
    if (!has(key.name)) {
        return;
    }
    const auto other = std::find_if(key.excludes.begin(), key.excludes.end(), has);
    if (other != key.excludes.end()) {
        refuse(key.name.c_str(), fmt::format("is given beside {}: one of them", *other));
    }
    if (!key.needs.empty() && std::none_of(key.needs.begin(), key.needs.end(), has)) {
        const job::Key* const one =
            key.needs.size() == 1 ? job::find_key(known_, key.needs.front()) : nullptr;
        refuse(key.name.c_str(), fmt::format("needs {}{}", fmt::join(key.needs, " or "),
                                             one == nullptr ? "" : ": " + one->plain_help()));
    }
}

void JobTable::check()
{
    const std::set<std::string> read = read_;
    for (const job::Key& key : known_) {
        value(key);
        check_rules(key);
    }
    read_ = read;  // looked at, not used
    for (const job::Key& key : known_) {
        if (key.otherwise == "needed" && !has(key.name.c_str())) {
            refuse(key.name.c_str(),
                   fmt::format("is missing: {}, {}", words_of_value(key), key.plain_help()));
        }
    }
}

}  // namespace cusp::import
