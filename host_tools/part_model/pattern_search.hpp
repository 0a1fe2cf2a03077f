// A search for a lower place in plan that needs no slopes: tries the ways round, halves its step
// where none leads down.
#pragma once

#include <cmath>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::part_model {

// Walks from `at` to a place where no step leads lower.
//
// step    mm: the first and longest
// finest  mm: steps end here
// lower   lower(place): whether that place is lower, by whatever a double tells apart, than the one
//         the walk stands on; if so the walk goes there
template <class Lower>
Vec2d pattern_search(Vec2d at, double step, double finest, const Lower& lower)
{
    constexpr int kDirections = 8;
    constexpr double kEighth = 0.70710678118654752;  // of a turn: its sine and cosine
    constexpr double kTurn = 0.41;  // radians, so that no valley lies between all directions
    for (double turn = 0; step > finest; turn += kTurn) {
        bool moved = false;
        Vec2d way{step * std::cos(turn), step * std::sin(turn)};
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
