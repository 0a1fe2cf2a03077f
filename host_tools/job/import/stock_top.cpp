// Each floor is measured once, however many operations cut it.
#include "host_tools/job/import/stock_top.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "host_tools/job/job/finish_keys.hpp"

namespace cusp::import {

using job::Job;
using job::Operation;

namespace {

bool is_pocket(const Operation& operation)
{
    return operation.outline.boundary && !finishes_ground(operation);
}

// An engraving may be the only operation on its floor.
bool is_on_floor(const Operation& operation)
{
    return operation.cuts(job::Region::kGrooves) && !operation.part.floor.empty();
}

double highest_of(const Operation& operation)
{
    return operation.part.mesh.empty() ? highest_of_surfaces(operation.part.floor)
                                       : extent_of_triangles(operation.part.mesh).high.z;
}

// z of the highest point of the floors for which counts(operation); no value: there are none.
template <class Counts>
std::optional<double> highest_floor(const Job& job, const Counts& counts)
{
    using Files = std::vector<std::string>;
    std::set<std::pair<Files, Files>> measured;
    std::optional<double> highest;
    for (const Operation& operation : job.operations) {
        if (counts(operation) &&
            measured.emplace(operation.part.floor_files, operation.part.intersect_files).second) {
            const double top = highest_of(operation);
            highest = std::max(highest.value_or(top), top);
        }
    }
    return highest;
}

void widen(const std::optional<PartExtent>& by, std::optional<PartExtent>& box)
{
    if (by) {
        box = box ? joined(*box, *by) : *by;
    }
}

// A floor that follows from the depth of an operation is none of the part.
std::optional<PartExtent> floor_extent(const Operation& operation)
{
    if (operation.prismatic) {
        return std::nullopt;
    }
    return operation.part.mesh.empty() ? extent_of_surfaces(operation.part.floor)
                                       : extent_of_triangles(operation.part.mesh);
}

// In x and y, of what the operation is drawn by.
std::optional<PartExtent> drawing_extent(const Operation& operation)
{
    std::optional<PartExtent> box;
    if (operation.outline.boundary) {
        box = extent_of_curves(*operation.outline.boundary);
    }
    if (!operation.prismatic) {
        return box;
    }
    for (const job::NestedLoop& loop : operation.prismatic->loops) {
        widen(extent_of_curves(loop.loop), box);
    }
    for (const job::Chain& chain : operation.prismatic->chains) {
        widen(extent_of_curves(chain), box);
    }
    for (const job::Hole& hole : operation.prismatic->holes) {
        const Vec3d at{hole.at.x, hole.at.y, 0};
        widen(PartExtent{at, at}, box);
    }
    return box;
}

}  // namespace

std::optional<double> part_top(const Job& job)
{
    return highest_floor(job, [](const Operation& operation) {
        return !is_pocket(operation) && !operation.prismatic;
    });
}

double default_stock_top(const Job& job)
{
    constexpr double kSteps = 1e4;         // per mm
    constexpr double kOverRounding = 0.5;  // of a step: excess of the measured height, ignored
    const double highest = highest_floor(job, [](const Operation& operation) {
                               return !operation.prismatic || is_on_floor(operation);
                           }).value_or(0.0);
    return std::max(0.0, std::ceil(highest * kSteps - kOverRounding) / kSteps);
}

std::optional<PartExtent> floors_extent(const Job& job)
{
    std::optional<PartExtent> box;
    for (const Operation& operation : job.operations) {
        widen(floor_extent(operation), box);
    }
    return box;
}

std::optional<PartExtent> plan_extent(const Job& job)
{
    std::optional<PartExtent> box;
    for (const Operation& operation : job.operations) {
        const std::optional<PartExtent> drawn = drawing_extent(operation);
        widen(drawn ? drawn : floor_extent(operation), box);
    }
    return box;
}

}  // namespace cusp::import
