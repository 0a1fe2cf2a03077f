// One table of a job file: unknown keys are refused first; each key is read once, by the kind, range and
// default that its table of keys (job/keys.hpp) gives it.
#pragma once

#include <array>
#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"
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
    // unit       mm, of the file's lengths
    // elsewhere  keys of other strategies: refuse_keys_of_others() has refused them here; they read as absent
    //
    // Throws InputError where the table has another key, with the nearest known one. Thus a typo is
    // reported before the key that is missing because of it.
    JobTable(const toml::table& table,
             std::string file,
             std::string place,
             std::vector<job::Key> known,
             double unit = 1.0,
             std::vector<job::Key> elsewhere = {});

    // Refuses the first known key whose value is of another kind or out of its range, that lacks a key that it needs or
    // has one that it excludes; then the first that is needed and missing.
    void check();

    // Takes the unit of the file's lengths from its key `units`.
    void take_unit();
    double unit() const { return unit_; }

    // Each returns no value where the key is absent and throws InputError where its value has the
    // wrong type, form or range. Lengths are in mm, feeds in mm/min.
    std::optional<double> number(const char* key);
    std::optional<int> whole_number(const char* key);
    std::optional<bool> flag(const char* key);
    std::optional<std::string> text(const char* key);
    std::optional<std::string> choice(const char* key);
    // A single number counts as a list of one where the key's kind has both.
    std::optional<std::vector<double>> numbers(const char* key);
    // Pairs of numbers, [[a, b], ...].
    std::optional<std::vector<std::array<double, 2>>> pairs(const char* key);
    // One number, which is both ends, or [least, greatest].
    std::optional<std::array<double, 2>> interval(const char* key);
    // Two numbers [min, max], min below max.
    std::optional<std::array<double, 2>> extent(const char* key);
    // A key of two lengths.
    std::optional<Vec2d> point(const char* key);
    // A single text counts as a list of one.
    std::optional<std::vector<std::string>> texts(const char* key);
    // As texts(); none where the key is absent.
    std::vector<std::string> all_texts(const char* key)
    {
        return texts(key).value_or(std::vector<std::string>{});
    }
    const toml::table* table(const char* key);
    // A table within the table, such as tabs = { count = 4 }.
    const toml::table* inline_table(const char* key);
    // Members of such a table, checked.
    JobTable inner(const toml::table& table, const char* key, std::vector<job::Key> known) const;
    // A single table counts as a list of one.
    std::vector<const toml::table*> tables(const char* key);
    // The same with their keys, each checked; they are named "KEY 1", "KEY 2" ...
    std::vector<JobTable> each(const char* key, const job::KeyTable& known);

    // The values of the keys, without tables and tools.
    job::KeyValues values(const std::vector<job::Key>& keys);

    // As the above, with the default of the table of keys where the key is absent.
    double number_or_default(const char* key);
    int whole_number_or_default(const char* key);
    bool flag_or_default(const char* key);
    std::string choice_or_default(const char* key);
    // The one of `all` that stands where the choice, or its default, does among the choices; none where the default is
    // none of them.
    template <class Value>
    std::optional<Value> chosen(const char* key, std::initializer_list<Value> all)
    {
        const auto place = place_among_choices(key, choice_or_default(key));
        return place ? std::optional{all.begin()[*place]} : std::nullopt;
    }

    // Returns the result of `work`. An InputError in it is one of the value of the key.
    template <class Work>
    auto blamed(const char* key, const Work& work) const -> decltype(work())
    {
        try {
            return work();
        } catch (const InputError& error) {
            refuse(key, error.what());
        }
    }

    // True if the value, or the first of a list, is a text; false where the key is absent.
    bool is_text(const char* key) const;

    // Known keys that other operations have: refuse_keys_of_others() has refused them here.
    void leave(const std::vector<std::string>& keys) { read_.insert(keys.begin(), keys.end()); }

    bool has(const char* key) const { return table_.contains(key); }
    job::Range range_of(const char* key) const { return key_of(key).range; }
    // The place in the file, such as "operation 2".
    const std::string& name() const { return place_; }

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
    void check_rules(const job::Key& key) const;
    // keys  a name, or a name and a value
    bool has_as(const std::string& keys) const;
    toml::source_index line_of(const char* key) const;
    const job::Key& key_of(const char* key) const;
    std::optional<std::size_t> place_among_choices(const char* key, const std::string& word) const;
    std::optional<job::KeyValues::Value> value(const job::Key& key);
    const toml::node* find(const char* key);
    double checked(const toml::node& node, const char* key) const;

    const toml::table& table_;
    std::string file_;
    std::string place_;
    std::vector<job::Key> known_;
    double unit_;  // mm
    std::vector<job::Key> elsewhere_;
    std::set<std::string> read_;
};

}  // namespace cusp::import
