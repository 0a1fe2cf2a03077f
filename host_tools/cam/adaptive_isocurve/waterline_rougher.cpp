// Slices the model, clears the slices, selects what is left and writes it, level by level. Then
// measures the clearance of every move.
#include "host_tools/cam/adaptive_isocurve/waterline_rougher.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>

#include "host_tools/base/cancellation/cancellation.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/cam/adaptive_clearing/adaptive_path_writer.hpp"
#include "host_tools/cam/adaptive_clearing/engagement_report.hpp"
#include "host_tools/cam/adaptive_isocurve/cleared_level.hpp"
#include "host_tools/cam/adaptive_isocurve/rest_regions.hpp"
#include "host_tools/cam/adaptive_isocurve/rough_clearance.hpp"
#include "host_tools/cam/adaptive_isocurve/rough_constants.hpp"
#include "host_tools/cam/adaptive_isocurve/waterline_adaptive.hpp"
#include "host_tools/cam/clearing/clearing.hpp"
#include "host_tools/cam/clearing/layer_toolpath_writer.hpp"
#include "host_tools/cam/clearing/rest_between_tools.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/geometry/waterline_slices/fitted_edges.hpp"
#include "host_tools/geometry/waterline_slices/waterline_slices.hpp"

#include "fmt/format.h"

namespace cusp::adaptive_isocurve {

using adaptive_clearing::AdaptivePath;
using adaptive_clearing::AdaptivePathWriter;
using adaptive_clearing::EngagementReport;
using adaptive_clearing::off_slivers;
using clearing::ClearedRegion;
using clearing::ClearingPass;
using clearing::ClearingSettings;
using clearing::LayerRun;
using clearing::LayerSpace;
using clearing::LayerToolpathWriter;
using clearing::PassStart;
using clearing::rest_offset_between_tools;
using job::EntryKind;
using job::OutputForm;
using offset::Box2d;
using offset::Edge;
using offset::Region2d;
using offset::RegionOffset;
using toolpath::OperationStats;
using toolpath::Tool;
using toolpath::ToolMove;
using toolpath::Toolpath;
using toolpath::ToolpathWriter;
using waterline_slices::fitted_edges;
using waterline_slices::fitted_region;
using waterline_slices::SliceSettings;
using waterline_slices::WaterlineSlices;

namespace {

constexpr std::size_t kLevelsAtOnce = 8;
// mm: how much more each level keeps off walls than the one above. Without it a level would cut
// slivers at walls, as wide as the fits of both levels differ.
constexpr double kTaper = 1e-3;
// mm: how far a cutter is clear where another was, beyond the tolerance of fits. Without it many
// short parts beside walls would have to be examined.
constexpr double kMargin = 6e-3;

class WaterlineRougher {
public:
    WaterlineRougher(const RoughWork& work,
                     const Tool& tool,
                     double clearance,
                     const std::vector<RoughedWaterlines>& before)
        : work_{work}, tool_{tool}, clearance_{clearance}, before_{before}
    {
        step_ = pass_spacing(tool, work.depths.scallop_height);
        inner_fit_ = std::min(0.25 * work.operation.tolerance.plan, 0.02 * step_.stepover);
        result_.levels.tool = tool;
    }

