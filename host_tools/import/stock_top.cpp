// Each floor is measured once, however many operations cut it.
#include "host_tools/import/stock_top.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "host_tools/job/loop_shape.hpp"

namespace cusp::import {

using job::Job;
using job::loop_polyline;
using job::Operation;

namespace {

bool is_pocket(const Operation& operation) { return operation.boundary.has_value(); }

double highest_of(const Operation& operation)
{
    return operation.mesh.empty() ? highest_of_surfaces(operation.floor)
                                  : extent_of_triangles(operation.mesh).high.z;
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
            measured.emplace(operation.floor_files, operation.intersect_files).second) {
            const double top = highest_of(operation);
            highest = std::max(highest.value_or(top), top);
        }
    }
    return highest;
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
                               return !operation.prismatic;
                           }).value_or(0.0);
    return std::max(0.0, std::ceil(highest * kSteps - kOverRounding) / kSteps);
}

PartExtent extent_of_job(const Job& job)
{
    constexpr double kChord = 1e-3;  // mm
    std::optional<PartExtent> box;
    for (const Operation& operation : job.operations) {
        PartExtent more = operation.mesh.empty() ? extent_of_surfaces(operation.floor)
                                                 : extent_of_triangles(operation.mesh);
        if (operation.boundary) {
            const auto outline = loop_polyline(*operation.boundary, kChord);
            const auto [west, east] = std::minmax_element(
                outline.begin(), outline.end(), [](Vec2d a, Vec2d b) { return a.x < b.x; });
            const auto [south, north] = std::minmax_element(
                outline.begin(), outline.end(), [](Vec2d a, Vec2d b) { return a.y < b.y; });
            more = {{west->x, south->y, more.low.z}, {east->x, north->y, more.high.z}};
        }
        box = box ? joined(*box, more) : more;
    }
    return box.value_or(PartExtent{});
}

}  // namespace cusp::import
