// Slices, clears, and writes level by level; then asks the model about every move.
#include "host_tools/adaptive_isocurve/rough_levels.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

#include "host_tools/adaptive_isocurve/fitted_edges.hpp"
#include "host_tools/adaptive_isocurve/level_slice.hpp"
#include "host_tools/clearing/clearing.hpp"
#include "host_tools/clearing/level_moves.hpp"
#include "host_tools/input_error/input_error.hpp"
#include "host_tools/offset/edge_tree.hpp"
#include "host_tools/toolpath/toolpath_measure.hpp"

#include "fmt/format.h"

namespace cusp::host {
namespace {

constexpr double kWritten = 1e-3;      // mm: what rounding in the program may take, and more
constexpr double kFirst = 2e-3;        // mm from the edge of a slice to the outermost pass
constexpr double kPitchOfRadius = 15;  // a lattice no finer than the radius over this
constexpr double kFit = 1.5e-3;        // mm: of the edges of slices by lines and arcs
// Each level keeps this much more than the one above, mm: else it would meet slivers at walls, as
// wide as the fits of the two differ.
constexpr double kTaper = 1e-3;
constexpr double kChord = 1e-3;  // mm: where arcs are written as lines
constexpr double kMostLevels = 1e4;
constexpr double kProofStep = 1e-3;  // mm: how far below the truth a proved clearance may be

struct StepOver {
    double across;  // mm between passes
    double ridge;   // mm left between them
};

// A flat part clears all it covers; round corners leave a ridge, kept to a fifth of the level.
StepOver step_over(const Tool& tool, double depth)
{
    const double corner = tool.corner_radius;
    const double ridge = std::min(0.2 * depth, 0.15 * corner);
    const double round = 2.0 * std::sqrt(ridge * (2.0 * corner - ridge));
    const double flat = 1.2 * (tool.radius - corner);
    return flat > round ? StepOver{flat, 0.0} : StepOver{round, ridge};
}

struct StockBox {
    Box2d plan;
    double top;
    double bottom;
};

StockBox stock_of(const Job& job, const SurfaceModel& model, double allowance)
{
    const Vec3d low = model.box_low();
    const Vec3d high = model.box_high();
    StockBox stock{
        {low.x, low.y, high.x, high.y}, std::max(job.stock_top, high.z), low.z + allowance};
    if (job.stock_x) {
        stock.plan.x0 = std::min(stock.plan.x0, (*job.stock_x)[0]);
        stock.plan.x1 = std::max(stock.plan.x1, (*job.stock_x)[1]);
    }
    if (job.stock_y) {
        stock.plan.y0 = std::min(stock.plan.y0, (*job.stock_y)[0]);
        stock.plan.y1 = std::max(stock.plan.y1, (*job.stock_y)[1]);
    }
    if (job.stock_bottom) {
        stock.bottom = std::max(stock.bottom, *job.stock_bottom);
    }
    return stock;
}

double beside(const Box2d& box, Vec2d p)
{
    return std::hypot(std::max({box.x0 - p.x, p.x - box.x1, 0.0}),
                      std::max({box.y0 - p.y, p.y - box.y1, 0.0}));
}

void check(const Job& job, const Operation& operation, const Tool& tool)
{
    const auto refuse = [&](const std::string& what) {
        throw InputError(
            fmt::format("{}: {} with roughing = true: {}", job.file, operation.strategy, what));
    };
    if (operation.tools.size() > 1) {
        refuse(fmt::format("tools names {} tools; one roughs, `tool` finishes",
                           operation.tools.size()));
    }
    if (!(operation.plan_tolerance < tool.radius)) {
        refuse(fmt::format("plan_tolerance is {:g} mm, not below the radius of {:g} mm of tool {}",
                           operation.plan_tolerance, tool.radius, tool.number));
    }
    if (operation.max_depth && *operation.max_depth <= 2 * kWritten) {
        refuse(fmt::format("max_depth is {:g} mm, not above {:g} mm", *operation.max_depth,
                           2 * kWritten));
    }
}

std::vector<double> level_heights(const Job& job,
                                  const Operation& operation,
                                  const StockBox& stock,
                                  double step)
{
    std::vector<double> out;
    for (const double depth : operation.layers) {
        const double z = job.stock_top - depth;
        if (z < stock.bottom - 1e-9) {
            throw InputError(fmt::format(
                "{}: layers: depth {:g} mm is below the bottom at z = {:g} mm (the lowest place of "
                "the part, or of the stock, and the allowance)",
                job.file, depth, stock.bottom));
        }
        out.push_back(z);
    }
    if (!out.empty()) {
        return out;
    }
    const double deep = stock.top - stock.bottom;
    if (deep < kWritten) {
        throw InputError(
            fmt::format("{}: roughing: with an allowance of {:g} mm the lowest level "
                        "is at z = {:g} mm, the stock's top at {:g} mm: nothing is to "
                        "be roughed",
                        job.file, operation.allowance, stock.bottom, stock.top));
    }
    if (deep / step > kMostLevels) {
        throw InputError(
            fmt::format("{}: max_depth makes {:.0f} levels of a stock {:g} mm high, "
                        "more than {:g}",
                        job.file, deep / step, deep, kMostLevels));
    }
    const double count = std::max(1.0, std::ceil(deep / step - 1e-9));
    for (double k = 1; k <= count; ++k) {
        out.push_back(stock.top - deep * k / count);
    }
    return out;
}

class LevelRougher {
public:
    LevelRougher(const Job& job, const Operation& operation)
        : job_{job},
          operation_{operation},
          tool_{operation.tools.empty() ? operation.tool : operation.tools.front()},
          model_{operation.floor}
    {
        check(job, operation, tool_);
        const double depth = operation.max_depth.value_or(tool_.radius);
        step_ = step_over(tool_, depth);
        stock_ = stock_of(job, model_, operation.allowance);
        check_height();
        heights_ = level_heights(job, operation, stock_,
                                 std::max(0.5 * depth, depth - step_.ridge - 2 * kWritten));
        inner_fit_ = std::min(0.25 * operation.plan_tolerance, 0.02 * step_.across);
    }

