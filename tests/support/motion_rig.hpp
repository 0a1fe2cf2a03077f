// MotionRig: planner and interpolator alone, fed with moves as fast as they accept them.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "firmware/interpolator/interpolator.hpp"
#include "firmware/planner/planner.hpp"

namespace cusp::test {

struct MotionRig {
    explicit MotionRig(const MachineLimits& limits = {})
        : queue{std::make_unique<planner::PathQueue>()},
          planner{std::make_unique<planner::Planner>(*queue, limits)},
          interpolator{std::make_unique<interpolator::Interpolator>(*planner)}
    {
    }

    void start_at(Position at)
    {
        planner->reset(at);
        interpolator->reset(at);
    }

    // Plays the moves; one set point for each tick. Stops after a million seconds of ticks and
    // returns the set points so far.
    std::vector<Position> run(const std::vector<path::Move>& moves)
    {
        std::vector<Position> samples;
        std::size_t next = 0;
        std::size_t idle = 0;
        while (idle < 3) {
            while (next < moves.size() && takes_another()) {
                planner->push(moves[next]);
                ++next;
            }
            if (next == moves.size() && takes_another()) {
                planner->close();
                planner->work();
            }
            samples.push_back(interpolator->tick());
            idle =
                next == moves.size() && planner->empty() && interpolator->at_rest() ? idle + 1 : 0;
            if (samples.size() > kMostTicks) {
                break;
            }
        }
        return samples;
    }

    // As run(), with holds, resumes, overrides and starvation at random ticks.
    std::vector<Position> run_disturbed(const std::vector<path::Move>& moves, std::uint64_t seed)
    {
        std::mt19937_64 random{seed};
        std::vector<Position> samples;
        std::size_t next = 0;
        std::size_t idle = 0;
        std::size_t until = 0;
        while (idle < 3 && samples.size() < kMostTicks) {
            while (next < moves.size() && takes_another() && random() % 3 != 0) {
                planner->push(moves[next]);
                ++next;
            }
            if (random() % 50 == 0 || (next == moves.size() && takes_another())) {
                planner->close();
                planner->work();
            }
            if (samples.size() >= until) {
                until = samples.size() + 1 + random() % 60;
                disturb(random);
            }
            samples.push_back(interpolator->tick());
            idle =
                next == moves.size() && planner->empty() && interpolator->at_rest() ? idle + 1 : 0;
        }
        return samples;
    }

    // A disturbance at one tick.
    enum class Event { kHold, kSlower, kFaster, kStarve };

    // As run(), with one event; a hold is resumed once the tool is at rest, a starved planner is
    // fed again.
    std::vector<Position> run_struck(const std::vector<path::Move>& moves,
                                     std::size_t tick,
                                     Event event)
    {
        std::vector<Position> samples;
        std::size_t next = 0;
        std::size_t idle = 0;
        while (idle < 3 && samples.size() < kMostTicks) {
            if (samples.size() == tick) {
                strike(event);
            }
            const bool starved = event == Event::kStarve && samples.size() < tick;
            // Until then the planner gets only a few moves, so that it does starve.
            const std::size_t known =
                starved ? std::min<std::size_t>(moves.size(), 5) : moves.size();
            while (next < known && takes_another()) {
                planner->push(moves[next]);
                ++next;
            }
            if (next == known && takes_another()) {
                planner->close();
                planner->work();
            }
            if (interpolator->holding() && interpolator->at_rest()) {
                interpolator->resume();
            }
            samples.push_back(interpolator->tick());
            idle =
                next == moves.size() && planner->empty() && interpolator->at_rest() ? idle + 1 : 0;
        }
        return samples;
    }

    bool takes_another()
    {
        while (planner->work()) {
        }
        return planner->has_room();
    }

    void strike(Event event)
    {
        switch (event) {
            case Event::kHold:
                interpolator->hold();
                break;
            case Event::kSlower:
                interpolator->set_feed_override(40);
                interpolator->set_rapid_override(25);
                break;
            case Event::kFaster:
                interpolator->set_feed_override(200);
                break;
            case Event::kStarve:
                break;
        }
    }

    void disturb(std::mt19937_64& random)
    {
        switch (random() % 5) {
            case 0:
                interpolator->hold();
                break;
            case 1:
                interpolator->set_feed_override(static_cast<unsigned>(10 + random() % 191));
                break;
            case 2:
                interpolator->set_rapid_override(static_cast<unsigned>(25 + random() % 76));
                break;
            default:
                interpolator->resume();
                break;
        }
    }

    static constexpr std::size_t kMostTicks = 4'000'000;
    std::unique_ptr<planner::PathQueue> queue;
    std::unique_ptr<planner::Planner> planner;
    std::unique_ptr<interpolator::Interpolator> interpolator;
};

// Largest |difference| of set points of each axis relative to the limit, corrected for rounding.
struct LimitUse {
    AxisVecd velocity, acceleration, jerk;
};

// Rounding to whole nanometres adds up to 1, 2 and 4 nm to the first three differences; `rounded`: of how
// many such numbers a set point is the sum.
inline LimitUse limit_use(const std::vector<Position>& samples,
                          Position start,
                          const MachineLimits& limits,
                          int rounded = 1)
{
    LimitUse use{};
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        std::int64_t p[4] = {start[axis], start[axis], start[axis], start[axis]};
        for (const Position& sample : samples) {
            p[0] = p[1], p[1] = p[2], p[2] = p[3], p[3] = sample[axis];
            const auto part = [rounded](std::int64_t nm, int rounding, double scale, float limit) {
                const double excess = std::fabs(static_cast<double>(nm)) - rounding * rounded;
                return excess * 1e-6 * scale / static_cast<double>(limit);
            };
            use.velocity[axis] =
                std::max(use.velocity[axis], part(p[3] - p[2], 1, 1e3, limits.velocity[axis]));
            use.acceleration[axis] =
                std::max(use.acceleration[axis],
                         part(p[3] - 2 * p[2] + p[1], 2, 1e6, limits.acceleration[axis]));
            use.jerk[axis] = std::max(
                use.jerk[axis], part(p[3] - 3 * p[2] + 3 * p[1] - p[0], 4, 1e9, limits.jerk[axis]));
        }
    }
    return use;
}

}  // namespace cusp::test
