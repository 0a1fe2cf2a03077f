// One table of a job file: each key is read once, with its range; keys that were never read are
// refused.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/import/number_ranges.hpp"

// In debug builds toml++ asserts on some broken files that release builds refuse properly.
#define TOML_ASSERT(condition) static_cast<void>(0)
#include "toml++/toml.h"

namespace cusp::import {

class JobTable {
public:
    // place  how messages name the table, such as "operation 2"; "" for the file itself
    JobTable(const toml::table& table, std::string file, std::string place);

    // Each returns nothing where the key is absent and throws InputError where its value is of
    // another kind or outside its range.
    std::optional<double> number(const char* key, Range range);
    std::optional<int> whole_number(const char* key, Range range);
    std::optional<bool> flag(const char* key);
    std::optional<std::string> text(const char* key);
    std::optional<std::string> one_of(const char* key, const std::vector<std::string>& allowed);
    std::optional<std::vector<double>> numbers(const char* key, Range range);
    // A single text counts as a list of one.
    std::optional<std::vector<std::string>> texts(const char* key);
    const toml::table* table(const char* key);
    // A single table counts as a list of one.
    std::vector<const toml::table*> tables(const char* key);

    double required_number(const char* key, Range range);

    [[noreturn]] void refuse(const char* key, const std::string& reason) const;

    // Throws where the table holds a key that was never asked for, and names the nearest that was.
    void refuse_unknown_keys() const;

private:
    const toml::node* find(const char* key);
    double checked(const toml::node& node, const char* key, Range range) const;

    const toml::table& table_;
    std::string file_;
    std::string place_;
    std::vector<std::string> asked_;
};

}  // namespace cusp::import