    PlannedOperation plan()
    {
        const auto begin = std::chrono::steady_clock::now();
        const double out = 1.05 * (tool_.radius + operation_.allowance);
        SliceSettings settings;
        settings.keep = operation_.allowance + kWritten;
        settings.excess = 0.5 * operation_.plan_tolerance;
        settings.least_pitch = tool_.radius / kPitchOfRadius;
        settings.field = {stock_.plan.x0 - out, stock_.plan.y0 - out, stock_.plan.x1 + out,
                          stock_.plan.y1 + out};
        const LevelSlices slices{model_, tool_, settings};
        LevelMoves moves{planned_.path,
                         {std::max(stock_.top, job_.stock_top) + job_.clearance, operation_.entry,
                          operation_.output != OutputForm::kLines, kChord}};
        double above = stock_.top;
        std::optional<RegionOffset> region_above;
        for (std::size_t k = 0; k < heights_.size(); ++k) {
            job_.report_progress(static_cast<double>(k) / static_cast<double>(heights_.size()));
            const std::optional<Level> level = cleared_level(slices, k);
            if (!level) {
                break;
            }
            RegionOffset here{level->region};
            write_level(*level, here, region_above, above, moves);
            // Ridges of a ball's passes stand over the level.
            above = heights_[k] + step_.ridge;
            region_above.emplace(std::move(here));
        }
        moves.retract();
        finish(moves, begin);
        return std::move(planned_);
    }

private:
    void check_height() const
    {
        const double clearance = job_.stock_top + job_.clearance;
        if (model_.box_high().z > clearance) {
            throw InputError(fmt::format(
                "{}: the part rises to z = {:g} mm, over the clearance "
                "height of {:g} mm: rapid moves would hit it",
                operation_.floor_files.empty() ? job_.file : operation_.floor_files.front(),
                model_.box_high().z, clearance));
        }
    }

    // Straight ways in the region: as far from its edge at both ends and at places between as the
    // places are apart.
    static bool way_inside(const RegionOffset& region, Vec2d from, Vec2d to)
    {
        const double room_from = region.clearance(from);
        const double room_to = region.clearance(to);
        const double length = norm(to - from);
        if (room_from < 0 || room_to < 0) {
            return false;
        }
        if (room_from + room_to >= length) {
            return true;
        }
        if (length < 2.0 * kChord) {
            return true;  // out by no more than chords may be
        }
        const Vec2d middle = (from + to) * 0.5;
        return way_inside(region, from, middle) && way_inside(region, middle, to);
    }

