// Counts the trimmed patches that hold a point of their surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/job/loop_shape.hpp"

namespace cusp::test {

class PatchCover {
public:
    PatchCover() = default;
    explicit PatchCover(std::vector<nurbs::Surface> surfaces)
    {
        constexpr double kChord = 1e-6;  // of (u, v)
        for (nurbs::Surface& surface : surfaces) {
            patches_.push_back({std::move(surface), {}});
            for (const auto& loop : patches_.back().surface.trims) {
                patches_.back().loops.push_back(job::loop_polyline(loop, kChord));
            }
        }
    }

    std::ptrdiff_t patches_at(Vec3d point) const
    {
        return std::count_if(patches_.begin(), patches_.end(),
                             [&](const Patch& patch) { return holds(patch, point); });
    }

private:
    struct Patch {
        nurbs::Surface surface;
        std::vector<std::vector<Vec2d>> loops;
    };

    // By Newton's method from the nearest of some places; outside [0, 1] where the patch has not the point.
    static Vec2d uv_on(const nurbs::Surface& s, Vec3d p)
    {
        constexpr int kStarts = 4;
        Vec2d uv{0.5, 0.5};
        for (int k = 0; k < kStarts * kStarts; ++k) {
            const Vec2d at{(k % kStarts + 0.5) / kStarts, (k / kStarts + 0.5) / kStarts};
            if (norm(point_at(s, at.x, at.y) - p) < norm(point_at(s, uv.x, uv.y) - p)) {
                uv = at;
            }
        }
        for (int i = 0; i < 50; ++i) {
            const nurbs::SurfacePoint at = derivatives_at(s, uv.x, uv.y);
            const Vec3d apart = p - at.point;
            const double step_u = dot(apart, at.du) / dot(at.du, at.du);
            const double step_v = dot(apart, at.dv) / dot(at.dv, at.dv);
            uv = {std::clamp(uv.x + step_u, 0.0, 1.0), std::clamp(uv.y + step_v, 0.0, 1.0)};
        }
        return norm(point_at(s, uv.x, uv.y) - p) < 1e-6 * norm(p - point_at(s, 0.5, 0.5)) + 1e-9
                   ? uv
                   : Vec2d{-1, -1};
    }

    static bool holds(const Patch& patch, Vec3d p)
    {
        const Vec2d uv = uv_on(patch.surface, p);
        if (uv.x < 0) {
            return false;
        }
        bool inside = false;
        for (const std::vector<Vec2d>& loop : patch.loops) {
            inside = inside != job::encloses(loop, uv);
        }
        return inside;
    }

    std::vector<Patch> patches_;
};

}  // namespace cusp::test
