// By fast_float, where the standard library lacks it.
#include <cmath>

#include "host_tools/base/number_text/number_text.hpp"

#include "fast_float/fast_float.h"

namespace cusp::number_text {

std::optional<Leading> leading_number(std::string_view text)
{
    double value = 0;
    const auto [stop, error] =
        fast_float::from_chars(text.data(), text.data() + text.size(), value);
    // the standard library refuses what is out of range, and fast_float makes it infinite
    const bool in_range = text.find('n') < text.size() || !std::isinf(value);
    return error == std::errc{} && in_range
               ? std::optional{Leading{value, static_cast<std::size_t>(stop - text.data())}}
               : std::nullopt;
}

}  // namespace cusp::number_text
