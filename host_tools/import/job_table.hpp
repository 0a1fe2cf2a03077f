// One table of a job file: each key is asked for once, with its range, and what was never asked
// for is refused.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/import/number_ranges.hpp"

// toml++ asserts in debug builds on some broken files that it refuses properly in release ones.
#define TOML_ASSERT(condition) static_cast<void>(0)
#include "toml++/toml.h"

namespace cusp::import {

class JobTable {
public:
    // place  of the table in the file's terms, such as "operation 2"; "" for the file itself
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
