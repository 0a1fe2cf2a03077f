// Ends the program with a message when an assertion of the firmware core fails.
#include <cstdio>
#include <cstdlib>

#include "firmware/base/assert.hpp"

void cusp::fault(const char* expression, const char* file, int line) noexcept
{
    std::fprintf(stderr, "cusp: internal error: %s:%d: %s\n", file, line, expression);
    std::abort();
}