    // Links are looked at for themselves: what makes them takes looks a tenth of a millimetre
    // apart.
    static bool way_inside(const RegionOffset& region, const std::vector<Edge>& way)
    {
        return std::all_of(way.begin(), way.end(), [&](const Edge& edge) {
            const int parts = edge.turn == 0 ? 1 : 1 + static_cast<int>(sweep(edge) / 0.02);
            for (int k = 0; k < parts; ++k) {
                const Vec2d from = point_on(edge, static_cast<double>(k) / parts);
                const Vec2d to = point_on(edge, static_cast<double>(k + 1) / parts);
                if (!way_inside(region, from, to)) {
                    return false;
                }
            }
            return true;
        });
    }

    struct Level {
        double bottom;
        Region2d region;
        ClearedRegion cleared;
    };

    static Region2d fitted_region(const Region2d& slice, double fit)
    {
        Region2d out;
        for (const Contour& contour : slice.contours) {
            Contour edges = fitted_edges(contour, fit, true);
            if (edges.size() >= 2 && std::abs(area(edges)) > fit * length(edges)) {
                out.contours.push_back(std::move(edges));
            }
        }
        return out;
    }

    // None where the tool fits nowhere. Offsets of a level may fail on edges that nearly coincide:
    // edges fitted otherwise, and other steps, are as good.
    std::optional<Level> cleared_level(const LevelSlices& slices, std::size_t k) const
    {
        for (const double share : {1.0, 0.96, 0.9}) {
            for (const double fit : {kFit, 3.0 * kFit, kFit / 3.0}) {
                const double more = fit + kChord + kTaper * static_cast<double>(k);
                Level level{heights_[k], fitted_region(slices.at(heights_[k], more), fit), {}};
                if (level.region.contours.empty()) {
                    return std::nullopt;
                }
                ClearingSettings clearing;
                clearing.first = kFirst;
                clearing.step = share * step_.across - 4.0 * inner_fit_;
                clearing.direction = operation_.direction_of_cut;
                level.cleared = clear_region(level.region, clearing);
                if (covers(level, clearing.step)) {
                    return level;
                }
            }
        }
        throw InputError(
            fmt::format("{}: roughing: the level at z = {:g} mm can't be cleared; try "
                        "another max_depth or allowance",
                        job_.file, heights_[k]));
    }

    // The levels below count on this one: a place left out would be met at twice the depth.
    bool covers(const Level& level, double step) const
    {
        constexpr double kReach = 0.55;  // of a step; a half is what is asked for
        std::vector<Edge> edges;
        for (const ClearingPass& pass : level.cleared.passes) {
            edges.insert(edges.end(), pass.path.begin(), pass.path.end());
        }
        const EdgeTree passes{edges};
        const RegionOffset inside{level.region};
        const double pitch = 0.4 * step;
        for (double x = stock_.plan.x0; x <= stock_.plan.x1; x += pitch) {
            for (double y = stock_.plan.y0; y <= stock_.plan.y1; y += pitch) {
                const Vec2d at{x, y};
                if (inside.clearance(at) > 2 * kFirst &&
                    (edges.empty() || !passes.any_nearer(at, kReach * step))) {
                    return false;
                }
            }
        }
        return true;
    }

    bool cuts_stock(const Contour& path) const
    {
        return std::any_of(path.begin(), path.end(), [&](const Edge& edge) {
            const double room = beside(stock_.plan, point_on(edge, 0.5));
            return room < tool_.radius + 0.5 * length(edge);
        });
    }

    std::vector<LevelRun> runs_of(const ClearedRegion& cleared, const RegionOffset& region)
    {
        const bool arcs = operation_.output != OutputForm::kLines;
        std::vector<LevelRun> out;
        bool linked = false;  // the pass before is the last of `out`
        for (const ClearingPass& pass : cleared.passes) {
            if (!cuts_stock(pass.path)) {
                linked = false;
                continue;
            }
            // The outermost passes stay as they are: the levels below count on them.
            const std::vector<Edge> edges =
                arcs || pass.level == 0 ? pass.path : fitted_edges(pass.path, inner_fit_, false);
            ++loops_;
            if (linked && pass.start == PassStart::kLink && way_inside(region, pass.link)) {
                std::vector<Edge>& run = out.back().edges;
                run.insert(run.end(), pass.link.begin(), pass.link.end());
                run.insert(run.end(), edges.begin(), edges.end());
            } else {
                out.push_back({edges, false});
            }
            linked = true;
        }
        return out;
    }