    // Over 60 lines: levels share what is prepared for all of them.
    RoughedTool plan()
    {
        const auto begin = std::chrono::steady_clock::now();
        const Box2d& plan = work_.stock.plan;
        const bool adaptive = work_.operation.passes.max_engagement.has_value();
        // Passes of bounded engagement start and turn beside the stock, in a strip that is no neck.
        const double out =
            (adaptive ? 2.7 : 1.05) * (tool_.radius + work_.operation.passes.allowance);
        SliceSettings settings;
        settings.clearance = clearance_;
        settings.excess = 0.5 * work_.operation.tolerance.plan;
        settings.least_pitch = work_.least_pitch;
        settings.field = {plan.x0 - out, plan.y0 - out, plan.x1 + out, plan.y1 + out};
        const WaterlineSlices slices{work_.model, tool_, settings};
        result_.keeps = most_kept(slices.pitch()) + slices.max_excess();
        field_ = settings.field;
        const double clearance_z =
            std::max(work_.stock.top, work_.job.stock_top) + work_.job.clearance;
        const bool arcs = work_.operation.output != OutputForm::kLines;
        std::vector<ToolMove>& moves = result_.planned.path.moves;
        LayerToolpathWriter runs{result_.planned.path,
                                 tool_.radius,
                                 {clearance_z, work_.operation.passes.entry, arcs, kRoughChord}};
        ToolpathWriter writer{moves, {clearance_z, work_.operation.passes.entry, tool_.radius}};
        AdaptivePathWriter passes{
            writer,
            {arcs, kRoughChord, work_.operation.passes.entry == EntryKind::kPlunge, scallops()}};
        double above = work_.stock.top;
        const std::vector<double>& heights = work_.depths.heights;
        std::vector<std::optional<Level>> ahead;  // cleared at once, from `first` on
        std::size_t first = 0;
        for (std::size_t k = 0; k < heights.size(); ++k) {
            work_.job.report_progress(work_.share_before + work_.share * static_cast<double>(k) /
                                                               static_cast<double>(heights.size()));
            if (k == first + ahead.size()) {
                first = k;
                ahead = cleared_levels(slices, k);
            }
            const std::optional<Level>& level = ahead[k - first];
            if (!level) {
                break;
            }
            add_region(*level);
            if (level->adaptive) {
                write_adaptive(*level, above, passes);
            } else {
                write_level(*level, k, above, runs);
            }
            // Scallops of passes and the rest of other cutters are higher than the level.
            above = heights[k] + scallops();
        }
        roughed_moves_ = moves.size();
        write_floors(passes, runs);
        if (adaptive) {
            writer.retract();
            finish({writer.retracts(), passes.plunges(), passes.entries()}, begin);
        } else {
            runs.retract();
            finish({runs.retracts(), runs.steep_plunges(), 0}, begin);
        }
        return std::move(result_);
    }

private:
    // mm: the height of stock left above a cleared level.
    double scallops() const
    {
        const double round = tool_.corner_radius > 0 ? step_.scallop_height : 0.0;
        return before_.empty() ? round : work_.depths.scallop_height + work_.depths.rest_height;
    }

    // The largest distance of the slices from smooth walls, over all levels and fits.
    double most_kept(double pitch) const
    {
        const double core = tool_.corner_radius + clearance_;
        const double side = 1.42 * pitch;
        const double levels = static_cast<double>(work_.depths.heights.size());
        return std::sqrt(core * core + 0.5 * side * side) - tool_.corner_radius + 0.01 * side +
               6.0 * kFit + kRoughChord + kTaper * levels + kFirst + kMargin;
    }

    struct Level {
        double bottom;
        Region2d region;
        ClearedRegion cleared;
        std::optional<AdaptivePath> adaptive{};
    };
    struct Written {
        int retracts;
        int plunges;
        int entries;  // of adaptive paths
    };

    void add_region(const Level& level)
    {
        result_.levels.regions.push_back(std::make_unique<RegionOffset>(
            level.adaptive ? off_slivers(level.region, *level.adaptive, tool_.radius)
                           : level.region));
    }

    // Cuts the level floors to size, from the lowest of the levels above on that have cleared their ground.
    void write_floors(AdaptivePathWriter& passes, LayerToolpathWriter& runs)
    {
        if (!work_.floors.tool() || work_.floors.tool()->number != tool_.number) {
            return;
        }
        const double most = work_.operation.levels.max_depth.value_or(tool_.radius);
        floors_ = work_.floors.levels().size();
        for (const LevelFloor& floor : work_.floors.levels()) {
            const RegionOffset* over = nullptr;
            double top = work_.stock.top;
            for (std::size_t k = 0; k < result_.levels.regions.size() &&
                                    work_.depths.heights[k] >= floor.z + result_.keeps;
                 ++k) {
                over = result_.levels.regions[k].get();
                top = work_.depths.heights[k] + scallops();
            }
            const double deep = top - floor.z;
            const int steps = static_cast<int>(std::max(1.0, std::ceil(deep / most - 1e-9)));
            for (int i = 1; i <= steps; ++i) {
                const double above = floor.z + deep * (steps - i + 1) / steps;
                const double z = floor.z + deep * (steps - i) / steps;
                write_floor(floor, {above, z}, over, passes, runs);
                over = floor.centres.get();
            }
        }
    }

    struct Heights {
        double above;
        double z;
    };

    // over  cleared down to the height above; null: nothing is
    void write_floor(const LevelFloor& floor,
                     Heights heights,
                     const RegionOffset* over,
                     AdaptivePathWriter& passes,
                     LayerToolpathWriter& runs)
    {
        Level level{heights.z, {}, floor.cleared, floor.adaptive};
        if (level.adaptive) {
            write_adaptive(level, heights.above, passes);
            return;
        }
        write_runs(runs_of(level.cleared, *floor.centres),
                   space_of(level, heights.above, *floor.centres, over), runs);
    }

