// A patch reaches some degrees beyond its cell. With one knot span a side, the parameter of an angle is
// (1 + tan(angle / 2) / tan(reach / 2)) / 2, from the patch's middle.
#include "host_tools/job/import/revolved_patches.hpp"

#include <algorithm>
#include <array>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/trim_fit.hpp"
#include "host_tools/job/import/trim_loops.hpp"

#include "fmt/format.h"

namespace cusp::import {

using nurbs::Curve;
using nurbs::Surface;

namespace {

constexpr double kReach = 50 * kPi / 180;  // of a patch to each side, radians
const double kTanHalf = elementary::tan(kReach / 2);
constexpr double kMore = 0.05;  // of a line's cell, on each side

struct Control {
    Vec2d point;
    double weight;
};

// An arc of the unit circle about an angle.
std::array<Control, 3> arc(double middle)
{
    const double c = elementary::cos(kReach);
    const auto at = [](double angle, double r) {
        return Vec2d{r * elementary::cos(angle), r * elementary::sin(angle)};
    };
    return {{{at(middle - kReach, 1), 1}, {at(middle, 1 / c), c}, {at(middle + kReach, 1), 1}}};
}

double middle_of(double low, double high) { return 0.5 * (low + high); }

// Distance from the axis and height along it, of the profile in a cell.
std::vector<Control> profile_of(const Revolved& surface, const RevolvedCell& cell)
{
    std::vector<Control> controls;
    if (surface.is_ring()) {
        for (const Control& at : arc(middle_of(cell.low.y, cell.high.y))) {
            controls.push_back({Vec2d{surface.radius, 0} + at.point * surface.tube, at.weight});
        }
        return controls;
    }
    const double more = kMore * (cell.high.y - cell.low.y);
    return {{surface.profile(cell.low.y - more), 1}, {surface.profile(cell.high.y + more), 1}};
}

Surface patch(const Revolved& surface, const RevolvedCell& cell)
{
    const std::vector<Control> profile = profile_of(surface, cell);
    Surface s;
    s.degree_u = 2;
    s.size_u = 3;
    s.knots_u = {0, 0, 0, 1, 1, 1};
    s.size_v = static_cast<int>(profile.size());
    s.degree_v = s.size_v - 1;
    s.knots_v.assign(profile.size(), 0);
    s.knots_v.insert(s.knots_v.end(), profile.size(), 1);
    for (const Control& turn : arc(middle_of(cell.low.x, cell.high.x))) {
        for (const Control& at : profile) {
            s.points.push_back(surface.origin + surface.axes[0] * (at.point.x * turn.point.x) +
                               surface.axes[1] * (at.point.x * turn.point.y) +
                               surface.axes[2] * at.point.y);
            s.weights.push_back(turn.weight * at.weight);
        }
    }
    return s;
}

struct Parameter {
    double value;
    double slope;  // by the angle or the length
};

Parameter of_angle(double angle)
{
    const double c = elementary::cos(angle / 2);
    return {0.5 + 0.5 * elementary::tan(angle / 2) / kTanHalf, 0.25 / (kTanHalf * c * c)};
}

Parameter of_length(double v, double low, double high)
{
    const double more = kMore * (high - low);
    const double size = high - low + 2 * more;
    return {(v - low + more) / size, 1 / size};
}

// Edges that come near the axis are refused.
void check_clear_of_axis(const Revolved& surface,
                         const std::vector<FaceEdge>& edges,
                         double gap,
                         const std::string& place)
{
    double least = kUnbounded;
    if (surface.is_ring()) {
        least = surface.radius - surface.tube;
    } else {
        for (const FaceEdge& edge : edges) {
            for (int k = 0; k <= kEdgeChords; ++k) {
                const PointAndTangent at = edge.at(parameter_of(edge, k));
                least = std::min(least, surface.profile(surface.uv_of(at).point.y).x);
            }
        }
    }
    if (!(least > 2 * gap)) {
        throw InputError(
            fmt::format("{}: the surface is {:.3g} mm from its axis, at least {:.3g} is "
                        "needed",
                        place, least, 2 * gap));
    }
}

}  // namespace

std::vector<Surface> revolved_patches(const Revolved& surface,
                                      const std::vector<FaceEdge>& edges,
                                      double gap,
                                      const std::string& place)
{
    constexpr double kTrim = 1e-5;  // mm
    check_on_surface(
        edges, [&surface](Vec3d p) { return surface.off(p); }, gap, place);
    check_clear_of_axis(surface, edges, gap, place);
    if (edges.empty() && !surface.is_ring()) {
        throw InputError(place + ": a cone or cylinder has no edge");
    }
    std::vector<FaceEdge> in_uv;
    for (const FaceEdge& edge : edges) {
        in_uv.push_back({[&surface, at = edge.at](double t) { return surface.uv_of(at(t)); },
                         edge.from, edge.to});
    }
    std::vector<Surface> patches;
    for (const RevolvedCell& cell : revolved_cells(surface, in_uv, gap, place)) {
        Surface s = patch(surface, cell);
        const auto uv = [&](const PointAndTangent& at) {
            const Parameter u = of_angle(at.point.x - middle_of(cell.low.x, cell.high.x));
            const Parameter v = surface.is_ring()
                                    ? of_angle(at.point.y - middle_of(cell.low.y, cell.high.y))
                                    : of_length(at.point.y, cell.low.y, cell.high.y);
            return PointAndTangent{{u.value, v.value, 0},
                                   {u.slope * at.tangent.x, v.slope * at.tangent.y, 0}};
        };
        // mm by u or v at most
        const double outermost = surface.is_ring() ? surface.radius + surface.tube
                                                   : std::max(surface.profile(cell.low.y).x,
                                                              surface.profile(cell.high.y).x);
        const double steepest = std::max(4 * kTanHalf * outermost, cell.high.y - cell.low.y);
        const std::vector<Curve> curves = fitted_trims(cell.loops, uv, kTrim / steepest);
        if (!curves.empty()) {
            s.trims = trim_loops(curves, s, place);
            patches.push_back(std::move(s));
        }
    }
    return patches;
}

}  // namespace cusp::import
