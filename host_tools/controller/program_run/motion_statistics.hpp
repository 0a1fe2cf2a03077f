// MotionStatistics: greatest velocity, acceleration and jerk, length and time of a run.
#pragma once

#include <cstdint>

#include "firmware/base/axis.hpp"
#include "firmware/base/vec.hpp"
#include "host_tools/controller/program_run/set_point_differences.hpp"

namespace cusp::program_run {

// Takes one set point for each servo tick, in whole nanometres, so that the figures are those of the samples file,
// without rounding to float.
class MotionStatistics {
public:
    explicit MotionStatistics(Position start) : window_{start} {}

    void add(Position set_point);

    // Adds ticks of rest until all differences are complete. Call before reading the figures.
    void finish();

    // Greatest of each axis: mm/s, mm/s^2, mm/s^3.
    AxisVecd max_velocity() const;
    AxisVecd max_acceleration() const;
    AxisVecd max_jerk() const;

    // From the first to the last tick with motion, both included.
    std::uint64_t moving_ticks() const;
    std::uint64_t ticks() const { return ticks_; }
    Position end() const { return window_.latest(); }
    // Length of the path of set points, mm.
    double length() const { return length_; }

private:
    void take(Position set_point);

    SetPointWindow window_;
    Position velocity_{};  // greatest of each axis, nm a tick ...
    Position acceleration_{};
    Position jerk_{};
    std::uint64_t ticks_{0};
    std::uint64_t first_moving_{0};
    std::uint64_t last_moving_{0};
    double length_{0};
};

}  // namespace cusp::program_run
