// An area without limits owes everything, whatever others are for.
#include "host_tools/judge/verify/owed_ground.hpp"

#include <algorithm>

namespace cusp::verify {

using job::Job;
using job::Operation;

namespace {

constexpr double kCap = 1;  // mm: only the sign of distances counts

bool is_limited(const Operation& operation)
{
    return finishes_ground(operation) &&
           (operation.outline.boundary || !operation.outline.islands.empty() ||
            !ground_range_of(operation).is_everything());
}

}  // namespace

OwedGround::OwedGround(const Job& job)
{
    std::vector<const Operation*> owing;
    for (const bool with_scallop : {true, false}) {
        for (const Operation& operation : job.operations) {
            if (operation.cuts(job::Region::kSurfaces) &&
                (operation.tolerance.scallop || !with_scallop)) {
                owing.push_back(&operation);
            }
        }
        if (!owing.empty()) {
            break;
        }
    }
    if (!std::all_of(owing.begin(), owing.end(),
                     [](const Operation* operation) { return is_limited(*operation); })) {
        return;
    }
    for (const Operation* const operation : owing) {
        Area area{{}, ground_range_of(*operation)};
        if (operation->outline.boundary) {
            area.walls.emplace_back(*operation->outline.boundary, true, kCap);
        }
        for (const job::Loop& island : operation->outline.islands) {
            area.walls.emplace_back(island, false, kCap);
        }
        areas_.push_back(std::move(area));
    }
}

bool OwedGround::holds(Vec3d place, double normal_z) const
{
    return areas_.empty() || std::any_of(areas_.begin(), areas_.end(), [&](const Area& area) {
               return area.range.holds(place.z, normal_z) &&
                      std::all_of(
                          area.walls.begin(), area.walls.end(),
                          [&](const WallDistance& wall) { return wall.at(place.x, place.y) >= 0; });
           });
}

}  // namespace cusp::verify
