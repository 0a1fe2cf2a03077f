// std::from_chars of double is not in every standard library that compiles this: strtod is.
#include "host_tools/dialect/leading_number.hpp"

#include <cerrno>
#include <cstdlib>
#include <string>

namespace cusp::dialect {

std::optional<LeadingNumber> leading_number(std::string_view text)
{
    // What strtod takes besides (blanks, a plus, hexadecimal digits, "inf", "nan") is no number here.
    const std::string digits{text.substr(0, text.find_first_not_of("0123456789.eE+-"))};
    if (digits.empty() || digits.front() == '+') {
        return std::nullopt;
    }
    char* end = nullptr;
    errno = 0;
    const double value = std::strtod(digits.c_str(), &end);
    if (end == digits.c_str() || errno == ERANGE) {
        return std::nullopt;
    }
    return LeadingNumber{value, static_cast<std::size_t>(end - digits.c_str())};
}

}  // namespace cusp::dialect
