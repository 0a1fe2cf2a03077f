// How many random cases a property test tries.
#pragma once

#include <cstdlib>

namespace cusp::test {

// CUSP_PROPERTY_CASES, or what suits CI.
inline int property_cases(int usual)
{
    const char* const text = std::getenv("CUSP_PROPERTY_CASES");
    return text != nullptr ? std::atoi(text) : usual;
}

}  // namespace cusp::test
