// The check of a plan before it is published: every axis' limits at places between the rows.
//
// Rows stand at three places of a cell; what lies between is kept of the limits by a part only
// (station_maker). Here the path itself is asked, at eight places of each cell of the window.
// Source: docs/numerics.md, "The time law". Held by tests/unit/planner/station_spacing_test.cpp.
#pragma once

#include "firmware/planner/law_path.hpp"
#include "firmware/planner/time_law.hpp"

namespace cusp::planner {

// Greatest share of a limit that the window of a law uses at the places of its cells: no more than 1
// where the plan may be published.
//
//   cursor  near the window's first cell.
//
// Precondition: law.state() == TimeLaw::State::kChecks. Context: main loop.
float greatest_use(const TimeLaw& law,
                   const LawPath& path,
                   PathCursor& cursor,
                   const MachineLimits& limits) noexcept;

}  // namespace cusp::planner
