// Passes along v are passes along u of transposed surfaces: all other code assumes u.
#include "host_tools/cam/adaptive_isocurve/isocurve_floor.hpp"

#include <algorithm>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/geometry/toolpath/stepover.hpp"

#include "fmt/format.h"

namespace cusp::adaptive_isocurve {

using job::Job;
using job::Operation;
using nurbs::crease_knots;
using nurbs::Curve;
using nurbs::Surface;
using nurbs::SurfacePoint;
using toolpath::stepover;

namespace {

constexpr int kFloorSamples = 60;
constexpr double kMostPasses = 20000;

// Exchanges u and v of the trims and reverses them, so that the inside stays to their left.
void swap_loops(Surface& surface)
{
    for (std::vector<Curve>& loop : surface.trims) {
        std::reverse(loop.begin(), loop.end());
        for (Curve& curve : loop) {
            curve = reversed(curve);
            for (Vec3d& p : curve.points) {
                std::swap(p.x, p.y);
            }
        }
    }
}

// The surface with u and v exchanged.
Surface transposed(const Surface& s)
{
    Surface out = s;
    out.degree_u = s.degree_v;
    out.degree_v = s.degree_u;
    out.knots_u = s.knots_v;
    out.knots_v = s.knots_u;
    out.size_u = s.size_v;
    out.size_v = s.size_u;
    std::size_t k = 0;
    for (int j = 0; j < s.size_v; ++j) {
        for (int i = 0; i < s.size_u; ++i, ++k) {
            const std::size_t from = static_cast<std::size_t>(i * s.size_v + j);
            out.points[k] = s.points[from];
            out.weights[k] = s.weights[from];
        }
    }
    swap_loops(out);
    return out;
}

// The longest side of the box of all control points, or of a mesh, mm.
double size_of(const Operation& operation)
{
    Vec3d low{kInfinite, kInfinite, kInfinite};
    Vec3d high = -low;
    const auto take = [&](const Vec3d& p) {
        for (unsigned k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], p[k]);
            high[k] = std::max(high[k], p[k]);
        }
    };
    for (const Surface& surface : operation.part.floor) {
        std::for_each(surface.points.begin(), surface.points.end(), take);
    }
    for (const auto& triangle : operation.part.mesh) {
        std::for_each(triangle.begin(), triangle.end(), take);
    }
    return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

}  // namespace

std::vector<Surface> surfaces_along_u(const Operation& operation)
{
    if (finish_keys(operation).direction == 'u') {
        return operation.part.floor;
    }
    std::vector<Surface> out;
    for (const Surface& surface : operation.part.floor) {
        out.push_back(transposed(surface));
    }
    return out;
}

void check_spacing(const Job& job, const Operation& operation)
{
    if (!finish_keys(operation).iso_distance && !operation.tolerance.scallop) {
        throw InputError(
            fmt::format("{}: {}: give iso_distance or scallop", job.file, operation.name()));
    }
    const double size = size_of(operation);
    if (finish_keys(operation).iso_distance &&
        size > kMostPasses * *finish_keys(operation).iso_distance) {
        throw InputError(fmt::format(
            "{}: iso_distance is {:g} mm, over a part of {:g} mm it must be at least {:g} mm ({:g} "
            "passes)",
            job.file, *finish_keys(operation).iso_distance, size, size / kMostPasses, kMostPasses));
    }
    if (finish_keys(operation).iso_distance &&
        *finish_keys(operation).iso_distance >= 2 * operation.tool.radius) {
        throw InputError(fmt::format(
            "{}: iso_distance is {:g} mm, passes of a ball of radius {:g} mm must be nearer than "
            "{:g} mm",
            job.file, *finish_keys(operation).iso_distance, operation.tool.radius,
            2 * operation.tool.radius));
    }
    if (operation.tolerance.scallop && *operation.tolerance.scallop >= operation.tool.radius) {
        throw InputError(
            fmt::format("{}: scallop is {:g} mm, not below the tool's radius of {:g} mm", job.file,
                        *operation.tolerance.scallop, operation.tool.radius));
    }
    if (operation.tolerance.scallop && !finish_keys(operation).iso_distance) {
        const double apart = stepover(operation.tool.radius, *operation.tolerance.scallop, 0);
        if (size > kMostPasses * apart) {
            throw InputError(fmt::format(
                "{}: scallop is {:g} mm, that is passes {:.3g} mm apart on level ground; over a "
                "part of {:g} mm these would be {:.0f}, at most {:g} are made",
                job.file, *operation.tolerance.scallop, apart, size, size / apart, kMostPasses));
        }
    }
}

bool is_plain(const Surface& s)
{
    if (!s.trims.empty()) {
        return false;
    }
    const auto creased = [](const std::vector<double>& knots, int degree, int count) {
        return crease_knots(knots, degree, static_cast<std::size_t>(count)).size() > 2;
    };
    if (creased(s.knots_u, s.degree_u, s.size_u) || creased(s.knots_v, s.degree_v, s.size_v)) {
        return false;
    }
    double least = kInfinite;
    double most = 0;
    for (int i = 0; i <= kFloorSamples; ++i) {
        for (int j = 0; j <= kFloorSamples; ++j) {
            const SurfacePoint p =
                derivatives_at(s, s.u_begin() + (s.u_end() - s.u_begin()) * i / kFloorSamples,
                               s.v_begin() + (s.v_end() - s.v_begin()) * j / kFloorSamples);
            const double area = norm(cross(p.du, p.dv));
            least = std::min(least, area);
            most = std::max(most, area);
        }
    }
    return least > 0.02 * most;
}

}  // namespace cusp::adaptive_isocurve
