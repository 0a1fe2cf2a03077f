// A level is cleared where a disc of the tool fits beside what stands above it.
#include "host_tools/job/import/cleared_ground.hpp"

#include <algorithm>

#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"
#include "host_tools/job/import/part_regions.hpp"

namespace cusp::import {

using offset::Region2d;

namespace {

constexpr double kSameGround = 1e-3;  // mm

}  // namespace

ClearedGround::ClearedGround(const Triangles& facets,
                             const std::vector<job::Hole>& holes,
                             const SolidGround& ground,
                             double radius)
    : top_{ground.box.high.z}
{
    const Region2d around = offset::grown(box_region(ground.box), 4 * radius);
    for (const SolidBand& band : ground.openings) {
        const Region2d stands =
            with_holes_filled(offset::shadow_above(facets, band.bottom), holes, band.bottom);
        const Region2d centres = offset::RegionOffset{offset::without(around, stands)}.at(radius);
        if (!centres.contours.empty()) {
            levels_.push_back({band.bottom, offset::grown(centres, radius), stands});
        }
    }
}

double ClearedGround::around(const job::Hole& hole, double top) const
{
    constexpr double kShareStanding = 0.02;  // of the hole's area: corners
    const Region2d disc = hole_disc(hole);
    for (auto level = levels_.rbegin(); level != levels_.rend(); ++level) {
        if (level->z >= top - kSameGround && offset::area(offset::without(disc, level->cleared)) <=
                                                 kShareStanding * offset::area(disc)) {
            return level->z;
        }
    }
    return top_;
}

bool ClearedGround::is_open(const Region2d& region, double top) const
{
    constexpr double kCorner = 0.05;  // mm^2
    if (top >= top_ - kSameGround) {
        return true;
    }
    const auto level = std::find_if(levels_.rbegin(), levels_.rend(),
                                    [&](const Level& one) { return one.z >= top - kSameGround; });
    return level != levels_.rend() &&
           offset::area(offset::without(offset::without(region, level->cleared), level->stands)) <=
               kCorner;
}

}  // namespace cusp::import
