// Fits planes in their own frame, so that steep planes are as accurate as horizontal ones.
#include "host_tools/job/import/mesh_patches.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host_tools/job/import/facet_groups.hpp"
#include "host_tools/job/import/height_field.hpp"
#include "host_tools/job/job/loop_shape.hpp"

namespace cusp::import {

using job::Loop;
using job::loop_polyline;
using job::signed_area;
using nurbs::Curve;
using nurbs::Surface;

namespace {

constexpr double kPlane = 1e-3;  // mm: flatness of a plane; also at most a tenth of the tolerance
constexpr double kSteep = 0.7;   // z of a unit normal: steeper planes are not parametrised in x, y

struct Frame {
    Vec3d origin;
    Vec3d u, v, normal;

    Vec2d in(Vec3d p) const { return {dot(p - origin, u), dot(p - origin, v)}; }
    Vec3d out(double a, double b) const { return origin + u * a + v * b; }
};

Frame frame_of(const FacetGroup& group)
{
    Vec3d sum{};
    for (const auto& t : group.facets.triangles) {
        sum = sum + cross(t[1] - t[0], t[2] - t[0]);
    }
    Frame frame{group.facets.triangles.front()[0], {1, 0, 0}, {0, 1, 0}, sum / norm(sum)};
    if (frame.normal.z < kSteep) {
        const Vec3d level = cross(Vec3d{0, 0, 1}, frame.normal);
        frame.u = level / norm(level);
        frame.v = cross(frame.normal, frame.u);
    } else {
        // In plan u and v run along x and y, so that (u, v) equals (x, y).
        frame.u = {1, 0, -frame.normal.x / frame.normal.z};
        frame.v = {0, 1, -frame.normal.y / frame.normal.z};
    }
    return frame;
}

// Least and greatest signed distance of corners from the plane.
std::pair<double, double> off_plane(const FacetGroup& group, const Frame& frame)
{
    double low = kInfinite;
    double high = -low;
    for (const auto& t : group.facets.triangles) {
        for (const Vec3d& p : t) {
            const double over = dot(p - frame.origin, frame.normal);
            low = std::min(low, over);
            high = std::max(high, over);
        }
    }
    return {low, high};
}

// Sets the loops as trims, unless they are the boundary of the domain.
void trim(Surface& surface, const std::vector<std::vector<Vec2d>>& loops)
{
    constexpr double kWhole = 1e-9;
    const double u0 = surface.u_begin();
    const double u1 = surface.u_end();
    const double v0 = surface.v_begin();
    const double v1 = surface.v_end();
    double area = 0;
    for (const std::vector<Vec2d>& loop : loops) {
        area += signed_area(loop);
        Curve curve;
        curve.degree = 1;
        curve.knots.push_back(0);
        for (const Vec2d& p : loop) {
            curve.knots.push_back(static_cast<double>(curve.points.size()));
            curve.points.push_back({std::clamp(p.x, u0, u1), std::clamp(p.y, v0, v1), 0});
        }
        curve.knots.push_back(curve.knots.back());
        curve.weights.assign(curve.points.size(), 1.0);
        surface.trims.push_back({std::move(curve)});
    }
    std::stable_partition(surface.trims.begin(), surface.trims.end(), [](const Loop& loop) {
        return signed_area(loop_polyline(loop, 1.0)) > 0;
    });
    if (loops.size() == 1 && area > (1 - kWhole) * (u1 - u0) * (v1 - v0)) {
        surface.trims.clear();
    }
}

Surface plane_patch(const FacetGroup& group, Frame frame, double lift)
{
    frame.origin = frame.origin + frame.normal * lift;
    std::vector<std::vector<Vec2d>> loops;
    Vec2d low{kUnbounded, kUnbounded};
    Vec2d high{-kUnbounded, -kUnbounded};
    const bool level = frame.normal.z >= kSteep;
    for (const auto& loop : group.loops) {
        loops.emplace_back();
        for (const Vec3d& p : loop) {
            const Vec2d at =
                level ? Vec2d{p.x - frame.origin.x, p.y - frame.origin.y} : frame.in(p);
            loops.back().push_back(at);
            low = {std::min(low.x, at.x), std::min(low.y, at.y)};
            high = {std::max(high.x, at.x), std::max(high.y, at.y)};
        }
    }
    Surface s;
    s.degree_u = s.degree_v = 1;
    s.size_u = s.size_v = 2;
    s.knots_u = {low.x, low.x, high.x, high.x};
    s.knots_v = {low.y, low.y, high.y, high.y};
    for (const double u : {low.x, high.x}) {
        for (const double v : {low.y, high.y}) {
            s.points.push_back(frame.out(u, v));
        }
    }
    s.weights.assign(4, 1.0);
    trim(s, loops);
    return s;
}

Surface curved_patch(const FacetGroup& group, HeightField& field)
{
    Surface s = std::move(field.surface);
    // u and v run along x and y from the corner of the facets' box.
    const Vec3d corner = s.points.front();
    std::vector<std::vector<Vec2d>> loops;
    for (const auto& loop : group.loops) {
        loops.emplace_back();
        for (const Vec3d& p : loop) {
            loops.back().push_back({s.u_begin() + p.x - corner.x, s.v_begin() + p.y - corner.y});
        }
    }
    trim(s, loops);
    return s;
}

}  // namespace

std::optional<MeshPatches> mesh_patches(const Facets& facets, double tolerance)
{
    const auto groups = facet_groups(facets);
    if (!groups) {
        return std::nullopt;
    }
    MeshPatches out;
    out.overhang_area = overhang_area(facets);
    double cells = 0;
    double loose = 0;
    for (const FacetGroup& group : *groups) {
        const Frame frame = frame_of(group);
        const auto [low, high] = off_plane(group, frame);
        if (high - low <= std::min(kPlane, 0.1 * tolerance)) {
            out.surfaces.push_back(plane_patch(group, frame, high));
            continue;
        }
        HeightField field = height_patch(group.facets, tolerance);
        const double count = static_cast<double>(field.surface.points.size());
        cells += count;
        loose += count * field.loose_share;
        out.lift = std::max(out.lift, field.lift);
        out.cell = std::max(out.cell, field.cell);
        out.surfaces.push_back(curved_patch(group, field));
    }
    out.loose_share = cells > 0 ? loose / cells : 0;
    return out;
}

}  // namespace cusp::import
