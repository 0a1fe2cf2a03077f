// InputError: how host tools refuse input that can't be used.
//
//     throw InputError(fmt::format("{}: tool {}: diameter is {:g} mm; it must be above 0", file, n,
//                                  diameter));
#pragma once

#include <stdexcept>

namespace cusp {

// Input that can't be used: exit status 2. The text names file, line or key, quantity, value and
// limit.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace cusp
