// True if a move stays where the machine can go: the soft limits.
#pragma once

#include "firmware/machine/settings.hpp"
#include "firmware/path/move.hpp"

namespace cusp::machine {

// The smallest box that holds a path, machine nanometres.
struct Extent {
    Position least;
    Position most;
};

// Exact for lines; arcs within 2 nm; curves: the box of their control points, which holds them.
Extent extent_of(const path::Move& move) noexcept;

// True if all of it lies in Grbl's machine space, -travel to 0 on each axis.
bool within_travel(const path::Move& move, const Settings& settings) noexcept;

// True if soft limits let it pass: it lies within the travel or, where the machine is beyond it,
// is a line that goes no further out on any axis: the way back.
bool may_travel(const path::Move& move, const Settings& settings) noexcept;

}  // namespace cusp::machine
