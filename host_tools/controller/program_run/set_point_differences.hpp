// Differences of set points: velocity, acceleration and jerk in nanometres a servo tick.
#pragma once

#include <array>

#include "firmware/base/vec.hpp"

namespace cusp::program_run {

struct SetPointDifferences {
    Position velocity;      // nm a tick
    Position acceleration;  // nm a tick^2
    Position jerk;          // nm a tick^3
};

// The last set points of a run; before its start the machine was at rest.
class SetPointWindow {
public:
    explicit SetPointWindow(Position start) : last_{start, start, start} {}

    Position latest() const { return last_[0]; }

    // The differences that end at the next set point.
    SetPointDifferences take(Position p)
    {
        const auto [a, b, c] = last_;
        const Position acceleration = p - a - (a - b);
        last_ = {p, a, b};
        return {p - a, acceleration, acceleration - (a - b - (b - c))};
    }

private:
    std::array<Position, 3> last_;  // newest first
};

}  // namespace cusp::program_run
