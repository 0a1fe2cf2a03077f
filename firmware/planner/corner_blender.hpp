// CornerBlender: a corner between two lines, and a joint of lines and arcs, becomes a short curve
// within a share of the tolerance.
#pragma once

#include <optional>

#include "firmware/base/machine_limits.hpp"
#include "firmware/base/static_vector.hpp"
#include "firmware/path/move.hpp"

namespace cusp::planner {

// Holds back the last line or arc until the next move is known. At a corner the blend is one symmetric Bezier curve of
// degree 4 whose curvature is zero at both ends: it meets the lines with no jump of direction or
// curvature, so the tool need not stop. A corner whose blend
// would take longer than a stop stays a corner.
class CornerBlender {
public:
    struct Allowance {
        float jerk_time;  // s, over which the axis filters spread a jump of acceleration
        float departure;  // mm, that a blend may leave the move by
    };

    // ramp_time: s, in which the slowest axis reaches its acceleration.
    void set_limits(const MachineLimits& limits, float ramp_time) noexcept
    {
        limits_ = limits;
        ramp_time_ = ramp_time;
    }

    // Variance of the input shaper's response, s^2, and its length, s. 0 and 0 without.
    void set_shaper(float square, float length) noexcept
    {
        shaper_square_ = square;
        shaper_length_ = length;
    }

    // True if add() takes a move: all of its output was taken.
    bool ready() const noexcept { return made_.empty(); }
    bool empty() const noexcept { return made_.empty() && !held_; }

    // Precondition: ready().
    void add(const path::Move& move, const Allowance& allowance) noexcept;

    // The next move to play. With `ending`, the held one too.
    bool next(bool ending, path::Move& move) noexcept;

    void clear() noexcept;

private:
    bool faster_than_stop(const path::BezierPiece& piece,
                          float reach,
                          float feed,
                          float departure) const noexcept;
    void release_front(path::Move& move, float departure) noexcept;
    void release_last(const path::Move& move) noexcept;
    bool blend(path::Move& before, path::Move& after, float departure) noexcept;
    bool join(path::Move& before, path::Move& after, const Allowance& allowance) noexcept;

    MachineLimits limits_{};
    float ramp_time_{1};
    float shaper_square_{0};
    float shaper_length_{0};
    std::optional<path::Move> held_;
    float held_departure_{0};           // mm, for it
    StaticVector<path::Move, 4> made_;  // last first
};

}  // namespace cusp::planner
