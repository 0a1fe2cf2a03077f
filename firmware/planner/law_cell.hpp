// LawCell: what the servo tick plays: the squared speed over a piece of path, or a stop element.
#pragma once

#include <cstdint>

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
};

}  // namespace cusp::planner
