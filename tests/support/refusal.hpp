// The error message for bad input.
#pragma once

#include <string>

#include "host_tools/base/input_error/input_error.hpp"

namespace cusp::test {

// The text of the InputError that `act` throws; "" if it throws none.
template <class Act>
std::string refusal(Act act)
{
    try {
        act();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

}  // namespace cusp::test