    void write_level(const Level& level,
                     const RegionOffset& region,
                     const std::optional<RegionOffset>& region_above,
                     double top,
                     LevelMoves& moves)
    {
        LayerSpace space{top, level.bottom, tool_.radius, {}, {}, {}};
        space.room = [&](Vec2d place, double extra) {
            return region.clearance(place) >= extra;
        };
        space.beside_stock = [&](Vec2d place) {
            return beside(stock_.plan, place) >= tool_.radius;
        };
        if (region_above) {
            space.cleared_above = [&](Vec2d from, Vec2d to) {
                return way_inside(*region_above, from, to);
            };
        }
        const std::vector<LevelRun> runs = runs_of(level.cleared, region);
        for (const LevelRun& run : runs) {
            moves.add(run, space);
        }
        levels_ += runs.empty() ? 0 : 1;
    }

    // The least clearance of all moves but those at the clearance height.
    double least_clearance() const
    {
        double least = std::numeric_limits<double>::infinity();
        Vec3d at{};
        bool started = false;
        for (const ToolMove& move : planned_.path.moves) {
            const Vec3d end = end_of(move);
            const double enough = std::min(least, operation_.allowance + 1.0);
            if (started && std::min(at.z, end.z) < model_.box_high().z + operation_.allowance) {
                Vec3d from = at;
                for (const Vec3d& to : points_of(move, at, kChord)) {
                    const double bow = std::holds_alternative<LineTo>(move.shape) ? 0 : kChord;
                    least = std::min(
                        least,
                        model_.clearance_along(tool_, from, to, enough + bow, kProofStep) - bow);
                    from = to;
                }
            }
            at = end;
            started = true;
        }
        return least;
    }

    void finish(const LevelMoves& moves, std::chrono::steady_clock::time_point begin)
    {
        if (loops_ == 0) {
            throw InputError(
                fmt::format("{}: roughing: tool {} of radius {:g} mm with an "
                            "allowance of {:g} mm fits nowhere into the stock",
                            job_.file, tool_.number, tool_.radius, operation_.allowance));
        }
        const double least = least_clearance();
        Toolpath& path = planned_.path;
        path.tool = tool_;
        path.feed = job_.feed;
        path.plunge_feed = job_.plunge_feed;
        path.spindle = job_.spindle;
        path.comments = {fmt::format("{}: {} roughing levels, allowance {:g} mm",
                                     operation_.strategy, levels_, operation_.allowance),
                         fmt::format("clearance from the model at least {:.4f} mm", least)};
        OperationStats& stats = planned_.stats;
        stats.strategy = operation_.strategy;
        stats.roughing = true;
        stats.passes = loops_;
        stats.levels = levels_;
        stats.cl_points = static_cast<int>(path.moves.size());
        stats.retracts = moves.retracts();
        stats.gouge_bound_mm = std::max(0.0, -least);
        // Slices bound what is cut, not what is left: only the height of the stock does.
        stats.scallop_bound_mm = stock_.top - stock_.bottom;
        stats.counts = {{"layers", levels_},
                        {"loops", loops_},
                        {"layer_depth_mm", stock_.top - heights_.front()},
                        {"clearance_bound_mm", least},
                        {"allowance_mm", operation_.allowance}};
        if (least < operation_.allowance - kProofStep) {
            stats.warnings.push_back(
                fmt::format("roughing comes within {:.4f} mm of the model, the allowance is {:g} "
                            "mm",
                            least, operation_.allowance));
        }
        if (moves.steep_plunges() > 0) {
            stats.warnings.push_back(
                fmt::format("{} entries had no room for a ramp and plunge", moves.steep_plunges()));
        }
        stats.planning_s =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    }

    const Job& job_;
    const Operation& operation_;
    Tool tool_;
    SurfaceModel model_;
    StepOver step_{};
    StockBox stock_{};
    std::vector<double> heights_;
    double inner_fit_{};
    PlannedOperation planned_;
    int loops_{};
    int levels_{};
};

}  // namespace

PlannedOperation plan_rough_levels(const Job& job, const Operation& operation)
{
    return LevelRougher{job, operation}.plan();
}

}  // namespace cusp::host
