// Station: a knot of the time law, and the cell of path that begins there.
//
// The time law keeps the squared speed along the path, x = v^2, as a quadratic spline over the
// travel. Between two knots x is a parabola: the acceleration along the path is x'/2, and the jerk
// v x''/2. Source: docs/numerics.md, "The time law".
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/lane_vec.hpp"
#include "firmware/planner/law_cell.hpp"
#include "firmware/planner/speed_limit.hpp"

namespace cusp::planner {

// Places of a cell at which the law has rows.
inline constexpr unsigned kPlacesOfCell = 3;  // its start, its middle, its end

// Part of the axes' limits that a plan uses: the rest is for the tick to begin to slow its time down.
inline constexpr float kPlanShare = 0.995F;

// Shares of an axis' limits that are not for the law, as factors of powers of the speed.
struct KeptShares {
    LaneVec always;             // of the jerk: a jump of direction while the speed changes
    LaneVec jump;               // of the jerk, times v^2: a jump of curvature in the axis filters
    LaneVec turn;               // of the jerk, times v: a jump of direction
    LaneVec bend;               // of the jerk, times v^3: bends between the places
    LaneVec turn_acceleration;  // of the acceleration, times v
    LaneVec bend_acceleration;  // of the acceleration, times v^2
};

struct Station {
    // q', q'' and q''' of each axis by arc length, with signs, over its jerk.
    std::array<LaneDerivatives, kPlacesOfCell> places;
    KeptShares kept;
    LaneVec moving;  // 1 for an axis that the cell moves or that kept parts name, 0 for others
    bool acceleration_at_end;  // the next cell's start does not stand for this one's end
    float length;              // mm
    float cap;                 // greatest v^2, mm^2/s^2
    std::uint32_t travel;      // the length in path units
    std::int64_t begin;        // path units from the start of the stretch
    path::MoveKind kind;
    std::uint8_t percent;  // of the programmed feed
};

// The start or end of a stretch of path: from rest with constant jerk. x = (9/2 w)^(2/3) s^(4/3),
// so that x' = 4/3 x/s at its inner end.
struct StopElement {
    float length;     // mm
    float cap;        // greatest v^2 at its inner end, mm^2/s^2
    LaneVec along{};  // greatest |q'| of each axis in it, over its jerk
};

}  // namespace cusp::planner
