// Number of random cases of a property test.
#pragma once

#include <cstdlib>

namespace cusp::test {

// CUSP_PROPERTY_CASES, or `usual`, the number for CI.
inline int property_cases(int usual)
{
    const char* const text = std::getenv("CUSP_PROPERTY_CASES");
    return text != nullptr ? std::atoi(text) : usual;
}

}  // namespace cusp::test
