// Random programs for the motion core: lines, arcs, helices, reversals, tiny and huge, mixed feeds.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "firmware/base/machine_limits.hpp"
#include "firmware/path/move.hpp"
#include "firmware/planner/input_shaper.hpp"

namespace cusp::test {

class RandomMoves {
public:
    explicit RandomMoves(std::uint64_t seed) : random_{seed}, turns_{seed} {}

    std::vector<path::Move> program()
    {
        const int count = 1 + static_cast<int>(random_() % 40);
        tolerance_ = random_() % 2 == 0 ? 0.01F : 0.0F;
        feed_ = static_cast<float>(between(1, 150));
        scale_ = std::pow(10, between(-3, 1.7));
        for (int i = 0; i < count; ++i) {
            add();
        }
        return moves_;
    }

    double between(double low, double high)
    {
        return std::uniform_real_distribution<double>{low, high}(random_);
    }
    std::uint64_t number() { return random_(); }

private:
    void add()
    {
        if (number() % 8 == 0) {
            feed_ = static_cast<float>(between(0.5, 200));
        }
        if (number() % 5 == 0) {
            scale_ = std::pow(10, between(-3, 1.7));
        }
        if (number() % 12 == 0) {
            add_dense_run();
            return;
        }
        path::Move move;
        const std::uint64_t scaling = number() % 6;
        move.kind = scaling == 0   ? path::MoveKind::kRapid
                    : scaling == 1 ? path::MoveKind::kFixedFeed
                                   : path::MoveKind::kFeed;
        move.start = at_;
        move.tolerance = tolerance_;
        move.feed = feed_;
        move.line = static_cast<std::uint32_t>(moves_.size() + 1);
        const double length = scale_ * between(0.2, 1);
        const auto kind = number() % 4;
        if (kind == 3 ? !make_arc(move, length) : !make_line(move, length, kind)) {
            return;
        }
        moves_.push_back(move);
        at_ = move.end;
    }

    // Chords of a curve with drifting curvature; ends are rounded to micrometres or not at all.
    void add_dense_run()
    {
        const auto chords = 5 + number() % 60;
        const double chord = between(0.02, 0.5);
        const std::int64_t grain = number() % 2 == 0 ? 1000 : 1;
        double bend = between(-1, 1) / chord * 0.2;
        for (std::uint64_t i = 0; i < chords; ++i) {
            bend += between(-0.1, 0.1) * 0.2 / chord;
            const double turn = std::clamp(bend * chord, -0.25, 0.25);
            const Vec3d side = unit(cross(xyz(direction_), {0.1, 0.2, 1}));
            direction_ = unit(direction_ + turning(side * turn));
            path::Move move;
            move.start = at_;
            move.tolerance = tolerance_;
            move.feed = feed_;
            move.line = static_cast<std::uint32_t>(moves_.size() + 1);
            move.end = at_ + to_position(direction_ * chord);
            for (unsigned axis = 0; axis < kAxisCount; ++axis) {
                move.end[axis] -= move.end[axis] % grain;
            }
            if (move.end != move.start) {
                moves_.push_back(move);
                at_ = move.end;
            }
        }
    }

    // In any direction, nearly tangential, or exactly tangential.
    bool make_line(path::Move& move, double length, std::uint64_t kind)
    {
        if (kind == 0) {
            direction_ = unit(any_way(1));
        } else if (kind == 1) {
            direction_ = unit(direction_ + any_way(.01));
        }
        move.end = at_ + to_position(direction_ * length);
        move.path = path::Line{};
        if (move.end == move.start) {
            return false;
        }
        direction_ = unit(to_millimetres(move.end - move.start));
        return true;
    }

    // An arc or helix that starts tangentially to the previous move.
    bool make_arc(path::Move& move, double radius)
    {
        const Vec3d any = xyz(any_way(1));
        if (norm(xyz(direction_)) < 1e-3) {
            return false;
        }
        const Vec3d along = kHasRotaryAxis ? unit(xyz(direction_)) : xyz(direction_);
        const Vec3d across = any - along * dot(any, along);
        if (norm(across) < 1e-3) {
            return false;
        }
        path::Arc arc{};
        const Vec3d inward = unit(across);
        const double rise = number() % 2 == 0 ? 0 : between(-.2, .2) * radius;
        arc.centre = inward * radius;
        arc.u = -inward;
        arc.v = along;
        arc.radius = radius;
        arc.sweep = between(0.05, 6);
        arc.axial = turning(cross(along, inward) * rise);
        const double cosine = std::cos(arc.sweep);
        const double sine = std::sin(arc.sweep);
        const AxisVecd end =
            arc.centre + arc.u * (radius * cosine) + arc.v * (radius * sine) + arc.axial;
        if (norm(end) < 1e-5) {
            return false;
        }
        move.path = arc;
        move.end = at_ + to_position(end);
        direction_ = unit((arc.v * cosine - arc.u * sine) * (radius * arc.sweep) + arc.axial);
        return true;
    }

    template <class Vector>
    static Vector unit(Vector a)
    {
        return a / norm(a);
    }
    // Up to so much of each axis.
    AxisVecd any_way(double most)
    {
        AxisVecd way{};
        for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
            way[axis] = between(-most, most);
        }
        for (unsigned axis = kLinearAxes; axis < kAxisCount; ++axis) {
            way[axis] = most * (2 * part_(turns_) - 1);
        }
        return way;
    }
    // With a turn of A about as long, sometimes.
    AxisVecd turning(Vec3d way)
    {
        AxisVecd turned{way};
        for (unsigned axis = kLinearAxes; axis < kAxisCount; ++axis) {
            turned[axis] = turns_() % 2 == 0 ? 0 : (2 * part_(turns_) - 1) * norm(way);
        }
        return turned;
    }

    std::mt19937_64 random_;
    std::mt19937_64 turns_;  // of A alone
    std::uniform_real_distribution<double> part_{0, 1};
    std::vector<path::Move> moves_;
    Position at_{};
    AxisVecd direction_{1, 0, 0};
    double scale_{1};
    float feed_{1};
    float tolerance_{0};
};

// Random limits: 10 to 500 mm/s, 50 to 8000 mm/s^2, reached in 3 to 200 ms. Even seeds: the default
// settings.
inline MachineLimits random_limits(std::uint64_t seed)
{
    MachineLimits limits{};
    limits.set_rotary(true);
    if (seed % 2 == 0) {
        return limits;
    }
    std::mt19937_64 random{seed};
    const auto between = [&random](double low, double high) {
        std::uniform_real_distribution<double> exponent{std::log(low), std::log(high)};
        return static_cast<float>(std::exp(exponent(random)));
    };
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        limits.velocity[axis] = between(10, 500);
        limits.acceleration[axis] = between(50, 8000);
        limits.jerk[axis] = limits.acceleration[axis] * between(5, 300);
    }
    return limits;
}

// A random input shaper, short enough for the interpolator: one to three axes, any types.
inline planner::InputShaper random_shaper(std::uint64_t seed)
{
    std::mt19937_64 random{seed};
    const auto between = [&random](double low, double high) {
        return static_cast<float>(std::uniform_real_distribution<double>{low, high}(random));
    };
    for (;;) {
        PerAxis<planner::AxisVibration> axes{};
        for (planner::AxisVibration& axis : axes) {
            axis = {static_cast<planner::ShaperType>(random() % 4), between(10, 200),
                    between(0, 0.3)};
        }
        const planner::InputShaper shaper = planner::make_input_shaper(axes);
        if (shaper.on() && shaper.ticks <= planner::kMostShaperTicks) {
            return shaper;
        }
    }
}

}  // namespace cusp::test