    // The next levels.
    std::vector<std::optional<Level>> cleared_levels(const WaterlineSlices& slices,
                                                     std::size_t first) const
    {
        std::vector<std::optional<Level>> out(
            std::min(kLevelsAtOnce, work_.depths.heights.size() - first));
        {
            const part_model::PartModel::SharedQueries shared{work_.model};
            parallel::for_each(out.size(), [&](std::size_t k) {
                const cancellation::Part part{"roughing level ", static_cast<int>(first + k + 1),
                                              ""};
                out[k] = cleared_level(slices, first + k);
            });
        }
        work_.model.forget_cells();  // the next levels need cells at other heights
        return out;
    }

    // The cleared level; none where the tool fits nowhere. Offsets may fail on edges that nearly
    // coincide: other fits and other stepovers are tried then.
    std::optional<Level> cleared_level(const WaterlineSlices& slices, std::size_t k) const
    {
        for (const double share : {1.0, 0.96, 0.9}) {
            for (const double fit : {kFit, 3.0 * kFit, kFit / 3.0}) {
                const double more = fit + kRoughChord + kTaper * static_cast<double>(k);
                Level level{work_.depths.heights[k],
                            fitted_region(slices.at(work_.depths.heights[k], more), fit),
                            {}};
                if (level.region.contours.empty()) {
                    return std::nullopt;
                }
                if (work_.operation.passes.max_engagement) {
                    level.adaptive = adaptive_level(
                        work_, level.region, tool_,
                        {field_, kFirst, step_.scallop_height, kRoughChord}, cleared_before(k));
                    return level;
                }
                ClearingSettings clearing;
                clearing.wall_clearance = kFirst;
                clearing.stepover = share * step_.stepover - 4.0 * inner_fit_;
                clearing.direction = work_.operation.passes.direction_of_cut;
                level.cleared = clear_region(level.region, clearing);
                if (covers(level.cleared, level.region, clearing.stepover, work_.stock.plan)) {
                    return level;
                }
            }
        }
        throw InputError(
            fmt::format("{}: roughing: the level at z = {:g} mm can't be cleared; try "
                        "another max_depth or allowance",
                        work_.job.file, work_.depths.heights[k]));
    }

    void write_adaptive(const Level& level, double top, AdaptivePathWriter& passes)
    {
        passes.write(*level.adaptive, top, level.bottom);
        engagement_.add(*level.adaptive, 1, level.bottom);
        result_.loops += static_cast<int>(level.adaptive->runs.size());
        levels_ += level.adaptive->runs.empty() ? 0 : 1;
    }

    bool cuts_stock(const std::vector<Edge>& path) const
    {
        return std::any_of(path.begin(), path.end(), [&](const Edge& edge) {
            return comes_near(work_.stock.plan, edge, tool_.radius);
        });
    }

    // Passes beside the stock are left out. A pass that is linked to one enters where the link begins.
    std::vector<LayerRun> runs_of(const ClearedRegion& cleared, const RegionOffset& region)
    {
        const bool arcs = work_.operation.output != OutputForm::kLines;
        std::vector<LayerRun> out;
        bool in_stock = false;  // the pass before is the last of `out`
        for (const ClearingPass& pass : cleared.passes) {
            const bool before_in_stock = std::exchange(in_stock, cuts_stock(pass.path));
            if (!in_stock) {
                continue;
            }
            // The outermost passes are not fitted: levels below depend on them.
            const std::vector<Edge> edges =
                arcs || pass.ring == 0 ? pass.path : fitted_edges(pass.path, inner_fit_, false);
            const bool linked = pass.start == PassStart::kLink && line_inside(region, pass.link);
            if (!linked || !before_in_stock) {
                out.push_back({linked ? pass.link : edges, false});
            } else {
                out.back().edges.insert(out.back().edges.end(), pass.link.begin(), pass.link.end());
            }
            if (linked) {
                out.back().edges.insert(out.back().edges.end(), edges.begin(), edges.end());
            }
        }
        return out;
    }

    // The places where the cutters before leave no stock for this one on the level.
    std::vector<ClearedPlaces> cleared_before(std::size_t k) const
    {
        std::vector<ClearedPlaces> out;
        for (const RoughedWaterlines& other : before_) {
            // The rest height counts once: later cutters leave no more above it.
            const double rest = out.empty() ? work_.depths.rest_height : 0.0;
            const auto reach = rest_offset_between_tools(other.tool, tool_, rest);
            if (k < other.regions.size() && reach) {
                out.push_back({other.regions[k].get(), *reach - 2 * kFirst});
            }
        }
        return out;
    }

