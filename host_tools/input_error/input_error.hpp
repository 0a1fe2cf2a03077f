// InputError: how host tools refuse input that can't be used.
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
