// Rounds arcs.
#include "host_tools/geometry/toolpath/rounded_arc.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::toolpath {

std::array<std::int64_t, 2> fitted_centre(Vec2d start, Vec2d end, Vec2d wanted)
{
    const Vec2d chord = end - start;
    const double squared = dot(chord, chord);
    if (squared > 0) {
        wanted = wanted + (dot(0.5 * (start + end) - wanted, chord) / squared) * chord;
    }
    std::array<std::int64_t, 2> best{};
    double least = kUnbounded;
    for (std::int64_t i = -1; i <= 1; ++i) {
        for (std::int64_t j = -1; j <= 1; ++j) {
            const std::array<std::int64_t, 2> candidate{std::llround(wanted.x) + i,
                                                        std::llround(wanted.y) + j};
            const Vec2d c{static_cast<double>(candidate[0]), static_cast<double>(candidate[1])};
            // the distance from the wanted centre breaks ties
            constexpr double kTie = 0.01;
            const double mismatch =
                std::abs(norm(start - c) - norm(end - c)) + kTie * norm(c - wanted);
            if (mismatch < least) {
                least = mismatch;
                best = candidate;
            }
        }
    }
    return best;
}

Vec2d centre_of_radius(Vec2d start, Vec2d end, double radius, bool clockwise)
{
    const Vec2d half = 0.5 * (end - start);
    const double reach = norm(half);
    const double off = std::sqrt(std::max(0.0, radius * radius - reach * reach));
    const Vec2d left{-half.y / reach, half.x / reach};
    return 0.5 * (start + end) + (clockwise ? -off : off) * left;
}

double arc_deviation(const ArcShape& written, const ArcTo& planned)
{
    constexpr int kPlaces = 32;
    const auto axes = axes_of(planned.plane);
    const auto from_centre = [&](Vec3d p) {
        return elementary::hypot(p[axes[0]] - planned.centre[axes[0]],
                                 p[axes[1]] - planned.centre[axes[1]]);
    };
    const double radius = from_centre(planned.end);
    double most = 0;
    for (int k = 0; k <= kPlaces; ++k) {
        const Vec3d p = point_on(written, static_cast<double>(k) / kPlaces);
        most = std::max(most, std::abs(from_centre(p) - radius));
    }
    return most;
}

}  // namespace cusp::toolpath
