// Pattern search in the plan: a minimum without derivatives. Tries eight directions, and halves the
// step where none leads lower.
#pragma once

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::part_model {

// Returns a point, reached from `at`, from which no step leads lower.
//
// step    mm: the first and longest one
// finest  mm: the search ends with steps of this length
// lower   lower(point): whether the point is strictly lower than the present one, which it then
//         replaces
template <class Lower>
Vec2d pattern_search(Vec2d at, double step, double finest, const Lower& lower)
{
    constexpr int kDirections = 8;
    constexpr double kEighth = 0.70710678118654752;  // of a turn: its sine and cosine
    constexpr double kTurn = 0.41;                   // radians: rounds try different directions
    for (double turn = 0; step > finest; turn += kTurn) {
        bool moved = false;
        Vec2d way{step * elementary::cos(turn), step * elementary::sin(turn)};
        for (int k = 0; k < kDirections && !moved; ++k) {
            const Vec2d to{at.x + way.x, at.y + way.y};
            way = {kEighth * (way.x - way.y), kEighth * (way.x + way.y)};
            moved = lower(to);
            at = moved ? to : at;
        }
        step *= moved ? 1.0 : 0.5;
    }
    return at;
}

}  // namespace cusp::part_model
