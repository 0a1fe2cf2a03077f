// By the standard library.
#include <charconv>

#include "host_tools/base/number_text/number_text.hpp"

namespace cusp::number_text {

std::optional<Leading> leading_number(std::string_view text)
{
    double value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{}
               ? std::optional{Leading{value, static_cast<std::size_t>(stop - text.data())}}
               : std::nullopt;
}

}  // namespace cusp::number_text
