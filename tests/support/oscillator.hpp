// The load of an axis: a damped spring and mass, moved by its set points.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "firmware/base/math.hpp"
#include "firmware/base/vec.hpp"

namespace cusp::test {

struct Oscillator {
    double frequency;  // Hz, undamped
    double damping;    // ratio
};

// The amplitude, mm, with which the mass still vibrates when the set points of an axis have come to
// rest: x'' + 2 d w x' + w^2 x = -(acceleration of the set points), x relative to them. The
// acceleration is constant over a tick.
inline double residual_vibration(const std::vector<Position>& samples,
                                 unsigned axis,
                                 const Oscillator& oscillator)
{
    constexpr int kParts = 20;
    constexpr double kTick = 1e-3;
    constexpr double kStep = kTick / kParts;
    const double omega = 2.0 * kPi * oscillator.frequency;
    std::size_t end = samples.size();
    while (end > 1 && samples[end - 2][axis] == samples.back()[axis]) {
        --end;
    }
    double x = 0;
    double v = 0;
    for (std::size_t i = 0; i <= end; ++i) {
        const auto at = [&](std::size_t k) {
            return static_cast<double>(samples[std::min(k, samples.size() - 1)][axis]) * 1e-6;
        };
        const double before = i == 0 ? at(0) : at(i - 1);
        const double acceleration = (at(i + 1) - 2.0 * at(i) + before) / (kTick * kTick);
        const auto slope = [&](double place, double speed) {
            return -2.0 * oscillator.damping * omega * speed - omega * omega * place - acceleration;
        };
        for (int part = 0; part < kParts; ++part) {
            // Runge and Kutta's method of order 4.
            const double k1 = slope(x, v);
            const double v2 = v + 0.5 * kStep * k1;
            const double k2 = slope(x + 0.5 * kStep * v, v2);
            const double v3 = v + 0.5 * kStep * k2;
            const double k3 = slope(x + 0.5 * kStep * v2, v3);
            const double v4 = v + kStep * k3;
            const double k4 = slope(x + kStep * v3, v4);
            x += kStep / 6.0 * (v + 2.0 * v2 + 2.0 * v3 + v4);
            v += kStep / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
        }
    }
    return std::sqrt(x * x + v * v / (omega * omega));
}

}  // namespace cusp::test
