// Shared by the property tests of motion: number of programs, and checks of limits and end.
#pragma once

#include <cstdlib>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/support/motion_rig.hpp"
#include "tests/support/property_cases.hpp"

namespace cusp::test {

// CUSP_MOTION_PROGRAMS sets how many random programs each test runs; else it is the share of the `usual`.
inline std::uint64_t motion_program_count(int usual = 300)
{
    if (const char* const text = std::getenv("CUSP_MOTION_PROGRAMS")) {
        return std::strtoull(text, nullptr, 10);
    }
    return static_cast<std::uint64_t>(share_of(usual));
}

// CUSP_MOTION_SEED sets the seed of the first of them.
inline std::uint64_t first_motion_seed(std::uint64_t usual)
{
    const char* text = std::getenv("CUSP_MOTION_SEED");
    return text != nullptr ? std::strtoull(text, nullptr, 10) : usual;
}

inline void check_motion(const std::vector<Position>& samples,
                         Position end,
                         const MachineLimits& limits,
                         std::uint64_t seed)
{
    const std::string which = "seed " + std::to_string(seed);
    const LimitUse use = limit_use(samples, {}, limits);
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        CHECK_TEXT(use.velocity[axis] <= 1, (which + ": velocity").c_str());
        CHECK_TEXT(use.acceleration[axis] <= 1, (which + ": acceleration").c_str());
        CHECK_TEXT(use.jerk[axis] <= 1, (which + ": jerk").c_str());
    }
    CHECK_TEXT(samples.back() == end, (which + ": end").c_str());
}

}  // namespace cusp::test
