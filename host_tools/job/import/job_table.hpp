// One table of a job file: unknown keys are refused first; each key is read once, by the kind, range and
// default that its table of keys (job/keys.hpp) gives it.
#pragma once

#include <array>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host_tools/job/job/keys.hpp"

// In debug builds toml++ asserts on some broken files that release builds refuse properly.
#define TOML_ASSERT(condition) static_cast<void>(0)
#include "toml++/toml.h"

namespace cusp::import {

// The document in a text. Throws InputError with the line where it is not TOML.
//
// file  its name, for messages
toml::table parsed_toml(const std::string& text, const std::string& file);

class JobTable {
public:
    // place  name of the table in messages, such as "operation 2"; "" for the file itself
    // known      every key that the table may have
    // elsewhere  keys of other strategies: refuse_keys_of_others() has refused them here; they read as absent
    //
    // Throws InputError where the table has another key, with the nearest known one. Thus a typo is
    // reported before the key that is missing because of it.
    JobTable(const toml::table& table,
             std::string file,
             std::string place,
             std::vector<job::Key> known,
             std::vector<job::Key> elsewhere = {});

    // Each returns no value where the key is absent and throws InputError where its value has the
    // wrong type or is out of its range.
    std::optional<double> number(const char* key);
    // In mm, of a number in units of `millimetres`.
    std::optional<double> length(const char* key, double millimetres);
    std::optional<int> whole_number(const char* key);
    std::optional<bool> flag(const char* key);
    std::optional<std::string> text(const char* key);
    std::optional<std::string> choice(const char* key);
    std::optional<std::vector<double>> numbers(const char* key);
    // A single number counts as a list of one.
    std::optional<std::vector<double>> one_or_more(const char* key);
    // Pairs of numbers, [[a, b], ...].
    //
    // words  of a pair, such as "[diameter, length]"
    std::optional<std::vector<std::array<double, 2>>> pairs(const char* key, const char* words);
    // One number, which is both ends, or [least, greatest].
    std::optional<std::array<double, 2>> interval(const char* key);
    // Two numbers [min, max], min below max, in mm, of numbers in units of `millimetres`.
    std::optional<std::array<double, 2>> extent(const char* key, double millimetres);
    // A single text counts as a list of one.
    std::optional<std::vector<std::string>> texts(const char* key);
    const toml::table* table(const char* key);
    // A table within the table, such as tabs = { count = 4 }.
    const toml::table* inline_table(const char* key);
    // Members of such a table.
    JobTable inner(const toml::table& table, const char* key, std::vector<job::Key> known) const;
    // A single table counts as a list of one.
    std::vector<const toml::table*> tables(const char* key);

    // The values of the keys, without tables and tools; lengths in units of `millimetres`.
    job::KeyValues values(const std::vector<job::Key>& keys, double millimetres);

    // Refuses the first known value of another kind or out of its range, before any is used.
    void check_values();

    // As the above, with the default of the table of keys where the key is absent; lengths in mm.
    double length_or_default(const char* key, double millimetres);
    double number_or_default(const char* key);
    int whole_number_or_default(const char* key);
    bool flag_or_default(const char* key);
    std::string choice_or_default(const char* key);
    // As the above, refusing where the key is absent.
    double required_number(const char* key);
    bool required_flag(const char* key);
    std::string required_text(const char* key);
    std::vector<std::string> required_texts(const char* key);

    // True if the value, or the first of a list, is a text; false where the key is absent.
    bool is_text(const char* key) const;

    // Known keys that other operations have: refuse_keys_of_others() has refused them here.
    void leave(const std::vector<std::string>& keys) { read_.insert(keys.begin(), keys.end()); }

    bool has(const char* key) const { return table_.contains(key); }
    job::Range range_of(const char* key) const { return key_of(key).range; }

    // The place of the key, for messages: "job.toml:4: tool 1: feed".
    std::string place_of(const char* key) const;

    // limit  in words, where the reason names one
    [[noreturn]] void refuse(const char* key,
                             const std::string& reason,
                             const std::string& limit = {}) const;

    // Throws std::logic_error where a known key was never read: it would have no effect.
    void check_all_read() const;

private:
    void refuse_unknown_keys() const;
    toml::source_index line_of(const char* key) const;
    const job::Key& key_of(const char* key) const;
    std::optional<job::KeyValues::Value> value(const job::Key& key, double millimetres);
    const toml::node* find(const char* key);
    double checked(const toml::node& node, const char* key) const;

    const toml::table& table_;
    std::string file_;
    std::string place_;
    std::vector<job::Key> known_;
    std::vector<job::Key> elsewhere_;
    std::set<std::string> read_;
};

}  // namespace cusp::import
