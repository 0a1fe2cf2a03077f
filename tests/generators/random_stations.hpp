// Random stations of a time law: each axis' path is a sum of waves, its limits up to 1:100 apart.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "firmware/base/machine_limits.hpp"
#include "firmware/planner/station.hpp"

namespace cusp::test {

class RandomStations {
public:
    explicit RandomStations(std::uint64_t seed) : random_{seed}
    {
        for (unsigned i = 0; i < kAxisCount; ++i) {
            limits.velocity[i] = static_cast<float>(between(5, 500));
            limits.acceleration[i] = static_cast<float>(between(80, 8000));
            limits.jerk[i] = limits.acceleration[i] * static_cast<float>(between(5, 300));
        }
        // One axis in three stands still.
        still_ = static_cast<unsigned>(random_() % 9);
        for (unsigned i = 0; i < kAxisCount; ++i) {
            waves_[i] = {between(1e-3, 1), between(0.01, 3), between(0.001, 6)};
        }
        length_ = between(0.01, 1);
        step_ = between(0.05, 2);
    }

    // The next station, its cell up to a quarter longer or shorter than the last.
    planner::Station next()
    {
        planner::Station station{};
        length_ *= std::exp(std::uniform_real_distribution<double>{-0.2, 0.2}(random_));
        station.length = static_cast<float>(length_);
        station.cap = static_cast<float>(between(50, 90000));
        for (unsigned p = 0; p < planner::kPlacesOfCell; ++p) {
            station.places[p] = place(at_ + 0.5 * p * length_);
        }
        at_ += length_;
        AxisVecf moving{};
        for (unsigned i = 0; i < kAxisCount; ++i) {
            moving[i] = i == still_ ? 0.0F : 1.0F;
        }
        station.moving = to_lanes(moving);
        station.acceleration_at_end = random_() % 4 == 0;
        station.kept.bend = kept(1e-9, 1e-6);
        station.kept.bend_acceleration = kept(1e-8, 1e-5);
        if (random_() % 6 == 0) {
            station.kept.always = kept(1e-6, 0.3);
            station.kept.jump = kept(1e-7, 1e-3);
            station.kept.turn = kept(1e-6, 1e-3);
            station.kept.turn_acceleration = kept(1e-6, 1e-3);
        }
        return station;
    }

    double between(double low, double high)
    {
        return std::exp(
            std::uniform_real_distribution<double>{std::log(low), std::log(high)}(random_));
    }
    std::uint64_t number() { return random_(); }

    MachineLimits limits;

private:
    struct Wave {
        double size;  // greatest |q'|
        double phase;
        double frequency;  // 1/mm
    };

    planner::LaneDerivatives place(double s) const
    {
        AxisVecf first{};
        AxisVecf second{};
        AxisVecf third{};
        for (unsigned i = 0; i < kAxisCount; ++i) {
            if (i == still_) {
                continue;
            }
            const Wave& w = waves_[i];
            const double angle = w.phase + w.frequency * s * step_;
            const double rate = w.frequency * step_;
            const double scale = w.size / static_cast<double>(limits.jerk[i]);
            first[i] = static_cast<float>(scale * std::cos(angle));
            second[i] = static_cast<float>(-scale * rate * std::sin(angle));
            third[i] = static_cast<float>(-scale * rate * rate * std::cos(angle));
        }
        return {to_lanes(first), to_lanes(second), to_lanes(third)};
    }

    LaneVec kept(double low, double high)
    {
        AxisVecf shares{};
        for (unsigned i = 0; i < kAxisCount; ++i) {
            shares[i] = i == still_ ? 0.0F : static_cast<float>(between(low, high));
        }
        return to_lanes(shares);
    }

    std::mt19937_64 random_;
    std::array<Wave, 3> waves_{};
    unsigned still_{9};
    double length_;  // mm, of the last cell
    double step_;
    double at_{0};
};

}  // namespace cusp::test
