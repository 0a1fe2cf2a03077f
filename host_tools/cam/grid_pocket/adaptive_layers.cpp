// A layer's region is what the slice of the floor and the room between the walls have in common.
#include "host_tools/cam/grid_pocket/adaptive_layers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/geometry/waterline_slices/fitted_edges.hpp"
#include "host_tools/geometry/waterline_slices/waterline_slices.hpp"

namespace cusp::grid_pocket {

using adaptive_clearing::AdaptiveSettings;
using adaptive_clearing::clear_adaptively;
using adaptive_clearing::cleared_radius;
using job::Operation;
using offset::Box2d;
using offset::common;
using offset::Region2d;
using offset::RegionOffset;
using part_model::PartModel;
using waterline_slices::fitted_region;
using waterline_slices::SliceSettings;
using waterline_slices::WaterlineSlices;

namespace {

constexpr double kFirst = 2e-3;        // mm from the edge of a region to the outermost pass
constexpr double kRounded = 1e-3;      // mm: more than rounding in the program
constexpr double kWritten = 2e-3;      // mm: rounding of two planes in the program
constexpr double kFit = 1.5e-3;        // mm: of slices as lines and arcs
constexpr double kChord = 1e-3;        // mm: tolerance of arcs written as lines
constexpr double kTaper = 1e-3;        // mm: how much more each layer keeps off the floor
constexpr double kOverFloor = 0.01;    // mm: of the last plane over the lowest place of the tip
constexpr double kPitchOfRadius = 15;  // radius over the finest pitch of slices
constexpr double kScallop = 0.15;      // of the corner radius
constexpr double kScallopOfDepth = 0.2;
constexpr double kLeastApart = 0.5;  // of max_depth: distance of planes
constexpr double kMostLayers = 1e4;

double scallop_height(const Operation& operation)
{
    const double most = kScallop * operation.tool.corner_radius;
    return std::min(most, kScallopOfDepth * operation.levels.max_depth.value_or(kUnbounded));
}

class LayerPlanner {
public:
    explicit LayerPlanner(const PocketSpace& pocket)
        : pocket_{pocket},
          model_{pocket.operation.part.floor},
          slices_{model_, pocket.operation.tool, slice_settings(pocket)},
          room_{pocket.walls.at(pocket.kept + kWallRounding + pocket.rough_allowance - kFirst)},
          scallops_{scallop_height(pocket.operation)}
    {
    }

    AdaptiveLayers plan()
    {
        AdaptiveLayers out;
        out.max_engagement = *pocket_.operation.passes.max_engagement;
        out.scallops = scallops_;
        out.clears = cleared_radius(pocket_.operation.tool, scallops_);
        out.chord = kChord;
        const std::vector<double> planes = planes_down();
        double above = pocket_.job.stock_top;
        for (const double z : planes) {
            AdaptiveLayer layer{above, z, region_at(z, out.layers.size()), {}};
            layer.path = clear_adaptively(layer.region, settings(out.clears));
            // Slivers stand as high as before.
            above = layer.path.left.empty() ? z + scallops_ : above;
            out.layers.push_back(std::move(layer));
            pocket_.job.report_progress(0.3 + 0.2 * static_cast<double>(out.layers.size()) /
                                                  static_cast<double>(planes.size()));
        }
        return out;
    }

private:
    static SliceSettings slice_settings(const PocketSpace& pocket)
    {
        const Operation& operation = pocket.operation;
        const double out = 2.0 * operation.tool.radius;
        const Box2d box = box_of(pocket.centres);
        return {pocket.rough_allowance + kRounded,
                0.5 * operation.tolerance.plan,
                operation.tool.radius / kPitchOfRadius,
                {box.x0 - out, box.y0 - out, box.x1 + out, box.y1 + out}};
    }

