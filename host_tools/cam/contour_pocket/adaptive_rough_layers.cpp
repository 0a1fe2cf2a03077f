// A level's region is the slice of the floor that lies in the room between the walls.
#include "host_tools/cam/contour_pocket/adaptive_rough_layers.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/cancellation/cancellation.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/adaptive_clearing/adaptive_clearing.hpp"
#include "host_tools/cam/adaptive_clearing/adaptive_path_writer.hpp"
#include "host_tools/cam/adaptive_clearing/engagement_report.hpp"
#include "host_tools/cam/contour_pocket/adaptive_pocket.hpp"
#include "host_tools/geometry/offset/offset.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"
#include "host_tools/geometry/toolpath/toolpath_writer.hpp"
#include "host_tools/geometry/waterline_slices/fitted_edges.hpp"
#include "host_tools/geometry/waterline_slices/waterline_slices.hpp"

namespace cusp::contour_pocket {

using adaptive_clearing::AdaptivePath;
using adaptive_clearing::AdaptivePathWriter;
using adaptive_clearing::AdaptiveSettings;
using adaptive_clearing::clear_adaptively;
using adaptive_clearing::cleared_radius;
using adaptive_clearing::EngagementReport;
using adaptive_clearing::off_slivers;
using job::EntryKind;
using job::Job;
using job::kRoughingDone;
using job::Operation;
using job::OutputForm;
using offset::Box2d;
using offset::common;
using offset::Region2d;
using offset::RegionOffset;
using offset::united;
using offset::without;
using part_model::PartModel;
using toolpath::OperationStats;
using toolpath::Toolpath;
using toolpath::ToolpathWriter;
using waterline_slices::fitted_region;
using waterline_slices::SliceSettings;
using waterline_slices::WaterlineSlices;

namespace {

constexpr double kFirst = 2e-3;        // mm from the edge of a region to the outermost pass
constexpr double kRounded = 1e-3;      // mm: more than rounding in the program
constexpr double kFit = 1.5e-3;        // mm: of slices as lines and arcs
constexpr double kChord = 1e-3;        // mm: tolerance of arcs written as lines
constexpr double kTaper = 1e-3;        // mm: how much more each level keeps off the floor
constexpr double kPitchOfRadius = 15;  // radius over the finest pitch of slices
constexpr double kScallop = 0.15;      // of the corner radius
constexpr double kNeck = 0.15;         // of the radius: half the width of the widest neck
constexpr double kScallopOfDepth = 0.2;

double scallop_height(const Operation& rough)
{
    return std::min(kScallop * rough.tool.corner_radius,
                    kScallopOfDepth * rough.levels.max_depth.value_or(kUnbounded));
}

class LevelPlanner {
public:
    // clearance  mm: of the tool's centre from the walls
    LevelPlanner(const Pocket& pocket, double clearance)
        : job_{pocket.job},
          rough_{pocket.operation},
          room_{RegionOffset{pocket.region}.at(clearance - kFirst)},
          scallops_{scallop_height(rough_)},
          model_{rough_.part.floor},
          slices_{model_, rough_.tool, slice_settings()},
          highest_{model_.box_high().z + rough_.passes.allowance + kRounded + slices_.max_excess()}
    {
    }

    struct Level {
        double above;  // z: stock begins there at most
        double z;
        int layer;
        Region2d region{};
        const Level* beside{};  // cut before, in the same layer; null: none
        AdaptivePath path{};
    };

    // Levels in the order of the cuts.
    std::vector<Level> plan(const std::vector<double>& heights, double step)
    {
        std::vector<Level> all = levels_of(heights, step);
        {
            const PartModel::SharedQueries shared{model_};
            parallel::for_each(all.size(), [&](std::size_t k) {
                const cancellation::Part part{"roughing level ", static_cast<int>(k + 1), ""};
                all[k].region = region_at(all[k].z, k);
            });
        }
        drop_necks(all);
        std::vector<Level> out;
        out.reserve(all.size());
        const Level* beside = nullptr;
        for (Level& level : all) {
            const bool first = beside == nullptr || beside->layer != level.layer;
            if (!level.region.contours.empty() && (first || is_wider(level, *beside, step))) {
                level.beside = first ? nullptr : beside;
                out.push_back(std::move(level));
                beside = &out.back();
            }
        }
        parallel::for_each(out.size(), [&](std::size_t k) {
            const cancellation::Part part{"roughing level ", static_cast<int>(k + 1), ""};
            const Level* const beside_it = out[k].beside;
            out[k].path = clear_adaptively(
                out[k].region, settings(beside_it != nullptr ? beside_it->region : Region2d{}));
        });
        for (Level& level : out) {
            if (level.beside != nullptr && !level.beside->path.left.empty()) {
                level.path = clear_adaptively(
                    level.region, settings(off_slivers(level.beside->region, level.beside->path,
                                                       rough_.tool.radius)));
            }
        }
        return out;
    }

    double scallops() const { return scallops_; }
    double left_by_slices() const { return most_off(0) + slices_.max_excess(); }

private:
    SliceSettings slice_settings() const
    {
        const double out = 2.0 * rough_.tool.radius;
        const Box2d box = box_of(room_);
        return {rough_.passes.allowance + kRounded,
                0.5 * rough_.tolerance.plan,
                rough_.tool.radius / kPitchOfRadius,
                {box.x0 - out, box.y0 - out, box.x1 + out, box.y1 + out}};
    }

