// A key of a job file: its kind, range, default and help. One table of them is what the reader checks
// by, and what `cusp plan --help-job`, `--schema` and the tables of docs/job_file.md are made of.
//
//     const Key depth{"depth", KeyKind::kLength, "needed", "below `top`", kPositive};
//     const Key side{"side", KeyKind::kChoice, "outside", "of the loops", {}, {"outside", "inside"}};
//     const Key pitch = Key{"pitch", KeyKind::kMargin, "none", "of a grid"}.needing({"grid"});
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace cusp::job {

// Limits of a number as the file has it, in the file's unit.
struct Range {
    double low;
    double high;
    bool above_low{false};  // `low` itself is not allowed
};

// mm, mm/min, rpm
inline constexpr double kLargest = 1e6;
inline constexpr Range kPositive{0, kLargest, true};
inline constexpr Range kNotNegative{0, kLargest};
inline constexpr Range kAnyNumber{-kLargest, kLargest};
// G-code has coordinates to 1e-4 mm and feeds to 1e-3 mm/min.
inline constexpr Range kToleranceRange{1e-5, kLargest};  // mm
inline constexpr Range kScaleRange{1e-6, kLargest};      // of a part
inline constexpr Range kFeedRange{0.01, kLargest};       // mm/min
inline constexpr Range kToolNumber{1, 255};              // T word

enum class KeyKind : std::uint8_t {
    kLength,    // in the file's unit; converted to mm
    kRate,      // lengths a minute; converted to mm/min
    kNumber,    // without a unit, or rpm
    kAngle,     // degrees
    kCount,     // a whole number
    kFlag,      // true or false
    kText,      // in quotes
    kChoice,    // one of the choices
    kFiles,     // a text, or a list of texts
    kTexts,     // a list of texts
    kLengths,   // a list of lengths
    kTwo,       // two lengths
    kThree,     // three lengths
    kNumbers,   // a number, or a list of numbers
    kTurn,      // an angle, or three
    kMargin,    // a length, or two
    kExtent,    // [least, greatest], lengths
    kInterval,  // a length, or [least, greatest]
    kPairs,     // a list of pairs of lengths
    kTool,      // number or name of a tool
    kTools,     // a list of these
    kTable,     // a table, or values in braces
    kTables     // one table or several
};

// How a value of a kind looks.
struct KindForm {
    const char* words;                  // such as "length" or "list of tools"
    bool has_unit{false};               // its numbers are in the file's unit
    bool one_or_list{false};            // one number counts as a list of it
    std::vector<std::size_t> counts{};  // that a list may have; empty: any
};

const KindForm& form_of(KeyKind kind);

struct KeyTable;

struct Key {
    std::string name;
    KeyKind kind;
    // The value without the key: a number (in mm, degrees, rpm), a choice, "true" or "false"; other
    // words, such as "needed", are for people.
    std::string otherwise;
    std::string help;  // one line
    Range range{kAnyNumber};
    std::vector<std::string> choices{};
    const KeyTable& (*members)(){nullptr};  // of a table
    // The table has one of `needs` where it has this key, and none of `excludes`. Each is the name of another key, or a
    // name and a value, such as "chip_load = true" or "clearing = \"adaptive\"".
    std::vector<std::string> needs{};
    std::vector<std::string> excludes{};

    // `help` without the marks of docs/job_file.md.
    std::string plain_help() const;

    // Copies with these rules.
    Key needing(const std::vector<std::string>& keys) const;
    Key excluding(const std::vector<std::string>& keys) const;

    bool has_number_otherwise() const;
    // The number that `otherwise` begins with. Throws std::logic_error where it has none.
    double number_otherwise() const;
};

struct KeyTable {
    std::string name;  // as in [name]
    std::string help;
    std::vector<Key> keys;
};

// The one of that name; null where there is none.
const Key* find_key(const std::vector<Key>& keys, const std::string& name);

// Values of a table's keys: lengths in mm, feeds in mm/min; texts for choices; lists for a value that
// may be one. A key that is absent has the value of its default, if that is one.
class KeyValues {
public:
    using Value =
        std::variant<double, bool, std::string, std::vector<double>, std::vector<std::string>>;

    void set(const std::string& key, Value value) { values_[key] = std::move(value); }
    // No value where the key has none. Throws std::bad_variant_access where it is of another kind.
    template <class Type>
    std::optional<Type> find(const std::string& key) const
    {
        const auto found = values_.find(key);
        return found == values_.end() ? std::nullopt : std::optional{std::get<Type>(found->second)};
    }
    std::optional<double> number(const std::string& key) const { return find<double>(key); }
    // As above, of a key that has a default. Throws std::bad_optional_access where it has no value.
    template <class Type>
    Type get(const std::string& key) const
    {
        return find<Type>(key).value();
    }

private:
    std::map<std::string, Value> values_;
};

}  // namespace cusp::job
