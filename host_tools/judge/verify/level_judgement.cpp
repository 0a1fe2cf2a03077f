// Point by point; where a tool has room is a distance transform of the points where its centre may
// be.
#include "host_tools/judge/verify/level_judgement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "host_tools/geometry/toolpath/tool_tip.hpp"
#include "host_tools/job/job/thread.hpp"
#include "host_tools/judge/verify/bands.hpp"
#include "host_tools/judge/verify/distance_transform.hpp"
#include "host_tools/judge/verify/wall_gouge.hpp"
#include "host_tools/judge/verify/wall_stock.hpp"

namespace cusp::verify {

using job::Operation;
using job::Prismatic;
using job::ProfileSide;

namespace {

constexpr double kSlopeRun = 2;  // of a ramped tab's end, over its height
constexpr char kTooLong = 2;     // in a map of tops of tabs

class LevelJudge {
public:
    LevelJudge(const LevelQuestion& question, VerifyFigures& figures)
        : q_{question},
          figures_{figures},
          regions_{cut_regions(q_.job, q_.grid)},
          maps_{std::vector<double>(q_.grid.size(), kNoValue),
                std::vector<double>(q_.grid.size(), 0.0),
                std::vector<double>(q_.grid.size(), q_.job.stock_top)}
    {
    }

    LevelMaps judge()
    {
        find_gouges();
        for (const CutRegion& region : regions_) {
            if (region.operation().prismatic && thread_of(region.operation()) == nullptr) {
                find_left(region);
            }
        }
        return std::move(maps_);
    }

private:
    double x(std::size_t k) const { return q_.grid.x(k / q_.grid.ny, k % q_.grid.ny); }
    double y(std::size_t k) const { return q_.grid.y(k / q_.grid.ny, k % q_.grid.ny); }

    void find_gouges()
    {
        std::vector<Cuts> worst(kBands);
        std::vector<std::size_t> walls(kBands);  // points of the deepest cuts through walls
        for_each_band(q_.grid.nx, [&](std::size_t begin, std::size_t end, std::size_t band) {
            std::vector<RegionAt> here(regions_.size());
            for (std::size_t k = begin * q_.grid.ny; k < end * q_.grid.ny; ++k) {
                for (std::size_t n = 0; n < regions_.size(); ++n) {
                    here[n] = regions_[n].at(x(k), y(k), k);
                    if (here[n].inside >= 0 && here[n].floor > -kUnbounded) {
                        maps_.part[k] = std::min(maps_.part[k], here[n].floor);
                    }
                }
                if (!(q_.cut[k] < q_.stock.height(k))) {
                    continue;
                }
                const Cuts cuts = cuts_at(here, q_.cut[k], q_.stock.height(k));
                worst[band].gouge = std::max(worst[band].gouge, cuts.gouge);
                if (cuts.wall > worst[band].wall) {
                    worst[band].wall = cuts.wall;
                    walls[band] = k;
                }
                maps_.gouge[k] = cuts.gouge;
            }
        });
        figures_.gouge_max = 0;
        figures_.wall_gouge_max = 0;
        for (std::size_t band = 0; band < kBands; ++band) {
            figures_.gouge_max = std::max(figures_.gouge_max, worst[band].gouge);
            if (worst[band].wall > std::max(*figures_.wall_gouge_max, q_.plan_tolerance)) {
                const std::size_t k = walls[band];
                figures_.wall_gouge_at = {{x(k), y(k), q_.cut[k]}};
            }
            figures_.wall_gouge_max = std::max(*figures_.wall_gouge_max, worst[band].wall);
        }
        find_wall_gouges();
    }

    // The moves tell of cuts between the points of the grid.
    void find_wall_gouges()
    {
        take_gouge(deepest_wall_gouge(
            regions_, q_.runs,
            {q_.stock, q_.job.stock_top, q_.plan_tolerance, q_.floor_tolerance}));
    }

