// Planes other than those of two axes are not recognised: they are projected, with a note.
#include "host_tools/job/import/dxf_plane.hpp"

#include <algorithm>
#include <cmath>

#include "fmt/format.h"

namespace cusp::import {

using nurbs::Curve;

namespace {

constexpr double kFlat = 1e-3;  // mm
constexpr double kPointLength = 1e-9;

bool is_point(const Curve& curve)
{
    const Vec3d first = curve.points.front();
    return std::all_of(curve.points.begin(), curve.points.end(),
                       [&](Vec3d p) { return norm(p - first) <= kPointLength; });
}

}  // namespace

Similarity object_axes(Vec3d normal)
{
    constexpr double kNearZ = 1.0 / 64;
    constexpr double kVertical = 1e-9;  // what rounding tilts is drawn vertical
    const double length = norm(normal);
    const Vec3d z = length > 0 ? 1 / length * normal : Vec3d{0, 0, 1};
    if (std::abs(z.x) < kVertical && std::abs(z.y) < kVertical) {
        const double side = z.z < 0 ? -1.0 : 1.0;
        return {{Vec3d{side, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, side}}, {}};
    }
    const bool near_z = std::abs(z.x) < kNearZ && std::abs(z.y) < kNearZ;
    const Vec3d across = cross(near_z ? Vec3d{0, 1, 0} : Vec3d{0, 0, 1}, z);
    const Vec3d x = 1 / norm(across) * across;
    return {{x, cross(z, x), z}, {}};
}

DrawingBox extent_of(const std::vector<DrawingPath>& paths)
{
    DrawingBox box{{kInfinite, kInfinite, kInfinite}, {-kInfinite, -kInfinite, -kInfinite}};
    for (const DrawingPath& path : paths) {
        for (const Curve& curve : path.curves) {
            for (const Vec3d p : curve.points) {
                for (unsigned axis = 0; axis < 3; ++axis) {
                    box.low[axis] = std::min(box.low[axis], p[axis]);
                    box.high[axis] = std::max(box.high[axis], p[axis]);
                }
            }
        }
    }
    return box;
}

DrawingSide view_of(const DrawingBox& extent)
{
    const Vec3d size = extent.high - extent.low;
    if (!(size.z > kFlat) || (size.x > kFlat && size.y > kFlat)) {
        return DrawingSide::kAbove;
    }
    return size.x > kFlat ? DrawingSide::kFront : DrawingSide::kSide;
}

Vec3d seen_from(DrawingSide view, Vec3d point)
{
    return view == DrawingSide::kAbove   ? Vec3d{point.x, point.y, 0}
           : view == DrawingSide::kFront ? Vec3d{point.x, point.z, 0}
                                         : Vec3d{point.y, point.z, 0};
}

void flatten(DrawingSide view, std::vector<DrawingPath>& paths)
{
    for (DrawingPath& path : paths) {
        std::vector<Curve> kept;
        for (Curve& curve : path.curves) {
            const bool was_point = is_point(curve);
            for (Vec3d& p : curve.points) {
                p = seen_from(view, p);
            }
            if (was_point || !is_point(curve)) {
                kept.push_back(std::move(curve));
            }
        }
        path.curves = std::move(kept);
    }
    paths.erase(std::remove_if(paths.begin(), paths.end(),
                               [](const DrawingPath& path) { return path.curves.empty(); }),
                paths.end());
}

std::string view_note(const std::string& file, DrawingSide view, const DrawingBox& extent)
{
    if (view == DrawingSide::kFront) {
        return fmt::format("{}: drawn in x and z: z is taken for y", file);
    }
    if (view == DrawingSide::kSide) {
        return fmt::format("{}: drawn in y and z: y is taken for x, z for y", file);
    }
    return extent.high.z - extent.low.z > kFlat
               ? fmt::format("{}: not flat: z goes from {:.6g} to {:.6g} mm; seen from above", file,
                             extent.low.z, extent.high.z)
               : "";
}

}  // namespace cusp::import
