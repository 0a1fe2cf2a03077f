// The values that a plan without a job file may be given, by name: options of `cusp plan`, and arguments of pages.
//
//     for (const OneLineKey& key : one_line_keys(strategies)) { add(option_of(key), key.help); }
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "host_tools/job/import/one_line_job.hpp"

namespace cusp::import {

// The kind of parts that a key is for.
enum class OneLineUse { kAny, kSurfaces, kDrawings };

struct OneLineKey {
    using Place = std::variant<std::optional<double> OneLineRequest::*,
                               std::optional<std::string> OneLineRequest::*,
                               std::string OneLineRequest::*,
                               std::vector<double> OneLineRequest::*,
                               std::vector<std::string> OneLineRequest::*>;

    const char* name;  // "max_depth"
    Place place;       // of the value in the request
    const char* type;  // in words: "FEED"; "": a number, or a text
    std::string help;
    OneLineUse use{OneLineUse::kAny};
    std::vector<std::string> choices{};  // empty: any
    const char* option{nullptr};         // on a command line, if not as `name`
    int least_values{1};                 // of a list of numbers
    int most_values{1};
};

// "--max-depth"
std::string option_of(const OneLineKey& key);

// True if the request has a value for the key; the form of moves always has one.
bool is_given(const OneLineRequest& request, const OneLineKey& key);

// In the order of `cusp plan --help`, those of most calls first. All but `parts`, the unit, roughing and the post.
std::vector<OneLineKey> one_line_keys(const job::Strategies& strategies);

}  // namespace cusp::import
