// Stock under the rapid moves of a flat end: heights by brute force on a fine raster under each place.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

namespace cusp::test {

class StockUnderRapids {
public:
    // The stock fills the box up to `top` (z).
    StockUnderRapids(const offset::Box2d& box, double top) : box_{box}, top_{top} {}

    // Cuts the path. Returns how deep a rapid move was in stock, mm. Stock within 0.01 mm of the tool's
    // circumference does not count, nor what cuts miss by 0.002 mm.
    double cut(const toolpath::Toolpath& path)
    {
        constexpr double kChord = 1e-4;  // mm
        double deepest = 0.0;
        bool started = false;
        Vec3d at{};
        for (const toolpath::ToolMove& move : path.moves) {
            for (const Vec3d to : toolpath::points_of(move, at, kChord)) {
                if (started && move.kind == toolpath::MoveKind::kRapid) {
                    deepest = std::max(deepest, depth_along(path.tool.radius, at, to));
                }
                if (started && std::min(at.z, to.z) < top_) {
                    swept_.push_back({at, to, path.tool.radius});
                }
                at = to;
                started = true;
            }
        }
        return deepest;
    }

private:
    struct Sweep {
        Vec3d from;
        Vec3d to;
        double radius;
    };

    double depth_along(double radius, Vec3d from, Vec3d to) const
    {
        const double way = norm(in_plan(to - from));
        const int n = 1 + static_cast<int>(way / (2.0 * radius));
        double deepest = 0.0;
        for (int i = 1; i <= n; ++i) {
            const Vec3d tip = from + (to - from) * (static_cast<double>(i) / n);
            deepest = tip.z < top_ ? std::max(deepest, depth_at(radius, tip)) : deepest;
        }
        return deepest;
    }

    double depth_at(double radius, Vec3d tip) const
    {
        constexpr double kMargin = 0.01;
        const int n = 50;
        const double pitch = (radius - kMargin) / n;
        std::vector<double> heights;
        for (int j = -n; j <= n; ++j) {
            for (int i = -n; i <= n; ++i) {
                const Vec2d p = in_plan(tip) + Vec2d{i * pitch, j * pitch};
                const bool in_stock =
                    p.x > box_.x0 && p.x < box_.x1 && p.y > box_.y0 && p.y < box_.y1;
                heights.push_back(in_stock ? top_ : -kUnbounded);
            }
        }
        for (const Sweep& sweep : swept_) {
            if (distance_of(sweep, in_plan(tip)) < radius + sweep.radius) {
                lower(sweep, tip, pitch, n, heights);
            }
        }
        double highest = tip.z;
        std::size_t k = 0;
        for (int j = -n; j <= n; ++j) {
            for (int i = -n; i <= n; ++i, ++k) {
                highest = i * i + j * j <= n * n ? std::max(highest, heights[k]) : highest;
            }
        }
        return highest - tip.z;
    }

    static double distance_of(const Sweep& sweep, Vec2d p)
    {
        const Vec2d a = in_plan(sweep.from);
        const Vec2d way = in_plan(sweep.to) - a;
        const double square = dot(way, way);
        const double share = square > 0.0 ? std::clamp(dot(p - a, way) / square, 0.0, 1.0) : 0.0;
        return norm(p - a - way * share);
    }

    static void lower(
        const Sweep& sweep, Vec3d tip, double pitch, int n, std::vector<double>& heights)
    {
        constexpr double kMissed = 0.002;
        const double z = std::max(sweep.from.z, sweep.to.z);
        std::size_t k = 0;
        for (int j = -n; j <= n; ++j) {
            for (int i = -n; i <= n; ++i, ++k) {
                const Vec2d p = in_plan(tip) + Vec2d{i * pitch, j * pitch};
                if (heights[k] > z && distance_of(sweep, p) <= sweep.radius + kMissed) {
                    heights[k] = z;
                }
            }
        }
    }

    offset::Box2d box_;
    double top_;
    std::vector<Sweep> swept_;
};

}  // namespace cusp::test
