// A broken assertion of the core ends the host program with a message.
#include <cstdio>
#include <cstdlib>

#include "firmware/base/assert.hpp"

void cusp::fault(const char* expression, const char* file, int line) noexcept
{
    std::fprintf(stderr, "cusp: a fault in the program itself: %s:%d: %s\n", file, line,
                 expression);
    std::abort();
}