    // high  points that the operation has left above its floor
    void find_wall_faults(const CutRegion& region, const std::vector<char>& high)
    {
        const Operation& operation = region.operation();
        const bool is_rest = !operation.rest.after.empty() || !q_.job.stock_programs.empty();
        if (!q_.job.turned_programs.empty() || (is_rest && operation.cuts(job::Region::kGrooves))) {
            return;  // what is cut before may be left out as a whole
        }
        const auto is_open = [&](Vec2d at, double reach) {
            return q_.stock.any_near(at, reach, [&](std::size_t k) { return high[k] != 0; });
        };
        const double thin = is_rest ? operation.rest.tolerance.value_or(std::min(
                                          operation.tolerance.floor, operation.tolerance.plan))
                                    : 0.0;
        const WallFaults found =
            faults_at_walls(region, {regions_, q_.cuts, q_.stock, is_open, q_.plan_tolerance + thin,
                                     q_.plan_tolerance, q_.floor_tolerance});
        if (found.stock &&
            (!figures_.wall_stock || found.stock->thickness > figures_.wall_stock->thickness)) {
            figures_.wall_stock = found.stock;
        }
        take_gouge(found.gouge.value_or(WallGouge{}));
    }

    void take_gouge(const WallGouge& found)
    {
        if (found.depth > *figures_.wall_gouge_max) {
            figures_.wall_gouge_max = found.depth;
            figures_.wall_gouge_at = found.at;
        }
    }

    // Points that the operation has to cut to its floor.
    std::vector<char> required(const CutRegion& region) const
    {
        const Operation& operation = region.operation();
        const bool walled =
            operation.cuts(job::Region::kLevelPocket) ||
            (operation.cuts(job::Region::kHoles) && !operation.prismatic->loops.empty()) ||
            (operation.cuts(job::Region::kOutline) &&
             operation.prismatic->side != ProfileSide::kOn);
        std::vector<char> out(q_.grid.size(), 0);
        const double pitch = q_.grid.pitch;
        const double radius = operation.tool.radius;
        if (!walled) {
            for_each_band(q_.grid.nx, [&](std::size_t begin, std::size_t end, std::size_t) {
                for (std::size_t k = begin * q_.grid.ny; k < end * q_.grid.ny; ++k) {
                    out[k] = is_inside(region, k) ? 1 : 0;
                }
            });
            return out;
        }
        std::vector<double> room(q_.grid.size());
        for_each_band(q_.grid.nx, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t k = begin * q_.grid.ny; k < end * q_.grid.ny; ++k) {
                room[k] = region.room(x(k), y(k));
            }
        });
        // Between walls that are wider than the tool by less than twice the tolerance no path need be found.
        const double sure = radius + operation.tolerance.plan;
        std::vector<char> centres(q_.grid.size());
        for (std::size_t k = 0; k < room.size(); ++k) {
            centres[k] = room[k] >= sure ? 1 : 0;
        }
        const std::vector<double> away = distances_from(centres, q_.grid);
        const double reach = std::max(0.0, flat_radius(operation.tool) - 2 * pitch);
        const bool traced = is_traced(operation);
        // of a profile, the way of the tool along the wall; a point nearer than its radius is on it
        const double deepest = operation.cuts(job::Region::kOutline) ? radius : kUnbounded;
        for (std::size_t k = 0; k < room.size(); ++k) {
            const bool cut =
                traced ? room[k] > radius - pitch && room[k] <= radius && away[k] <= traced_reach()
                       : room[k] > pitch && room[k] <= deepest && away[k] <= reach;
            out[k] = cut ? 1 : 0;
        }
        return out;
    }

    // True where an end without a flat leaves tabs: it cuts the floor where its tip goes alone, in a row one pitch wide.
    bool is_traced(const Operation& operation) const
    {
        return operation.cuts(job::Region::kOutline) && operation.prismatic->tabs &&
               flat_radius(operation.tool) <= 2 * q_.grid.pitch;
    }

    // mm: how far the tip passes from a point of that row.
    double traced_reach() const { return 2 * q_.grid.pitch; }

