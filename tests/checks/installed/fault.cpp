// The handler of failed assertions of the firmware's core: a program's own choice.
#include <cstdlib>

#include "firmware/base/assert.hpp"

void cusp::fault(const char* /*text*/, const char* /*file*/, int /*line*/) noexcept
{
    std::abort();
}