    // The passes after a layer cut, at its walls and on its slopes, the allowance too.
    double most_between_planes() const
    {
        const Operation& operation = pocket_.operation;
        if (!operation.levels.max_depth) {
            return kUnbounded;
        }
        const FollowSettings follow = follow_settings(operation);
        const double band = band_height(follow) * (follow.both_sides ? 2 : 1);
        const double depth = *operation.levels.max_depth - kWritten;
        const double step = depth - std::max(scallops_, pocket_.rough_allowance + band);
        return std::min(depth - scallops_,
                        std::max({step, kLeastApart * *operation.levels.max_depth,
                                  operation.levels.min_depth.value_or(0)}));
    }

    std::vector<double> planes_down() const
    {
        const double lowest = lowest_of_tip(pocket_);
        const double most = most_between_planes();
        std::vector<double> ends;
        for (const double depth : pocket_.operation.levels.layers) {
            if (pocket_.job.stock_top - depth > lowest) {
                ends.push_back(pocket_.job.stock_top - depth);
            }
        }
        const double top = pocket_.job.stock_top;
        if ((top - lowest) / most > kMostLayers) {
            refuse_grid_pocket(pocket_.job, "max_depth makes more than 10000 layers");
        }
        const double more = kFit + kChord + kRounded + slices_.max_excess() + kOverFloor;
        ends.push_back(lowest + more + kTaper * (top - lowest) / most);
        std::vector<double> planes;
        double above = top;
        for (const double end : ends) {
            const double count =
                above > end ? std::max(1.0, std::ceil((above - end) / most - 1e-9)) : 0.0;
            for (double k = 1; k <= count; ++k) {
                planes.push_back(above + (end - above) * k / count);
            }
            above = std::min(above, end);
        }
        return planes;
    }

    Region2d region_at(double z, std::size_t layer) const
    {
        const double more = kFit + kChord + kTaper * static_cast<double>(layer);
        return common(fitted_region(slices_.at(z, more), kFit), room_);
    }

    AdaptiveSettings settings(double radius) const
    {
        const Operation& operation = pocket_.operation;
        AdaptiveSettings out;
        out.tool_radius = radius;
        out.wall_clearance = kFirst;
        out.max_engagement = *operation.passes.max_engagement * kPi / 180.0;
        out.tolerance = std::min(kChord, 0.005 * radius);
        out.corner = operation.tolerance.plan;
        out.direction = operation.passes.direction_of_cut;
        return out;
    }

    const PocketSpace& pocket_;
    PartModel model_;
    WaterlineSlices slices_;
    Region2d room_;
    double scallops_;
};

}  // namespace

AdaptiveLayers adaptive_layers(const PocketSpace& pocket) { return LayerPlanner{pocket}.plan(); }

std::vector<LayerReach> reach_of(const AdaptiveLayer& layer,
                                 const AdaptiveLayers& layers,
                                 const PocketSpace& pocket)
{
    constexpr double kBesides = 0.05;  // mm: slices keep so much more than the allowance
    const CellGrid& grid = pocket.grid;
    std::vector<LayerReach> out(grid.size(), LayerReach::kNone);
    if (layer.path.runs.empty()) {
        return out;
    }
    const RegionOffset region{layer.region};
    const double half = elementary::hypot(grid.gx(), grid.gy()) / 2;
    const double near_sliver = pocket.operation.tool.radius + half;
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const Cell cell = grid.cell(i);
        if (!grid.inside(cell) || pocket.rough_heights[i] > layer.above) {
            continue;
        }
        const Vec2d at = grid.centre(cell);
        const double inside = region.clearance(at);
        const auto& slivers = layer.path.left;
        if (std::any_of(slivers.begin(), slivers.end(),
                        [&](Vec2d sliver) { return norm(sliver - at) < near_sliver; })) {
            continue;
        }
        if (inside >= std::max(0.0, half - layers.clears)) {
            out[i] = LayerReach::kCut;
        } else if (inside > -(pocket.rough_allowance + kBesides)) {
            out[i] = LayerReach::kBeside;
        }
    }
    return out;
}

}  // namespace cusp::grid_pocket
