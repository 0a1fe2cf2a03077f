// Uses strtod, since not every supported standard library has std::from_chars of double.
#include "host_tools/controller/dialect/leading_number.hpp"

#include <cerrno>
#include <cstdlib>
#include <string>

namespace cusp::dialect {

std::optional<LeadingNumber> leading_number(std::string_view text)
{
    // Excludes what only strtod accepts: blanks, a plus, hexadecimal digits, "inf", "nan".
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
