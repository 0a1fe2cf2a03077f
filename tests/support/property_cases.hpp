// Number and first seed of the random cases of a property test.
#pragma once

#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>

namespace cusp::test {

// The share CUSP_PROPERTY_SHARE (0 to 1, default 1) of `usual`, rounded up.
inline int share_of(int usual)
{
    const char* const share = std::getenv("CUSP_PROPERTY_SHARE");
    return share != nullptr ? static_cast<int>(std::ceil(std::atof(share) * usual)) : usual;
}

// CUSP_PROPERTY_CASES, or the share of `usual`.
inline int property_cases(int usual)
{
    const char* const cases = std::getenv("CUSP_PROPERTY_CASES");
    return cases != nullptr ? std::atoi(cases) : share_of(usual);
}

// CUSP_PROPERTY_FIRST, or `usual`, the first seed for CI.
inline unsigned property_seed(unsigned usual)
{
    const char* const text = std::getenv("CUSP_PROPERTY_FIRST");
    return text != nullptr ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : usual;
}

// The text of `wrong_of` for each seed, a line each of the first 20; empty if all hold.
inline std::string broken_cases(unsigned first,
                                int cases,
                                const std::function<std::string(unsigned seed)>& wrong_of)
{
    constexpr int kMostSaid = 20;
    std::string wrong;
    int broken = 0;
    for (int i = 0; i < cases; ++i) {
        const std::string found = wrong_of(first + static_cast<unsigned>(i));
        broken += found.empty() ? 0 : 1;
        wrong += found.empty() || broken > kMostSaid ? "" : found + "\n";
    }
    return wrong;
}

}  // namespace cusp::test
