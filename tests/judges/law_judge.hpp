// Judge of time laws: what a spline uses of the axes' limits, in long double and from speed and
// acceleration along the path, not from its rows.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "firmware/planner/barrier.hpp"

namespace cusp::test {

// Rounding of the spline's own coefficients to float.
inline constexpr long double kLawRounding = 2e-6L;

// The spline at a place of a cell, by de Boor's scheme.
struct ExactSpeed {
    long double value, slope, bend;
};

inline ExactSpeed law_at(const planner::LawSpline& spline, std::uint32_t k, long double part)
{
    const auto h = [&](std::uint32_t i) {
        return static_cast<long double>(spline.station(i).length);
    };
    const auto c = [&](std::uint32_t i) {
        return static_cast<long double>(spline.coefficient(i));
    };
    const long double before = k == 0 ? h(0) : h(k - 1);
    const long double own = h(k);
    const long double after = h(k + 1);
    const long double s = part * own;
    const long double a = c(k) + (before + s) / (before + own) * (c(k + 1) - c(k));
    const long double b = c(k + 1) + s / (own + after) * (c(k + 2) - c(k + 1));
    const long double rise_a = (c(k + 1) - c(k)) / (before + own);
    const long double rise_b = (c(k + 2) - c(k + 1)) / (own + after);
    const long double bend = 2 * (rise_b - rise_a) / own;
    return {a + part * (b - a), 2 * (rise_a + part * (rise_b - rise_a)), bend};
}

// Largest part of a limit used at a place: speed and acceleration along the path make the axis'.
inline long double use_at(const planner::LaneDerivatives& lanes,
                          const planner::KeptShares& kept,
                          const LaneVec& jerk_over_acceleration,
                          const ExactSpeed& x,
                          bool with_acceleration)
{
    const AxisVecf q1 = to_vec(lanes.first);
    const AxisVecf q2 = to_vec(lanes.second);
    const AxisVecf q3 = to_vec(lanes.third);
    const AxisVecf ratio = to_vec(jerk_over_acceleration);
    const long double v = std::sqrt(x.value);
    const long double u = x.slope / 2;
    const long double w = v * x.bend / 2;
    long double most = 0;
    for (unsigned i = 0; i < kAxisCount; ++i) {
        const long double a1 = static_cast<long double>(q1[i]);
        const long double a2 = static_cast<long double>(q2[i]);
        const long double a3 = static_cast<long double>(q3[i]);
        const long double jerk = std::fabs(a3 * v * v * v + 3 * a2 * v * u + a1 * w) +
                                 static_cast<long double>(to_vec(kept.always)[i]) +
                                 static_cast<long double>(to_vec(kept.jump)[i]) * v * v +
                                 static_cast<long double>(to_vec(kept.turn)[i]) * v +
                                 static_cast<long double>(to_vec(kept.bend)[i]) * v * v * v;
        const long double acceleration =
            std::fabs(a2 * v * v + a1 * u) * static_cast<long double>(ratio[i]) +
            static_cast<long double>(to_vec(kept.turn_acceleration)[i]) * v +
            static_cast<long double>(to_vec(kept.bend_acceleration)[i]) * v * v;
        most = std::max(most, jerk);
        if (with_acceleration) {
            most = std::max(most, acceleration);
        }
    }
    return most;
}

inline long double largest_law_use(const planner::LawSpline& spline, std::uint32_t cells)
{
    long double most = 0;
    for (std::uint32_t k = 0; k < cells; ++k) {
        const planner::Station& station = spline.station(k);
        for (unsigned p = 0; p < planner::kPlacesOfCell; ++p) {
            const ExactSpeed x = law_at(spline, k, static_cast<long double>(p) / 2);
            most = std::max(most, use_at(station.places[p], station.kept, spline.ratio, x,
                                         p < 2 || station.acceleration_at_end));
        }
    }
    return most;
}

}  // namespace cusp::test
