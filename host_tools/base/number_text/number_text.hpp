// Numbers of files, correctly rounded, whatever the locale.
//
//     if (const auto x = number_text::number_of(word)) { ... }  // "1.5", "+2e-3"; not "1.5mm", "0x1", " 1"
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace cusp::number_text {

struct Leading {
    double value;
    std::size_t size;  // characters of the number
};

// The number that a text begins with, without blanks or "+" before it. None where there is none, or it is too large
// or too small for a double.
std::optional<Leading> leading_number(std::string_view text);

// The number that the whole text is; "+" may precede it.
inline std::optional<double> number_of(std::string_view text)
{
    text.remove_prefix(!text.empty() && text.front() == '+' ? 1 : 0);
    const auto found = leading_number(text);
    return found && found->size == text.size() ? std::optional{found->value} : std::nullopt;
}

}  // namespace cusp::number_text
