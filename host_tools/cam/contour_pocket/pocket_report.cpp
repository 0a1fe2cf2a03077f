// Counts are read by programs, warnings by people.
#include "host_tools/cam/contour_pocket/pocket_report.hpp"

#include <algorithm>
#include <string>

#include "host_tools/cam/contour_pocket/uncut_regions.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

namespace cusp::contour_pocket {

using clearing::AxialDepthTracker;
using drop_cutter::DropCutter;
using offset::area;
using offset::Region2d;
using offset::RegionOffset;
using toolpath::MoveKind;
using toolpath::OperationStats;
using toolpath::ToolMove;

namespace {

// mm2: area of the pocket beside walls (corners and necks) that the tool's body cannot sweep with
// its axis in `centres`.
double unswept_area(const Region2d& region, const Region2d& centres, double radius)
{
    return area(region) - (centres.contours.empty() ? 0.0 : area(grown(centres, radius)));
}

std::string warning_of(const UncutRegion& place)
{
    return "the tool does not reach " + std::string{place.at_walls ? "between walls" : "a valley"} +
           " at (" + number_text(place.at.x) + ", " + number_text(place.at.y) + ") mm: about " +
           number_text(place.volume) + " mm3 on " + number_text(place.area) + " mm2 stay, up to " +
           number_text(place.height) + " mm high";
}

}  // namespace

void report_air(const std::vector<ToolMove>& moves, double stock_top, OperationStats& stats)
{
    if (std::none_of(moves.begin(), moves.end(), [&](const ToolMove& move) {
            return move.kind == MoveKind::kCut && end_of(move).z < stock_top;
        })) {
        stats.warnings.push_back("nothing of the floor lies below stock.top, " +
                                 number_text(stock_top) + " mm: the program cuts no stock");
    }
}

void report_depth(const AxialDepthTracker& depth, OperationStats& stats)
{
    constexpr double kSliver = 0.02;  // mm: up to the depth of slivers
    if (!depth.max_depth()) {
        return;
    }
    stats.counts.emplace_back("deepest_cut_mm", depth.deepest());
    if (depth.deepest() > *depth.max_depth() + kSliver) {
        stats.warnings.push_back("a cut is " + number_text(depth.deepest()) +
                                 " mm deep, over the max_depth of " +
                                 number_text(*depth.max_depth()) + " mm");
    }
}

void report_uncut(const Pocket& pocket,
                  const RegionOffset& walls,
                  const DropCutter& floor,
                  bool valleys,
                  const Region2d& air,
                  OperationStats& stats)
{
    constexpr std::size_t kNamed = 5;
    const double clearance = pocket.tolerances.wall_clearance;
    const Region2d centres = walls.at(clearance);
    const double least =
        std::max(*pocket.operation.tolerance.scallop, 0.02 * pocket.operation.tool.radius);
    const std::vector<UncutRegion> places =
        uncut_regions(walls, centres, pocket.operation.part.floor, floor,
                      {clearance, pocket.job.stock_top, least, valleys, air});
    double volume = 0.0;
    double height = 0.0;
    for (const UncutRegion& place : places) {
        volume += place.volume;
        height = std::max(height, place.height);
    }
    double rest = unswept_area(pocket.region, centres, clearance);
    if (!air.contours.empty()) {
        // Corners between the stock's side and the end of the air.
        const Region2d room = RegionOffset{air}.at(clearance);
        rest = std::max(0.0, rest - unswept_area(air, room, clearance));
    }
    stats.counts.emplace_back("rest_area_mm2", rest);
    stats.counts.emplace_back("rest_places", static_cast<double>(places.size()));
    stats.counts.emplace_back("rest_volume_mm3", volume);
    stats.counts.emplace_back("rest_height_max_mm", height);
    for (std::size_t i = 0; i < std::min(kNamed, places.size()); ++i) {
        stats.warnings.push_back(warning_of(places[i]));
    }
    if (places.size() > kNamed) {
        stats.warnings.push_back(number_text(static_cast<double>(places.size() - kNamed)) +
                                 " smaller places that the tool does not reach");
    }
}

}  // namespace cusp::contour_pocket
