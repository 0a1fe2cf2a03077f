// Most positions lie in one region by their centre's distance; for the others their edge is sampled.
#include "host_tools/judge/verify/wall_gouge.hpp"

#include <algorithm>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/toolpath/tool_tip.hpp"
#include "host_tools/judge/verify/bands.hpp"

namespace cusp::verify {

using job::Operation;
using toolpath::end_height;
using toolpath::radius_at_height;
using toolpath::Tool;

namespace {

// The tool's axis follows curves or stands in drilled holes.
bool is_on_curves(const Operation& operation)
{
    return operation.cuts(job::Region::kGrooves) ||
           (operation.cuts(job::Region::kHoles) && operation.prismatic->loops.empty()) ||
           (operation.cuts(job::Region::kOutline) &&
            operation.prismatic->side == job::ProfileSide::kOn);
}

class GougeSearch {
public:
    // own  of each region: the positions that its operation may have cut; none: all
    GougeSearch(const std::vector<CutRegion>& regions,
                const std::vector<std::vector<char>>& own,
                const WallLimits& limits)
        : regions_{regions}, own_{own}, limits_{limits}
    {
    }

    void look_at(const ToolPositions& run, std::size_t k)
    {
        if (run.tips[k].z >= limits_.top) {
            return;
        }
        open_.clear();
        for (std::size_t n = 0; n < regions_.size(); ++n) {
            if (own_[n].empty() || own_[n][k] != 0) {
                open_.push_back(&regions_[n]);
            }
        }
        look_at(run.tool, run.tips[k], run.lines[k]);
    }

    const WallGouge& deepest() const { return deepest_; }

private:
    static constexpr int kLevels = 8;
    static constexpr int kPlaces = 96;  // round the edge

    void look_at(const Tool& tool, Vec3d tip, std::uint32_t line)
    {
        const CutRegion* nearest = nullptr;
        double least = kUnbounded;
        for (const CutRegion* region : open_) {
            const double beyond = beyond_of(*region, tool, tip);
            if (beyond <= limits_.plan_tolerance) {
                return;
            }
            nearest = beyond < least ? region : nearest;
            least = std::min(least, beyond);
        }
        if (nearest != nullptr && follows_curves(*nearest) &&
            nearest->operation().tool.number == tool.number) {
            take(least, tip, tool, line);
            return;
        }
        const double end = std::min(end_height(tool), limits_.top - tip.z);
        const int levels = end > 0 ? kLevels : 0;
        for (int k = 0; k <= levels; ++k) {
            const double height = levels > 0 ? end * k / levels : 0.0;
            look_around(tool, tip, height, line);
        }
    }

    static bool follows_curves(const CutRegion& region)
    {
        return region.operation().prismatic && is_on_curves(region.operation());
    }

    // mm: how far the end reaches beyond the region's walls, or its axis leaves the curves; kUnbounded where it is
    // below the floor, or wider than the tool that follows the curves.
    double beyond_of(const CutRegion& region, const Tool& tool, Vec3d tip) const
    {
        constexpr double kRounding = 1e-6;  // mm
        const RegionAt here = region.around(in_plan(tip));
        const double own = region.operation().tool.radius;
        const bool on_curves = follows_curves(region);
        const double off = own - here.inside;
        // under the groove's flank: its bottom
        const double flank =
            on_curves ? profile_height(region.operation().tool, std::clamp(off, 0.0, own)) : 0.0;
        if (here.floor - here.below - flank > tip.z + limits_.floor_tolerance ||
            (on_curves && tool.radius > own + kRounding)) {
            return kUnbounded;
        }
        return on_curves ? off : radius_at_height(tool, limits_.top - tip.z) - here.inside;
    }

    void look_around(const Tool& tool, Vec3d tip, double height, std::uint32_t line)
    {
        constexpr double kTurn = 6.283185307179586;
        const double radius = radius_at_height(tool, height);
        const double z = tip.z + height;
        for (int k = 0; k < kPlaces; ++k) {
            const double angle = kTurn * k / kPlaces;
            const Vec2d place{tip.x + radius * elementary::cos(angle),
                              tip.y + radius * elementary::sin(angle)};
            here_.clear();
            for (const CutRegion* region : open_) {
                here_.push_back(region->around(place));
            }
            take(cuts_at(here_, z, limits_.top).wall, {place.x, place.y, z}, tool, line);
        }
    }

    void take(double depth, Vec3d place, const Tool& tool, std::uint32_t line)
    {
        if (depth > std::max(deepest_.depth, limits_.plan_tolerance) &&
            limits_.stock.is_over(in_plan(place), place.z)) {
            deepest_ = {depth, {place, line, tool.number}};
        }
    }

    const std::vector<CutRegion>& regions_;
    const std::vector<std::vector<char>>& own_;
    const WallLimits& limits_;
    std::vector<const CutRegion*> open_;  // at the position
    std::vector<RegionAt> here_;
    WallGouge deepest_;
};

// The positions that each finish may have cut; all of those that have walls or rough.
std::vector<std::vector<char>> own_positions(const std::vector<CutRegion>& regions,
                                             const ToolPositions& run,
                                             const WallLimits& limits)
{
    std::vector<std::vector<char>> out(regions.size());
    for (std::size_t n = 0; n < regions.size(); ++n) {
        if (regions[n].is_ground()) {
            out[n] = whole_cuts(run, limits.top, [&](Vec3d tip) {
                return radius_at_height(run.tool, limits.top - tip.z) -
                           regions[n].around(in_plan(tip)).inside <=
                       limits.plan_tolerance;
            });
        }
    }
    return out;
}

}  // namespace

Cuts cuts_at(const std::vector<RegionAt>& regions, double z, double top)
{
    double least = top - z;
    Cuts cuts{least, 0};
    for (const RegionAt& region : regions) {
        const double below = std::max(0.0, region.floor - region.below - z);
        const double beyond = std::max(0.0, -region.inside);
        if (std::max(below, beyond) < least) {
            least = std::max(below, beyond);
            cuts = beyond > below ? Cuts{0, beyond} : Cuts{below, 0};
        }
    }
    return cuts;
}

WallGouge deepest_wall_gouge(const std::vector<CutRegion>& regions,
                             const std::vector<ToolPositions>& runs,
                             const WallLimits& limits)
{
    WallGouge deepest;
    for (const ToolPositions& run : runs) {
        const std::vector<std::vector<char>> own = own_positions(regions, run, limits);
        std::vector<WallGouge> found(kBands);
        for_each_band(run.tips.size(), [&](std::size_t begin, std::size_t end, std::size_t band) {
            GougeSearch search{regions, own, limits};
            for (std::size_t k = begin; k < end; ++k) {
                search.look_at(run, k);
            }
            found[band] = search.deepest();
        });
        for (const WallGouge& one : found) {
            deepest = one.depth > deepest.depth ? one : deepest;
        }
    }
    return deepest;
}

}  // namespace cusp::verify