    static double most_off(std::size_t level)
    {
        return kFit + kChord + kTaper * static_cast<double>(level);
    }

    // Layer by layer: its height, then the steps above it.
    std::vector<Level> levels_of(const std::vector<double>& heights, double step) const
    {
        std::vector<Level> out;
        double top = job_.stock_top;
        double above = top;
        for (std::size_t layer = 0; layer < heights.size(); ++layer) {
            const double z = heights[layer];
            const int steps = std::max(1, static_cast<int>(std::ceil((top - z) / step - 1e-9)));
            for (int k = 0; k < steps; ++k) {
                out.push_back({above, z + (top - z) * k / steps, static_cast<int>(layer)});
            }
            top = z;
            above = z + scallops_;
        }
        return out;
    }

    // The more levels are before it, the more it keeps off the floor: else a layer would cut slivers
    // of what the one above has left.
    Region2d region_at(double z, std::size_t level) const
    {
        const double more = most_off(level);
        if (z > highest_ + more) {
            return room_;
        }
        return common(fitted_region(slices_.at(z, more), kFit), room_);
    }

    // Slots in which a pass can hardly turn are left to the next level of the layer where that is wide:
    // one step more stays there.
    void drop_necks(std::vector<Level>& levels) const
    {
        const double half = kNeck * rough_.tool.radius;
        std::vector<Region2d> wide(levels.size());
        parallel::for_each(levels.size(), [&](std::size_t k) {
            const Region2d core = RegionOffset{levels[k].region}.at(half);
            wide[k] = core.contours.empty() ? core : grown(core, half);
        });
        for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
            if (levels[k + 1].layer == levels[k].layer) {
                levels[k].region = common(levels[k].region,
                                          united(wide[k], without(levels[k].region, wide[k + 1])));
            }
        }
    }

    // True if some place of the level is farther than `step` from the one beside.
    static bool is_wider(const Level& level, const Level& beside, double step)
    {
        return !without(level.region, grown(beside.region, step)).contours.empty();
    }

    // open  region of the tool's centre where it meets no stock; may be empty
    AdaptiveSettings settings(Region2d open) const
    {
        AdaptiveSettings out;
        out.tool_radius = cleared_radius(rough_.tool, scallops_);
        out.wall_clearance = kFirst;
        out.max_engagement = *rough_.passes.max_engagement * kPi / 180.0;
        out.tolerance = std::min(kChord, 0.005 * rough_.tool.radius);
        out.corner = rough_.tolerance.plan;
        out.direction = rough_.passes.direction_of_cut;
        if (!open.contours.empty()) {
            out.open.push_back(std::move(open));
        }
        return out;
    }

    const Job& job_;
    const Operation& rough_;
    Region2d room_;
    double scallops_;
    PartModel model_;
    WaterlineSlices slices_;
    double highest_;  // z: from there on the floor leaves room everywhere
};

}  // namespace

void rough_adaptively(const Pocket& pocket, double step, RoughResult& result)
{
    const Job& job = pocket.job;
    const Operation& rough = pocket.operation;
    check_adaptive_size(rough, pocket.region);
    LevelPlanner planner{pocket, result.wall_clearance};
    const auto levels = planner.plan(result.heights, step);
    job.report_progress(kRoughingDone);
    Toolpath& path = result.operation.path;
    ToolpathWriter writer{path.moves,
                          {job.stock_top + job.clearance, rough.passes.entry, rough.tool.radius}};
    AdaptivePathWriter cutter{writer,
                              {rough.output != OutputForm::kLines, kChord,
                               rough.passes.entry == EntryKind::kPlunge, planner.scallops()}};
    EngagementReport engagement{*rough.passes.max_engagement};
    std::size_t runs = 0;
    for (const auto& level : levels) {
        cutter.write(level.path, level.above, level.z);
        engagement.add(level.path, 1, level.z);
        runs += level.path.runs.size();
    }
    writer.retract();
    result.left =
        rough.passes.allowance + 2.0 * step + planner.scallops() + planner.left_by_slices();
    path.comments = {"contour_pocket: " + number_text(static_cast<double>(result.heights.size())) +
                     " roughing layers in " + number_text(static_cast<double>(levels.size())) +
                     " levels, engagement at most " + number_text(engagement.bound()) +
                     " degrees, allowance " + number_text(rough.passes.allowance) + " mm"};
    OperationStats& stats = result.operation.stats;
    stats.strategy = rough.name();
    stats.roughing = true;
    stats.passes = static_cast<int>(runs);
    stats.levels = static_cast<int>(levels.size());
    stats.cl_points = cutter.points();
    stats.retracts = writer.retracts();
    stats.scallop_bound_mm = result.left;
    stats.counts = {{"layers", static_cast<double>(result.heights.size())},
                    {"islands", static_cast<double>(rough.outline.islands.size())},
                    {"entries", static_cast<double>(cutter.entries())},
                    {"lifts", static_cast<double>(writer.retracts())}};
    engagement.write(stats);
    report_plunges(cutter.plunges(), stats);
}

}  // namespace cusp::contour_pocket
