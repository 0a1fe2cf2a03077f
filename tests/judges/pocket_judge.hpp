// Judges a pocket's tool path by brute force: no code of the planner is used.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "host_tools/cam/contour_pocket/contour_pocket.hpp"
#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/job/job/job.hpp"
#include "tests/generators/random_regions.hpp"

namespace cusp::test {

struct PocketVerdict {
    double floor_gouge{};  // mm, along the normal (ball)
    double wall_gouge{};   // mm
    double most_left{};    // mm over the floor, where the tool reaches, along the normal
    double uncut{};        // share of the places the tool reaches
    int points{};
};

// Points of the surfaces with their normals, a grid in the parameters.
struct SurfaceCloud {
    std::vector<Vec3d> points;
    std::vector<Vec3d> normals;
};

inline SurfaceCloud cloud_of(const std::vector<nurbs::Surface>& floor, int each)
{
    SurfaceCloud cloud;
    for (const nurbs::Surface& s : floor) {
        for (int i = 0; i <= each; ++i) {
            for (int j = 0; j <= each; ++j) {
                const double u = s.u_begin() + (s.u_end() - s.u_begin()) * i / each;
                const double v = s.v_begin() + (s.v_end() - s.v_begin()) * j / each;
                const nurbs::SurfacePoint p = derivatives_at(s, u, v);
                cloud.points.push_back(p.point);
                cloud.normals.push_back(upward_normal(p));
            }
        }
    }
    return cloud;
}

// Tips along the moves below `top`, at most `step` apart.
inline std::vector<Vec3d> tips_of(const toolpath::Toolpath& path, double top, double step)
{
    std::vector<Vec3d> tips;
    Vec3d at{};
    bool known = false;
    for (const toolpath::ToolMove& move : path.moves) {
        const Vec3d from = at;
        const auto* line = std::get_if<toolpath::LineTo>(&move.shape);
        const auto* arc = std::get_if<toolpath::ArcTo>(&move.shape);
        at = line != nullptr ? line->end : arc->end;
        if (!known) {
            known = true;
            continue;
        }
        const int n = 1 + static_cast<int>(norm(at - from) * (arc != nullptr ? 1.6 : 1.0) / step);
        for (int i = 1; i <= n; ++i) {
            const double share = static_cast<double>(i) / n;
            Vec3d p = from + (at - from) * share;
            if (arc != nullptr) {
                const Vec2d a{from.x - arc->centre.x, from.y - arc->centre.y};
                const Vec2d b{at.x - arc->centre.x, at.y - arc->centre.y};
                double turn = std::atan2(cross(a, b), dot(a, b));
                turn += arc->clockwise && turn > 0.0 ? -6.283185307179586 : 0.0;
                turn += !arc->clockwise && turn < 0.0 ? 6.283185307179586 : 0.0;
                const Vec2d q =
                    a * std::cos(turn * share) + offset::left_normal(a) * std::sin(turn * share);
                p = {arc->centre.x + q.x, arc->centre.y + q.y, p.z};
            }
            if (p.z < top) {
                tips.push_back(p);
            }
        }
    }
    return tips;
}

// z of the lowest cut over a place.
inline double lowest_cut(const toolpath::Tool& tool, const std::vector<Vec3d>& tips, Vec2d p)
{
    double least = 1e300;
    for (const Vec3d tip : tips) {
        const double x = tip.x - p.x;
        const double y = tip.y - p.y;
        const double square = x * x + y * y;
        if (square < tool.radius * tool.radius) {
            least = std::min(least, tip.z + profile_height(tool, std::sqrt(square)));
        }
    }
    return least;
}

// A pocket under a stock to z = 1, its tool's corner and its scallop (0.05 to `scallop` mm) drawn.
inline job::Operation random_pocket(Random& random,
                                    std::vector<nurbs::Surface> floor,
                                    job::Loop boundary,
                                    const toolpath::Tool& tool,
                                    double scallop)
{
    job::Operation operation;
    operation.strategy = &cusp::contour_pocket::kContourPocket;
    operation.part.floor = std::move(floor);
    operation.part.floor_files = {"floor"};
    operation.outline.boundary = std::move(boundary);
    operation.outline.boundary_file = "boundary";
    operation.tool = tool;
    operation.tool.corner_radius = tool.shape == toolpath::ToolShape::kFlat ? 0.0
                                   : tool.shape == toolpath::ToolShape::kBall
                                       ? tool.radius
                                       : uniform(random, 0.2, 0.7) * tool.radius;
    operation.tolerance.plan = operation.tolerance.floor = 0.02;
    operation.tolerance.scallop = uniform(random, 0.05, scallop);
    return operation;
}

inline toolpath::PlannedOperation planned_pocket(const job::Operation& operation)
{
    job::Job job;
    job.file = "job";
    job.stock_top = 1.0;
    job.clearance = 5.0;
    return contour_pocket::plan_contour_pocket(job, operation).back();
}

// For a ball. If a surface point is farther than the tool's radius from the walls it counts as
// reached (choose floors that are nowhere bent tighter than the ball).
inline PocketVerdict judge_pocket(const std::vector<nurbs::Surface>& floor,
                                  const offset::Region2d& region,
                                  const toolpath::Toolpath& path,
                                  double top,
                                  int each)
{
    const double r = path.tool.radius;
    const SurfaceCloud cloud = cloud_of(floor, each);
    const std::vector<Vec3d> tips = tips_of(path, top, 0.12);
    // Tips sorted into square cells of side r.
    double x0 = 1e300;
    double y0 = 1e300;
    double x1 = -1e300;
    double y1 = -1e300;
    for (const Vec3d p : cloud.points) {
        x0 = std::min(x0, p.x);
        y0 = std::min(y0, p.y);
        x1 = std::max(x1, p.x);
        y1 = std::max(y1, p.y);
    }
    const auto columns = static_cast<std::size_t>((x1 - x0) / r) + 3;
    const auto rows = static_cast<std::size_t>((y1 - y0) / r) + 3;
    std::vector<std::vector<Vec3d>> cells(columns * rows);
    const auto cell = [&](double x, double y) {
        const double i = std::clamp((x - x0) / r + 1.0, 0.0, static_cast<double>(columns - 1));
        const double j = std::clamp((y - y0) / r + 1.0, 0.0, static_cast<double>(rows - 1));
        return std::array<std::size_t, 2>{static_cast<std::size_t>(i), static_cast<std::size_t>(j)};
    };
    PocketVerdict verdict;
    for (const Vec3d p : tips) {
        const auto [i, j] = cell(p.x, p.y);
        cells[i * rows + j].push_back(p + Vec3d{0.0, 0.0, r});
        const double apart = distance_to(region, {p.x, p.y});
        const bool inside = contains(region, {p.x, p.y});
        verdict.wall_gouge = std::max(verdict.wall_gouge, r - (inside ? apart : -apart));
    }
    int uncut = 0;
    for (std::size_t k = 0; k < cloud.points.size(); ++k) {
        const Vec3d p = cloud.points[k];
        const Vec3d n = cloud.normals[k];
        const auto [i, j] = cell(p.x, p.y);
        double nearest = 1e300;
        double left = 1e300;
        for (std::size_t a = i > 0 ? i - 1 : 0; a <= std::min(i + 1, columns - 1); ++a) {
            for (std::size_t b = j > 0 ? j - 1 : 0; b <= std::min(j + 1, rows - 1); ++b) {
                for (const Vec3d c : cells[a * rows + b]) {
                    const Vec3d arm = c - p;
                    const double along = dot(arm, n);
                    const double square = dot(arm, arm);
                    nearest = std::min(nearest, square);
                    const double under = r * r - (square - along * along);
                    if (under > 0.0) {
                        left = std::min(left, along - std::sqrt(under));
                    }
                }
            }
        }
        verdict.floor_gouge = std::max(verdict.floor_gouge, r - std::sqrt(nearest));
        const Vec2d plan{p.x, p.y};
        if (contains(region, plan) && distance_to(region, plan) > r + 0.05 + r * (1.0 - n.z)) {
            ++verdict.points;
            uncut += left > 1e299 ? 1 : 0;
            verdict.most_left = std::max(verdict.most_left, left > 1e299 ? 0.0 : left);
        }
    }
    verdict.uncut = verdict.points > 0 ? static_cast<double>(uncut) / verdict.points : 1.0;
    return verdict;
}

}  // namespace cusp::test