    void write_level(const Level& level, std::size_t k, double top, LayerToolpathWriter& moves)
    {
        const auto& regions = result_.levels.regions;
        const RegionOffset& region = *regions[k];
        std::vector<LayerRun> runs = runs_of(level.cleared, region);
        const std::vector<ClearedPlaces> before = cleared_before(k);
        if (!before.empty()) {
            runs = rest_regions(runs, tool_.radius, before);
        }
        write_runs(runs, space_of(level, top, region, k > 0 ? regions[k - 1].get() : nullptr),
                   moves);
    }

    // over  cleared down to the top; null: nothing is
    LayerSpace space_of(const Level& level,
                        double top,
                        const RegionOffset& region,
                        const RegionOffset* over) const
    {
        LayerSpace space{top, level.bottom, tool_.radius, {}, {}, {}};
        space.scallop_height = before_.empty() ? 0.0 : scallops();
        space.has_room = [&region](Vec2d place, double extra) {
            return region.clearance(place) >= extra;
        };
        space.beside_stock = [this](Vec2d place) {
            return distance(work_.stock.plan, place) >= tool_.radius;
        };
        if (over != nullptr) {
            space.cleared_above = [over](Vec2d from, Vec2d to) {
                return line_inside(*over, from, to);
            };
        }
        return space;
    }

    void write_runs(const std::vector<LayerRun>& runs,
                    const LayerSpace& space,
                    LayerToolpathWriter& moves)
    {
        for (const LayerRun& run : runs) {
            moves.add(run, space);
        }
        result_.loops += static_cast<int>(runs.size());
        levels_ += runs.empty() ? 0 : 1;
    }

    void finish(const Written& written, std::chrono::steady_clock::time_point begin)
    {
        if (result_.loops == 0) {
            return;
        }
        const double least =
            least_clearance(work_, tool_, result_.planned.path.moves, roughed_moves_);
        Toolpath& path = result_.planned.path;
        set_tool(path, work_.job, tool_);
        path.comments = {
            fmt::format("{}: {} roughing levels, allowance {:g} mm", work_.operation.name(),
                        levels_, work_.operation.passes.allowance),
            fmt::format("clearance from the model at least {:.4f} mm", least)};
        OperationStats& stats = result_.planned.stats;
        stats.strategy = work_.operation.name();
        stats.roughing = true;
        stats.passes = result_.loops;
        stats.levels = levels_;
        stats.cl_points = static_cast<int>(path.moves.size());
        stats.retracts = written.retracts;
        stats.gouge_bound_mm = std::max(0.0, -least);
        // Slices bound what is cut, not what is left: the only bound of that is the stock's height.
        stats.scallop_bound_mm = work_.stock.top - work_.stock.bottom;
        stats.counts = {
            {"layers", levels_},
            {"loops", result_.loops},
            {"layer_depth_mm", work_.stock.top - work_.depths.heights.front()},
            {"clearance_bound_mm", least},
            {"level_floors",
             static_cast<double>(work_.floors.tool() && work_.floors.tool()->number == tool_.number
                                     ? work_.floors.levels().size()
                                     : 0)},
            {"allowance_mm", work_.operation.passes.allowance}};
        if (least < work_.operation.passes.allowance - kClearanceResolution) {
            stats.warnings.push_back(
                fmt::format("roughing comes within {:.4f} mm of the model, the allowance is {:g} "
                            "mm",
                            least, work_.operation.passes.allowance));
        }
        if (written.plunges > 0) {
            stats.warnings.push_back(
                fmt::format("{} entries had no room for a ramp and plunge", written.plunges));
        }
        if (work_.operation.passes.max_engagement) {
            stats.counts.emplace_back("entries", written.entries);
            stats.counts.emplace_back("lifts", written.retracts);
            engagement_.write(stats);
        }
        stats.planning_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }

    const RoughWork& work_;
    Tool tool_;
    double clearance_;
    const std::vector<RoughedWaterlines>& before_;
    PassSpacing step_{};
    Box2d field_;  // of the axis
    EngagementReport engagement_{work_.operation.passes.max_engagement.value_or(0.0)};
    double inner_fit_{};
    RoughedTool result_;
    int levels_{};
    std::size_t floors_{};         // cut to size
    std::size_t roughed_moves_{};  // before those on level floors
};

}  // namespace

RoughedTool rough_with(const RoughWork& work,
                       const Tool& tool,
                       double clearance,
                       const std::vector<RoughedWaterlines>& before)
{
    return WaterlineRougher{work, tool, clearance, before}.plan();
}

}  // namespace cusp::adaptive_isocurve