    // mm: how far such an end cuts a point of that row above its tip.
    double above_tip(const Operation& operation) const
    {
        return is_traced(operation) ? profile_height(operation.tool, traced_reach()) : 0.0;
    }

    bool is_inside(const CutRegion& region, std::size_t k) const
    {
        const Operation& operation = region.operation();
        if (operation.cuts(job::Region::kEdges)) {
            // corners into which the cone does not come are left to the gouge alone
            return false;
        }
        if (operation.cuts(job::Region::kTop) && operation.prismatic->loops.empty()) {
            return (*q_.job.stock_x)[0] <= x(k) && x(k) <= (*q_.job.stock_x)[1] &&
                   (*q_.job.stock_y)[0] <= y(k) && y(k) <= (*q_.job.stock_y)[1];
        }
        if (operation.cuts(job::Region::kTop)) {
            return region.room(x(k), y(k)) < 0;
        }
        return region.at(x(k), y(k), k).inside > q_.grid.pitch / 4;
    }

    void find_left(const CutRegion& region)
    {
        const Operation& operation = region.operation();
        const Prismatic& cut = *operation.prismatic;
        std::vector<char> high(q_.grid.size(), 0);
        const std::vector<char> here = required(region);
        const double tolerance = q_.floor_tolerance + above_tip(operation);
        std::size_t cells = 0;
        for (std::size_t k = 0; k < here.size(); ++k) {
            if (here[k] == 0 || std::isnan(q_.cut[k])) {
                continue;
            }
            ++cells;
            const RegionAt at = region.at(x(k), y(k), k);
            const double left = q_.cut[k] - at.floor;
            maps_.left[k] = std::isnan(maps_.left[k]) ? left : std::min(maps_.left[k], left);
            high[k] = left - at.above > tolerance + at.left ? 1 : 0;
        }
        figures_.cells += cells;
        find_wall_faults(region, high);
        if (cut.tabs) {
            count_tabs(region, here, high);
        }
        for (std::size_t k = 0; k < high.size(); ++k) {
            if (high[k] == 0) {
                continue;
            }
            const RegionAt at = region.at(x(k), y(k), k);
            const double left = q_.cut[k] - at.floor - at.above;
            if (!figures_.level_left || left > figures_.level_left->height) {
                figures_.level_left =
                    LevelLeft{left, {x(k), y(k)}, operation.number, operation.name()};
            }
        }
    }

    // Tabs are islands of stock as high as asked for; points near their tops are taken out of `high`.
    void count_tabs(const CutRegion& region, const std::vector<char>& here, std::vector<char>& high)
    {
        const Prismatic& cut = *region.operation().prismatic;
        const double full = cut.top - cut.depth + cut.tabs->height;
        std::vector<std::size_t> island;
        std::vector<char> open = high;
        std::vector<char> tops(high.size(), 0);
        std::vector<std::size_t> of_tabs;
        const std::ptrdiff_t near = points_between_slivers(region.operation().tool.radius);
        const double top_tolerance = q_.floor_tolerance + above_tip(region.operation());
        int standing = 0;
        for (std::size_t k = 0; k < open.size(); ++k) {
            if (open[k] == 0) {
                continue;
            }
            island.assign(1, k);
            open[k] = 0;
            double highest = q_.cut[k];
            for (std::size_t n = 0; n < island.size(); ++n) {
                add_neighbours(island[n], near, open, island);
                highest = std::max(highest, q_.cut[island[n]]);
            }
            if (std::abs(highest - full) <= top_tolerance &&
                extent_of(island) >= cut.tabs->width / 2) {
                ++standing;
                for (const std::size_t at : island) {
                    tops[at] = std::abs(q_.cut[at] - full) <= top_tolerance ? 1 : 0;
                    of_tabs.push_back(at);
                }
            }
        }
        const std::vector<double> from_floor = distances_from(cut_down(here, high), q_.grid);
        mark_long_tops(region, near, tops);
        const std::vector<double> away = distances_from(tops, q_.grid);
        if (!of_tabs.empty()) {
            const double foot = tab_foot(region.operation());
            for (const std::size_t at : of_tabs) {
                const bool is_tab =
                    tops[at] != kTooLong && away[at] <= foot &&
                    (!is_over_slope(region, at, full + top_tolerance, away[at]) ||
                     is_print(region.operation(), q_.cut[at] - full + cut.tabs->height,
                              from_floor[at]));
                high[at] = is_tab ? 0 : high[at];
            }
        }
        const int wanted = cut.tabs->count > 0 ? loops_at(region, here) * cut.tabs->count
                                               : static_cast<int>(cut.tabs->places.size());
        figures_.tabs_standing += standing;
        figures_.tabs_wanted += wanted;
        const bool judged = std::find(here.begin(), here.end(), 1) != here.end();
        if (standing < wanted && judged && !figures_.lost_tab) {
            figures_.lost_tab = {
                region.operation().number, region.operation().name(), {farthest(here, away), 0, 0}};
        }
    }

