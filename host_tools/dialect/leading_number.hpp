// The number that a text begins with, read alike on every machine that the core runs on.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace cusp::dialect {

struct LeadingNumber {
    double value;
    std::size_t size;  // characters that it takes
};

// "-1.5e3": a minus at most, digits with at most one point, an exponent at most; the nearest double.
// None where the text begins with no number, or with one beyond the range of double.
std::optional<LeadingNumber> leading_number(std::string_view text);

}  // namespace cusp::dialect
