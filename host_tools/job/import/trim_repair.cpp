// Merges ends that nearly meet; replaces curves near poles by chords.
#include "host_tools/job/import/trim_repair.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace cusp::import {

using nurbs::Curve;
using nurbs::Surface;
using nurbs::SurfacePoint;

namespace {

// Largest distance in (u, v), as a fraction of the domain, of edge ends that are the same vertex:
// the tolerance of vertices in CAD files is 1e-3 mm at best.
constexpr double kSameVertex = 2e-3;
constexpr double kNearVertex = 0.05;  // the same, of ends that a tolerance of the file keeps apart
constexpr double kSamePole = 1e-3;    // mm
// Converted curves along a seam deviate by up to a tenth of a millimetre from the seam.
constexpr double kNearPole = 0.1;  // mm

bool lies_inside(Vec3d p, const Surface& s)
{
    return p.x >= s.u_begin() && p.x <= s.u_end() && p.y >= s.v_begin() && p.y <= s.v_end();
}

// Clamps points just outside the domain, and points near a pole, where a change of the parameter
// hardly moves the point.
Vec3d pulled_inside(Vec3d p, const Surface& s)
{
    const Vec3d inside{std::clamp(p.x, s.u_begin(), s.u_end()),
                       std::clamp(p.y, s.v_begin(), s.v_end()), 0};
    const SurfacePoint at = derivatives_at(s, inside.x, inside.y);
    const double off_u = std::abs(p.x - inside.x);
    const double off_v = std::abs(p.y - inside.y);
    const bool near = off_u <= kSameVertex * (s.u_end() - s.u_begin()) &&
                      off_v <= kSameVertex * (s.v_end() - s.v_begin());
    return near || off_u * norm(at.du) + off_v * norm(at.dv) <= kNearPole ? inside : p;
}

// Distance of the point from the domain, as a fraction of the domain's size.
double outside(Vec3d p, const Surface& s)
{
    const double off_u = std::max({0.0, s.u_begin() - p.x, p.x - s.u_end()});
    const double off_v = std::max({0.0, s.v_begin() - p.y, p.y - s.v_end()});
    return std::max(off_u / (s.u_end() - s.u_begin()), off_v / (s.v_end() - s.v_begin()));
}

// Control points of a curve inside the domain may be outside: only points as far out as the curve
// itself are moved. Near a pole the control points of a converted curve are far outside while the
// curve is not: there chords replace it.
void pull_inside(Curve& curve, const Surface& s)
{
    constexpr int kChords = 256;
    constexpr double kInside = 1e-6;   // of the domain: rounding
    constexpr double kAsFarOut = 2.0;  // times
    std::vector<Vec3d> places;
    double most = 0;
    for (int k = 0; k <= kChords; ++k) {
        const double t = static_cast<double>(k) / kChords;
        places.push_back(point_at(curve, curve.domain_begin() * (1 - t) + curve.domain_end() * t));
        most = std::max(most, outside(places.back(), s));
    }
    Curve pulled = curve;
    for (Vec3d& p : pulled.points) {
        p = outside(p, s) <= std::max(kInside, kAsFarOut * most) ? pulled_inside(p, s) : p;
    }
    if (most <= kInside || std::all_of(pulled.points.begin(), pulled.points.end(),
                                       [&](Vec3d p) { return lies_inside(p, s); })) {
        curve = pulled;
        return;
    }
    Curve chords{1, {0}, {}, {}};
    for (int k = 0; k <= kChords; ++k) {
        chords.points.push_back(pulled_inside(places[static_cast<std::size_t>(k)], s));
        chords.weights.push_back(1);
        chords.knots.push_back(static_cast<double>(k) / kChords);
    }
    chords.knots.push_back(1);
    curve = chords;
}

// mm: of a line in (u, v) on the surface, by chords.
double length_on(const Surface& s, Vec3d from, Vec3d to)
{
    constexpr int kChords = 16;
    double length = 0;
    Vec3d last = point_at(s, from.x, from.y);
    for (int k = 1; k <= kChords; ++k) {
        const Vec3d at = from + (to - from) * (1.0 * k / kChords);
        const Vec3d next = point_at(s, at.x, at.y);
        length += norm(next - last);
        last = next;
    }
    return length;
}

}  // namespace

void tidy(std::vector<Curve>& loop, const Surface& s)
{
    const double width = s.u_end() - s.u_begin();
    const double height = s.v_end() - s.v_begin();
    for (Curve& curve : loop) {
        pull_inside(curve, s);
    }
    for (std::size_t i = 0; i < loop.size(); ++i) {
        Vec3d& end = loop[i].points.back();
        Vec3d& next = loop[(i + 1) % loop.size()].points.front();
        if (std::abs(end.x - next.x) <= kSameVertex * width &&
            std::abs(end.y - next.y) <= kSameVertex * height) {
            end = next = 0.5 * (end + next);
        }
    }
}

LoopRepair bridge_gaps(std::vector<Curve>& loop,
                       const std::vector<bool>& point_follows,
                       double gap,
                       const Surface& s)
{
    const auto within = [&s](Vec3d end, Vec3d next, double share) {
        return std::array{std::abs(end.x - next.x) <= share * (s.u_end() - s.u_begin()),
                          std::abs(end.y - next.y) <= share * (s.v_end() - s.v_begin())};
    };
    LoopRepair gaps;
    for (std::size_t i = loop.size(); i-- > 0;) {
        const Vec3d end = loop[i].points.back();
        const Vec3d next = loop[(i + 1) % loop.size()].points.front();
        if (end == next) {
            continue;
        }
        const double length = length_on(s, end, next);
        const auto [same_u, same_v] = within(end, next, kSameVertex);
        const auto [near_u, near_v] = within(end, next, kNearVertex);
        const bool is_point = point_follows[i] || ((same_u || same_v) && length < kSamePole);
        if (is_point || (near_u && near_v && length <= gap)) {
            double& most = is_point ? gaps.longest_point : gaps.widest_gap;
            most = std::max(most, length);
            loop.insert(loop.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                        Curve{1, {0, 0, 1, 1}, {end, next}, {1, 1}});
        }
    }
    return gaps;
}

}  // namespace cusp::import
