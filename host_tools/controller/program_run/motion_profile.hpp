// MotionProfile: speed, acceleration and jerk of a run over time, in at most a few thousand stretches.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "firmware/base/vec.hpp"
#include "host_tools/controller/program_run/set_point_differences.hpp"

namespace cusp::program_run {

// Greatest magnitudes within a stretch of time.
struct ProfileStretch {
    double speed{0};    // along the path, mm/s
    AxisVecd velocity;  // of each axis: mm/s, mm/s^2, mm/s^3
    AxisVecd acceleration;
    AxisVecd jerk;
    std::uint32_t first_line{0};  // of the program, at the start of the stretch
};

class MotionProfile {
public:
    // All stretches but the last are equally long: the least power of two of servo ticks for which this number
    // suffices.
    static constexpr std::size_t kMostStretches = 2048;

    // The set point of the next servo tick; the first is the start.
    void add(Position set_point, std::uint32_t line);

    const std::vector<ProfileStretch>& stretches() const { return stretches_; }
    double seconds_each() const;
    double seconds() const;

private:
    void halve();

    std::optional<SetPointWindow> window_;
    std::vector<ProfileStretch> stretches_;
    std::uint64_t ticks_each_{1};
    std::uint64_t ticks_{0};
};

}  // namespace cusp::program_run
