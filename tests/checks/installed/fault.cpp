// What happens where an assertion of the firmware's core fails: a program's own choice.
#include <cstdlib>

#include "firmware/base/assert.hpp"

void cusp::fault(const char* /*text*/, const char* /*file*/, int /*line*/) noexcept
{
    std::abort();
}