    // Loops of the operation that have points of those.
    int loops_at(const CutRegion& region, const std::vector<char>& here) const
    {
        std::vector<char> loops(region.operation().prismatic->loops.size(), 0);
        for (std::size_t k = 0; k < here.size(); ++k) {
            if (here[k] != 0) {
                loops[region.nearest_loop(x(k), y(k))] = 1;
            }
        }
        return static_cast<int>(std::count(loops.begin(), loops.end(), 1));
    }

    // The place of the point that is farthest away, among those `here`.
    Vec3d farthest(const std::vector<char>& here, const std::vector<double>& away) const
    {
        std::size_t best = 0;
        for (std::size_t k = 0; k < here.size(); ++k) {
            if (here[k] != 0 && !std::isnan(q_.cut[k]) &&
                (here[best] == 0 || away[k] > away[best])) {
                best = k;
            }
        }
        return {x(best), y(best), q_.cut[best]};
    }

    // Marks the points of tops that are longer than a tab, where the tool's axis passes.
    void mark_long_tops(const CutRegion& region, std::ptrdiff_t near, std::vector<char>& tops) const
    {
        std::vector<char> open = tops;
        std::vector<std::size_t> top;
        for (std::size_t k = 0; k < open.size(); ++k) {
            if (open[k] == 0) {
                continue;
            }
            top.assign(1, k);
            open[k] = 0;
            for (std::size_t n = 0; n < top.size(); ++n) {
                add_neighbours(top[n], near, open, top);
            }
            top.erase(std::remove_if(top.begin(), top.end(),
                                     [&](std::size_t at) { return !is_on_way(region, at); }),
                      top.end());
            if (static_cast<double>(top.size()) * q_.grid.pitch > most_width(region)) {
                for (const std::size_t at : top) {
                    tops[at] = kTooLong;
                }
            }
        }
    }

    // The points that the tool's axis passes when it goes along the wall, in a row one pitch wide: there a tab is as long
    // as it should be, and no sliver is left beside its ends.
    bool is_on_way(const CutRegion& region, std::size_t k) const
    {
        const double radius = region.operation().tool.radius;
        const double room = region.room(x(k), y(k));
        return region.operation().prismatic->side != ProfileSide::kOn &&
               room > radius - q_.grid.pitch && room <= radius;
    }

    // mm: the length of a tab's top along the way of the tool, with what the row of points may be wrong by.
    double most_width(const CutRegion& region) const
    {
        constexpr double kWider = 1.25;
        constexpr double kPitches = 6;
        const Operation& operation = region.operation();
        return kWider * operation.prismatic->tabs->width + 2 * operation.tool.corner_radius +
               kPitches * q_.grid.pitch;
    }

    // True if stock on the tool's way is higher than a tab's end may be, so far from its top.
    //
    // most  z of the top, with what it may be wrong by
    bool is_over_slope(const CutRegion& region, std::size_t k, double most, double away) const
    {
        constexpr double kPitches = 3;  // the top's last point, and positions on the slope
        const Operation& operation = region.operation();
        const double beyond = away - kPitches * q_.grid.pitch - operation.tool.corner_radius;
        if (!is_on_way(region, k) || beyond <= 0) {
            return false;
        }
        return !operation.prismatic->tabs->ramped || q_.cut[k] > most - beyond / kSlopeRun;
    }

