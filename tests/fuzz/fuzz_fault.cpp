// fault() of a fuzzer is a find.
#include <cstdio>
#include <cstdlib>

#include "firmware/base/assert.hpp"

void cusp::fault(const char* expression, const char* file, int line) noexcept
{
    (void)std::fprintf(stderr, "%s:%d: %s\n", file, line, expression);
    std::abort();
}
