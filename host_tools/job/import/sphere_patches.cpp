// A patch reaches 60 degrees to each side of its octant's middle, which is 54.7 from the corners. With
// one knot span a side, u = (1 + tan(longitude / 2) / tan(30 degrees)) / 2, and v of the latitude alike.
#include "host_tools/job/import/sphere_patches.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/trim_fit.hpp"
#include "host_tools/job/import/trim_loops.hpp"

#include "fmt/format.h"

namespace cusp::import {

using nurbs::Curve;
using nurbs::Surface;

namespace {

// Three unit vectors, right-handed.
using Axes = std::array<Vec3d, 3>;

Vec3d into(const Axes& axes, Vec3d p)
{
    return {dot(axes[0], p), dot(axes[1], p), dot(axes[2], p)};
}

Vec3d unit(Vec3d p) { return p / norm(p); }

Axes axes_of(Vec3d first, Vec3d beside)
{
    const Vec3d x = unit(first);
    const Vec3d y = unit(beside - x * dot(x, beside));
    return {x, y, cross(x, y)};
}

// Edges in other axes, put on the unit sphere.
std::vector<FaceEdge> on_unit_sphere(const std::vector<FaceEdge>& edges,
                                     Vec3d centre,
                                     const Axes& axes)
{
    std::vector<FaceEdge> out;
    for (const FaceEdge& edge : edges) {
        out.push_back({[at = edge.at, centre, axes](double t) {
                           const PointAndTangent found = at(t);
                           const Vec3d p = into(axes, found.point - centre);
                           const Vec3d d = into(axes, found.tangent);
                           const double r = norm(p);
                           return PointAndTangent{p / r, (d - p * (dot(p, d) / (r * r))) / r};
                       },
                       edge.from, edge.to});
    }
    return out;
}

// The axes whose planes cut the edges best, of some that are spread evenly.
Axes best_axes(const std::vector<FaceEdge>& edges, Vec3d centre)
{
    constexpr int kChoices = 40;
    constexpr double kGoldenAngle = 2.39996322972865332;
    Axes best{};
    double most = -1;
    for (int i = 0; i < kChoices; ++i) {
        const double z = (i + 0.5) / kChoices;
        const double angle = kGoldenAngle * i;
        const double across = std::sqrt(1 - z * z);
        const Vec3d first{across * elementary::cos(angle), across * elementary::sin(angle), z};
        // not parallel to `first`, and turned about it from one choice to the next
        const Axes about = axes_of(first, {-first.y, first.x, 0});
        const Vec3d beside =
            about[1] * elementary::cos(angle * i) + about[2] * elementary::sin(angle * i);
        const Axes axes = axes_of(first, beside);
        const double quality = cut_quality(on_unit_sphere(edges, centre, axes));
        if (quality > most) {
            most = quality;
            best = axes;
        }
    }
    return best;
}

const double kTan30 = std::sqrt(1.0 / 3);

// The patch about the x axis, in `axes`.
Surface patch(const Sphere& sphere, const Axes& axes)
{
    constexpr double kCos60 = 0.5;
    const std::array<Vec2d, 3> arc{
        {{kCos60, -std::sqrt(0.75)}, {1 / kCos60, 0}, {kCos60, std::sqrt(0.75)}}};
    const std::array<double, 3> weight{1, kCos60, 1};
    Surface s;
    s.degree_u = s.degree_v = 2;
    s.size_u = s.size_v = 3;
    s.knots_u = s.knots_v = {0, 0, 0, 1, 1, 1};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
            const Vec3d p{arc[j].x * arc[i].x, arc[j].x * arc[i].y, arc[j].y};
            s.points.push_back(sphere.centre +
                               (axes[0] * p.x + axes[1] * p.y + axes[2] * p.z) * sphere.radius);
            s.weights.push_back(weight[i] * weight[j]);
        }
    }
    return s;
}

// (u, v) on the patch about the x axis of `axes`, of a point of the unit sphere; |latitude| < 90 degrees.
PointAndTangent uv_of(const Axes& axes, const PointAndTangent& found)
{
    const Vec3d p = into(axes, found.point);
    const Vec3d d = into(axes, found.tangent);
    const double across = elementary::hypot(p.x, p.y);
    const double longitude = elementary::atan2(p.y, p.x);
    const double latitude = elementary::atan2(p.z, across);
    const double turn = (p.x * d.y - p.y * d.x) / (across * across);
    const double rise = d.z / across;
    const auto half_tan = [](double angle) {
        return elementary::tan(angle / 2) / kTan30;
    };
    const auto slope = [](double angle) {
        const double c = elementary::cos(angle / 2);
        return 0.25 / (kTan30 * c * c);
    };
    return {{0.5 + 0.5 * half_tan(longitude), 0.5 + 0.5 * half_tan(latitude), 0},
            {slope(longitude) * turn, slope(latitude) * rise, 0}};
}

}  // namespace

std::vector<Surface> sphere_patches(const Sphere& sphere,
                                    const std::vector<FaceEdge>& edges,
                                    double gap,
                                    const std::string& place)
{
    constexpr double kTrim = 1e-5;      // mm
    constexpr double kMostSlope = 2.4;  // radians by u or v: 4 tan(30 degrees) and some
    const auto off = [&sphere](Vec3d p) {
        return std::abs(norm(p - sphere.centre) - sphere.radius);
    };
    check_on_surface(edges, off, gap, place);
    const Axes axes = best_axes(edges, sphere.centre);
    const std::vector<FaceEdge> turned = on_unit_sphere(edges, sphere.centre, axes);
    std::vector<Surface> patches;
    for (const SphereOctant& octant : sphere_octants(turned, gap / sphere.radius, place)) {
        if (octant.loops.empty()) {
            continue;
        }
        const Axes local = axes_of(octant.signs, {0, 0, 1});
        Axes outside;
        for (std::size_t k = 0; k < 3; ++k) {
            outside[k] = axes[0] * local[k].x + axes[1] * local[k].y + axes[2] * local[k].z;
        }
        Surface s = patch(sphere, outside);
        const auto uv = [&local](const PointAndTangent& at) {
            return uv_of(local, at);
        };
        const std::vector<Curve> curves =
            fitted_trims(octant.loops, uv, kTrim / (kMostSlope * sphere.radius));
        if (curves.empty()) {
            continue;
        }
        s.trims = trim_loops(curves, s, place);
        patches.push_back(std::move(s));
    }
    return patches;
}

}  // namespace cusp::import