    // The points of those `here` that are not too high.
    std::vector<char> cut_down(const std::vector<char>& here, const std::vector<char>& high) const
    {
        std::vector<char> out(here.size());
        for (std::size_t k = 0; k < here.size(); ++k) {
            out[k] = here[k] != 0 && high[k] == 0 && !std::isnan(q_.cut[k]) ? 1 : 0;
        }
        return out;
    }

    // True if a round end that stands on the floor leaves as much: in a narrow corner the ends of tabs reach over both
    // walls, so that what is left there is far from any top.
    //
    // left   mm over the floor
    // away   mm from the nearest point that is cut down to it
    bool is_print(const Operation& operation, double left, double away) const
    {
        const toolpath::Tool& tool = operation.tool;
        const double cut_down = radius_at_height(tool, q_.floor_tolerance + above_tip(operation));
        return tool.corner_radius > 0 &&
               left <= profile_height(tool, std::min(tool.radius, away + cut_down + q_.grid.pitch));
    }

    // mm: how far a tab reaches beyond its top, at most: its slopes, and between wall and tool.
    // Stock left farther away is no tab, even if it is joined to one.
    static double tab_foot(const Operation& operation)
    {
        constexpr double kWall = 2;  // a wall is longer than the path inside it
        const job::Tabs& tabs = *operation.prismatic->tabs;
        return 2 * operation.tool.radius + (tabs.ramped ? kWall * kSlopeRun * tabs.height : 0.0);
    }

    // Between a wall and the circle that the tool leaves beside an vertical end of a tab stock gets narrow as a square.
    // The raster meets it again, where it is a pitch wider than the pitch beside the wall, after no more points than this.
    std::ptrdiff_t points_between_slivers(double radius) const
    {
        return 2 + static_cast<std::ptrdiff_t>(std::ceil(std::sqrt(2 * radius / q_.grid.pitch)));
    }

    // mm: the longer side of the box around the points.
    double extent_of(const std::vector<std::size_t>& island) const
    {
        Vec2d low{kUnbounded, kUnbounded};
        Vec2d high{-kUnbounded, -kUnbounded};
        for (const std::size_t k : island) {
            low = {std::min(low.x, x(k)), std::min(low.y, y(k))};
            high = {std::max(high.x, x(k)), std::max(high.y, y(k))};
        }
        return std::max(high.x - low.x, high.y - low.y);
    }

    void add_neighbours(std::size_t k,
                        std::ptrdiff_t near,
                        std::vector<char>& open,
                        std::vector<std::size_t>& island) const
    {
        const auto i = static_cast<std::ptrdiff_t>(k / q_.grid.ny);
        const auto j = static_cast<std::ptrdiff_t>(k % q_.grid.ny);
        for (std::ptrdiff_t di = -near; di <= near; ++di) {
            for (std::ptrdiff_t dj = -near; dj <= near; ++dj) {
                const std::ptrdiff_t a = i + di;
                const std::ptrdiff_t b = j + dj;
                if (a < 0 || b < 0 || a >= static_cast<std::ptrdiff_t>(q_.grid.nx) ||
                    b >= static_cast<std::ptrdiff_t>(q_.grid.ny)) {
                    continue;
                }
                const std::size_t at =
                    q_.grid.index(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
                if (open[at] != 0) {
                    open[at] = 0;
                    island.push_back(at);
                }
            }
        }
    }

    const LevelQuestion& q_;
    VerifyFigures& figures_;
    std::vector<CutRegion> regions_;
    LevelMaps maps_;
};

}  // namespace

LevelMaps judge_levels(const LevelQuestion& question, VerifyFigures& figures)
{
    return LevelJudge{question, figures}.judge();
}

}  // namespace cusp::verify
