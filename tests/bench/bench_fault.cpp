// fault() of a benchmark ends the program.
#include <cstdio>
#include <cstdlib>

#include "firmware/base/assert.hpp"

void cusp::fault(const char* expression, const char* file, int line) noexcept
{
    std::fprintf(stderr, "%s:%d: %s does not hold\n", file, line, expression);
    std::abort();
}
