// LawCell: what the servo tick plays: the squared speed over a piece of path, or a stop element.
#pragma once

#include <cstdint>

#include "firmware/base/lane_vec.hpp"
#include "firmware/path/move.hpp"

namespace cusp::planner {

// x = v^2 and its derivatives by arc length.
struct SquaredSpeed {
    float value;  // mm^2/s^2
    float slope;  // mm/s^2
    float bend;   // 1/s^2
};

// `travel` mm further, within the same cell.
inline SquaredSpeed advanced(const SquaredSpeed& x, float travel) noexcept
{
    return {x.value + travel * (x.slope + 0.5F * travel * x.bend), x.slope + travel * x.bend,
            x.bend};
}

enum class LawPiece : std::uint8_t {
    kCell,   // x is a parabola
    kStart,  // from rest with constant jerk; `start` is the state at its end
    kStop,   // the same backwards; `start` is the state at its start
    kBrake,  // from a steady speed, `start`, to half of it: constant jerk, then comes a kStop
};

struct LawCell {
    SquaredSpeed start;
    std::uint32_t travel;  // path units
    LawPiece piece;
    path::MoveKind kind{path::MoveKind::kFeed};
    std::uint8_t percent{100};  // of the programmed feed that it was planned for
    bool ends{false};           // a kStop at the end of its stretch
    bool disjoint{false};       // there no axis moves on both sides
    float overlap{0};           // s, that the next stretch may begin before that
};

// Bounds of a piece of plan, an axis a lane, over the axes' accelerations and jerks.
struct WarpBounds {
    LaneVec speed;     // greatest |V|/a, s
    LaneVec braking;   // least A/a in the direction of V
    LaneVec speeding;  // greatest
    LaneVec falling;   // least J/j of the path itself in the direction of V
    LaneVec rising;    // greatest
    LaneVec joint;     // and of its joints, as the axis filters feel them
    float time;        // own time that it takes, s
};

}  // namespace cusp::planner
