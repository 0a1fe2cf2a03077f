// Parses the number at the start of a text, with the same result on all platforms.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace cusp::dialect {

struct LeadingNumber {
    double value;
    std::size_t size;  // length in characters
};

// Syntax as in "-1.5e3": optional minus, digits with an optional point, optional exponent. Rounds
// to the nearest double. No value where there is no number, or one beyond the range of double.
std::optional<LeadingNumber> leading_number(std::string_view text);

}  // namespace cusp::dialect
