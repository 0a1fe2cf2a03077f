// Samples the normals along isolines of each span.
#include "host_tools/job/import/turning_knots.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/nurbs/knot_insertion.hpp"

namespace cusp::import {

using nurbs::distinct_knots;
using nurbs::Surface;
using nurbs::SurfacePoint;

namespace {

constexpr double kTurnOfSpan = 0.27;  // radians within a span
constexpr int kMostParts = 32;
constexpr int kLinesAcross = 9;
constexpr int kLooks = 9;

// Angle by which the normal turns between two parameters, radians, summed over samples.
template <class Place>
double turn_between(const Surface& s, double from, double to, Place place)
{
    double turn = 0;
    Vec3d before{};
    for (int k = 0; k < kLooks; ++k) {
        const Vec2d at = place(from + (to - from) * k / (kLooks - 1));
        const SurfacePoint p = derivatives_at(s, at.x, at.y);
        const Vec3d n = cross(p.du, p.dv);
        const double length = norm(n);
        if (!(length > 1e-12 * norm(p.du) * norm(p.dv)) || length == 0) {
            continue;  // a pole has no normal
        }
        const Vec3d unit = n / length;
        if (norm(before) > 0) {
            turn += elementary::atan2(norm(cross(before, unit)), dot(before, unit));
        }
        before = unit;
    }
    return turn;
}

template <class Place>
std::vector<double> knots_for(const Surface& s,
                              const std::vector<double>& distinct,
                              double across_begin,
                              double across_end,
                              Place place)
{
    std::vector<double> more;
    for (std::size_t k = 0; k + 1 < distinct.size(); ++k) {
        double turn = 0;
        for (int line = 0; line < kLinesAcross; ++line) {
            const double across =
                across_begin + (across_end - across_begin) * (line + 0.5) / kLinesAcross;
            turn = std::max(turn, turn_between(s, distinct[k], distinct[k + 1],
                                               [&](double along) { return place(along, across); }));
        }
        const int parts = std::min(kMostParts, static_cast<int>(std::ceil(turn / kTurnOfSpan)));
        for (int part = 1; part < parts; ++part) {
            more.push_back(distinct[k] + (distinct[k + 1] - distinct[k]) * part / parts);
        }
    }
    return more;
}

}  // namespace

Surface with_turning_knots(const Surface& s)
{
    const auto more_u =
        knots_for(s, distinct_knots(s.knots_u, s.degree_u, static_cast<std::size_t>(s.size_u)),
                  s.v_begin(), s.v_end(), [](double along, double across) {
                      return Vec2d{along, across};
                  });
    const auto more_v =
        knots_for(s, distinct_knots(s.knots_v, s.degree_v, static_cast<std::size_t>(s.size_v)),
                  s.u_begin(), s.u_end(), [](double along, double across) {
                      return Vec2d{across, along};
                  });
    return with_knots(s, more_u, more_v);
}

}  // namespace cusp::import
