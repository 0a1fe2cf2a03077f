// Number and first seed of the random cases of a property test.
#pragma once

#include <cstdlib>

namespace cusp::test {

// CUSP_PROPERTY_CASES, or `usual`, the number for CI.
inline int property_cases(int usual)
{
    const char* const text = std::getenv("CUSP_PROPERTY_CASES");
    return text != nullptr ? std::atoi(text) : usual;
}

// CUSP_PROPERTY_FIRST, or `usual`, the first seed for CI.
inline unsigned property_seed(unsigned usual)
{
    const char* const text = std::getenv("CUSP_PROPERTY_FIRST");
    return text != nullptr ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : usual;
}

}  // namespace cusp::test
