// Loops are polylines within the plan tolerance, in trees.
#include "host_tools/cam/finishing/finish_area.hpp"

#include <algorithm>

#include "host_tools/job/job/loop_shape.hpp"

namespace cusp::finishing {

using job::Operation;
using offset::EdgeTree;
using offset::line_edge;

namespace {

std::shared_ptr<const EdgeTree> tree_of(const job::Loop& loop, double chord)
{
    const std::vector<Vec2d> corners = job::loop_polyline(loop, chord);
    std::vector<offset::Edge> edges;
    for (std::size_t k = 1; k < corners.size(); ++k) {
        edges.push_back(line_edge(corners[k - 1], corners[k]));
    }
    return std::make_shared<const EdgeTree>(std::move(edges));
}

}  // namespace

FinishArea::FinishArea(const Operation& operation, double margin)
    : range_{ground_range_of(operation)}, margin_{margin}
{
    range_.low -= margin;
    range_.high += margin;
    const double chord = operation.tolerance.plan;
    if (operation.outline.boundary) {
        loops_.push_back({tree_of(*operation.outline.boundary, chord), true});
    }
    for (const job::Loop& island : operation.outline.islands) {
        loops_.push_back({tree_of(island, chord), false});
    }
}

bool FinishArea::holds(Vec3d place, Vec3d normal) const
{
    const Vec2d at{place.x, place.y};
    return range_.holds(place.z, normal.z) &&
           std::all_of(loops_.begin(), loops_.end(), [&](const Loop& loop) {
               return loop.edges->surrounds(at) == loop.outer ||
                      loop.edges->any_nearer(at, margin_);
           });
}

bool FinishArea::is_beyond(Vec3d middle, double reach, Vec3d normal, double turn) const
{
    if (normal.z + turn < range_.least_normal_z() || normal.z - turn > range_.most_normal_z() ||
        middle.z + reach < range_.low || middle.z - reach > range_.high) {
        return true;
    }
    const Vec2d at{middle.x, middle.y};
    return std::any_of(loops_.begin(), loops_.end(), [&](const Loop& loop) {
        return loop.edges->surrounds(at) != loop.outer &&
               !loop.edges->any_nearer(at, reach + margin_);
    });
}

}  // namespace cusp::finishing
