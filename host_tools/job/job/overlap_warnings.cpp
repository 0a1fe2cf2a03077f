// Outlines as polylines; those whose boxes lie apart are not compared.
#include "host_tools/job/job/overlap_warnings.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/job/job/hole_depth.hpp"
#include "host_tools/job/job/loop_shape.hpp"

#include "fmt/format.h"

namespace cusp::job {

namespace {

constexpr double kChord = 1e-3;        // mm
constexpr double kSameOutline = 0.01;  // mm, between the boxes of two drawings of one outline

struct Outline {
    const Operation* operation;
    std::vector<Vec2d> closed;
    Vec2d low{kUnbounded, kUnbounded};
    Vec2d high{-kUnbounded, -kUnbounded};
};

Outline outline_of(const Operation& operation, std::vector<Vec2d> closed)
{
    Outline out{&operation, std::move(closed)};
    for (const Vec2d p : out.closed) {
        out.low = {std::min(out.low.x, p.x), std::min(out.low.y, p.y)};
        out.high = {std::max(out.high.x, p.x), std::max(out.high.y, p.y)};
    }
    return out;
}

std::vector<Vec2d> circle(Vec2d centre, double radius)
{
    constexpr int kCorners = 64;
    const double turn = 2 * elementary::acos(-1.0);
    std::vector<Vec2d> closed;
    for (int i = 0; i <= kCorners; ++i) {
        const double angle =
            0.02 + turn * (i % kCorners) / kCorners;  // no corner on a line of the grid
        closed.push_back(centre + radius * Vec2d{elementary::cos(angle), elementary::sin(angle)});
    }
    return closed;
}

std::vector<Outline> outlines_of(const Job& job)
{
    std::vector<Outline> out;
    for (const Operation& operation : job.operations) {
        if (!operation.prismatic) {
            continue;
        }
        if (operation.outline.boundary) {
            out.push_back(
                outline_of(operation, loop_polyline(*operation.outline.boundary, kChord)));
        } else if (operation.cuts(Region::kOutline) || operation.cuts(Region::kValleys)) {
            for (const NestedLoop& loop : operation.prismatic->loops) {
                out.push_back(outline_of(operation, loop_polyline(loop.loop, kChord)));
            }
        } else if (operation.cuts(Region::kHoles)) {
            for (const Hole& hole : operation.prismatic->holes) {
                out.push_back(outline_of(
                    operation,
                    circle(hole.at, radius_of_hole(*operation.prismatic, hole, operation.tool))));
            }
        }
    }
    return out;
}

bool are_apart(const Outline& a, const Outline& b)
{
    return a.high.x < b.low.x || b.high.x < a.low.x || a.high.y < b.low.y || b.high.y < a.low.y;
}

bool are_same(const Outline& a, const Outline& b)
{
    return norm(a.low - b.low) < kSameOutline && norm(a.high - b.high) < kSameOutline;
}

}  // namespace

std::vector<std::string> overlap_warnings(const Job& job)
{
    const std::vector<Outline> outlines = outlines_of(job);
    std::set<std::pair<int, int>> warned;
    std::vector<std::string> warnings;
    for (std::size_t a = 0; a < outlines.size(); ++a) {
        for (std::size_t b = a + 1; b < outlines.size(); ++b) {
            const Operation& one = *outlines[a].operation;
            const Operation& other = *outlines[b].operation;
            if (one.number == other.number || warned.count({one.number, other.number}) > 0 ||
                are_apart(outlines[a], outlines[b]) || are_same(outlines[a], outlines[b])) {
                continue;
            }
            if (const auto at = crossing_of({outlines[a].closed, outlines[b].closed})) {
                warned.insert({one.number, other.number});
                warnings.push_back(fmt::format(
                    "operations {} ({}) and {} ({}) overlap: their outlines cross at x {:.3f} y "
                    "{:.3f} mm; "
                    "the deeper cut counts there",
                    one.number, one.name(), other.number, other.name(), at->x, at->y));
            }
        }
    }
    return warnings;
}

}  // namespace cusp::job
