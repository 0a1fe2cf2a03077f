// Digits become a whole number, divided by a power of ten: correctly rounded.
#include "host_tools/job/import/digit_format.hpp"

#include <string>

#include "host_tools/base/number_text/number_text.hpp"

namespace cusp::import {

std::optional<DigitFormat> DigitFormat::of_gerber(std::string_view text)
{
    const std::size_t x = text.find('X');
    if (x == std::string_view::npos || text.size() < x + 3 ||
        text.substr(0, x).find('I') != std::string_view::npos || text[x + 1] < '0' ||
        text[x + 1] > '9' || text[x + 2] < '1' || text[x + 2] > '9') {
        return std::nullopt;
    }
    return DigitFormat{text[x + 1] - '0', text[x + 2] - '0', text.front() == 'T'};
}

double DigitFormat::last_place() const
{
    double ten = 1;
    for (int k = 0; k < decimals; ++k) {
        ten *= 10;
    }
    return 1 / ten;
}

std::optional<double> DigitFormat::value_of(std::string_view text) const
{
    const bool negative = !text.empty() && text.front() == '-';
    text.remove_prefix(!text.empty() && (negative || text.front() == '+') ? 1 : 0);
    if (text.empty() || text.front() == '-' || text.front() == '+') {
        return std::nullopt;
    }
    std::string digits{text};
    const bool pointed = text.find('.') != std::string_view::npos;
    const auto all = static_cast<std::size_t>(whole + decimals);
    if (!pointed && trailing_omitted && digits.size() < all) {
        digits.append(all - digits.size(), '0');
    }
    const auto number = number_text::number_of(digits);
    if (!number) {
        return std::nullopt;
    }
    double ten = 1;
    for (int k = 0; k < decimals && !pointed; ++k) {
        ten *= 10;
    }
    return (negative ? -*number : *number) / ten;
}

}  // namespace cusp::import
