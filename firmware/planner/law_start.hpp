// Starts of windows: the steps begin close to the law that they lead to, so that few are needed.
//
//     start_by_ramps(spline, window, end_of_kept(spline, window, planned));
//     if (greatest_use(spline, window) < 1) { ... }  // else the window begins at the plan before it
//
// A start is a proposal: it leaves room to most rows, but no proof that all hold.
// Source: docs/numerics.md, "The time law". Held by tests/unit/planner/law_start_test.cpp.
#pragma once

#include <cstdint>

#include "firmware/planner/barrier.hpp"

namespace cusp::planner {

// The coefficients before this one stay as the last plan has them: behind it that falls to its crawl.
//
//   planned  coefficients of that plan; 0 if there is none.
std::uint32_t end_of_kept(const LawSpline& spline,
                          const LawWindow& window,
                          std::uint32_t planned) noexcept;

// The coefficients [from, window.end) rise from those before them, fall to those behind the window and
// stay below caps and what the path's bends allow; each axis keeps to a part of its acceleration and
// jerk, also where rise and fall meet.
//
// Preconditions: window.begin <= from < window.end, window.end - from <= kMostWindow; where the window does not begin or end with the stretch, the two
// coefficients beyond have their values.
void start_by_ramps(LawSpline& spline, const LawWindow& window, std::uint32_t from) noexcept;

}  // namespace cusp::planner
