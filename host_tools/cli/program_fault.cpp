// What a broken promise of our own code means in the host program: it says so and ends.
#include <cstdio>
#include <cstdlib>

#include "firmware/base/assert.hpp"

void cusp::fault(const char* expression, const char* file, int line) noexcept
{
    std::fprintf(stderr, "cusp: a fault in the program itself: %s:%d: %s\n", file, line,
                 expression);
    std::abort();
}
