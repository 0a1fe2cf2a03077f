// Checks the operation, makes the passes, lays them on the floor and joins them.
#include "host_tools/contour_pocket/contour_pocket.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "host_tools/clearing/clearing.hpp"
#include "host_tools/clearing/tip_floor.hpp"
#include "host_tools/contour_pocket/floor_path.hpp"
#include "host_tools/contour_pocket/path_interval.hpp"
#include "host_tools/contour_pocket/pocket_moves.hpp"
#include "host_tools/offset/contour_fit.hpp"
#include "host_tools/offset/region_check.hpp"

namespace cusp::host {

namespace {

std::string number(double value)
{
    char text[40];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

std::string place(Vec2d p) { return "(" + number(p.x) + ", " + number(p.y) + ")"; }

// What the tolerances of the operation leave to each step, mm.
struct Budget {
    bool outside{};
    double fit{};       // of free curves by arcs
    double aside{};     // of moves beside the plan path, either way
    double above{};     // of moves over the floor
    double cusp{};      // height between passes
    double first{};     // distance of the outermost pass from the walls
    double accuracy{};  // of floor heights
};

void check_range(const Job& job, const char* key, double value, double limit)
{
    if (!(value > 0.0) || value > limit) {
        throw InputError(job.file + ": contour_pocket: " + key + " " + number(value) +
                         " mm is not in the range above 0 to " + number(limit) + " mm");
    }
}

Budget make_budget(const Job& job, const Operation& operation)
{
    const double radius = operation.tool.radius;
    if (operation.floor.empty()) {
        throw InputError(job.file + ": contour_pocket: floor is missing");
    }
    if (!operation.boundary) {
        throw InputError(job.file + ": contour_pocket: boundary is missing");
    }
    if (!operation.scallop) {
        throw InputError(job.file + ": contour_pocket: scallop is missing");
    }
    check_range(job, "plan_tolerance", operation.plan_tolerance, radius);
    check_range(job, "floor_tolerance", operation.floor_tolerance, radius);
    check_range(job, "scallop", *operation.scallop, 0.9 * radius);
    Budget budget;
    budget.outside = operation.tolerance_side == ToleranceSide::kOutside;
    budget.fit = 0.1 * operation.plan_tolerance;
    budget.accuracy = std::min(0.1 * operation.floor_tolerance, 5e-3);
    budget.above = operation.floor_tolerance - 2.0 * budget.accuracy;
    // Passes may lie closer or wider by what the plan tolerance lets them wander.
    budget.cusp = *operation.scallop - operation.floor_tolerance;
    if (budget.outside) {
        if (budget.cusp <= 0.0) {
            throw InputError(job.file + ": contour_pocket: scallop " + number(*operation.scallop) +
                             " mm is not above floor_tolerance " +
                             number(operation.floor_tolerance) +
                             " mm, which it includes with tolerance_side \"outside\"");
        }
        budget.aside = 0.5 * (operation.plan_tolerance - budget.fit) - kWrittenStep;
        budget.first = radius + budget.fit + budget.aside + 2.0 * kWrittenStep;
    } else {
        budget.cusp = budget.cusp > 0.0 ? budget.cusp : *operation.scallop;
        budget.aside = operation.plan_tolerance - budget.fit;
        budget.first = radius;
    }
    budget.aside = std::max(budget.aside, kWrittenStep);
    return budget;
}

[[noreturn]] void refuse(const Operation& operation, const RegionFault& fault)
{
    const auto file = [&](std::size_t contour) {
        return contour == 0 ? operation.boundary_file : operation.island_files.at(contour - 1);
    };
    const std::string at = " at " + place(fault.where) + " mm";
    switch (fault.kind) {
        case RegionFaultKind::kNoLength:
            throw InputError(file(fault.first) + ": a curve has no length" + at);
        case RegionFaultKind::kCrossesItself:
            throw InputError(file(fault.first) + ": the loop crosses itself" + at);
        case RegionFaultKind::kCross:
            throw InputError(file(fault.first) + ": crosses " + file(fault.second) + at);
        case RegionFaultKind::kHoleOutside:
            throw InputError(file(fault.second) + ": the island lies outside the boundary" + at);
        case RegionFaultKind::kHoleInHole:
            throw InputError(file(fault.second) + ": the island lies inside another, " +
                             file(fault.first) + "," + at);
    }
    throw InputError(operation.boundary_file + ": the pocket has no valid region" + at);
}

Region2d make_region(const Operation& operation, double tolerance)
{
    Region2d region;
    const auto add = [&](const Loop& loop, bool outer) {
        Contour contour = fit_contour(loop, tolerance);
        const bool counter_clockwise = area(contour) > 0.0;
        region.contours.push_back(counter_clockwise == outer ? contour : reversed(contour));
    };
    add(*operation.boundary, true);
    for (const Loop& island : operation.islands) {
        add(island, false);
    }
    if (const auto fault = find_fault(region)) {
        refuse(operation, *fault);
    }
    return region;
}

void check_coverage(const Operation& operation, const Region2d& region, const TipFloor& floor)
{
    const double spacing = operation.tool.radius;
    for (const Edge& edge : region.contours.front()) {
        const int n = 1 + static_cast<int>(length(edge) / spacing);
        for (int i = 0; i < n; ++i) {
            const Vec2d p = point_on(edge, static_cast<double>(i) / n);
            if (!floor.covers(p)) {
                const std::string file =
                    operation.floor_files.empty() ? "floor" : operation.floor_files.front();
                throw InputError(file + ": the floor does not cover the pocket at " + place(p) +
                                 " mm");
            }
        }
    }
}

// The least distance inward from a level at which no cusp between is higher than allowed.
double interval_from(const Region2d& level, const TipFloor& floor, const Budget& budget)
{
    const double radius = floor.tool().radius;
    double least = 1e300;
    for (const Contour& contour : level.contours) {
        for (const Edge& edge : contour) {
            const int n = 1 + static_cast<int>(length(edge) / (0.5 * radius));
            for (int i = 0; i < n; ++i) {
                const double share = (i + 0.5) / n;
                const Vec2d p = point_on(edge, share);
                const TipFloor::Section across =
                    floor.section(p, left_normal(tangent_on(edge, share)));
                least = std::min(
                    least, path_interval(radius, budget.cusp, across.curvature, across.slope));
            }
        }
    }
    // Neighbouring moves may stray from their paths, each its own way.
    const double stray = budget.outside ? 2.0 * budget.aside : 0.0;
    return std::max(least - stray, 0.02 * radius);
}

class PocketPlanner {
public:
    PocketPlanner(const Job& job, const Operation& operation)
        : job_{job},
          operation_{operation},
          budget_{make_budget(job, operation)},
          region_{make_region(operation, budget_.fit)},
          floor_{operation.floor, operation.tool, budget_.accuracy},
          moves_{{job.stock_top, job.stock_top + job.clearance}}
    {
        const double radius = operation.tool.radius;
        laying_.aside = budget_.aside;
        laying_.above = budget_.above;
        laying_.lift = budget_.outside;
        laying_.cushion = budget_.accuracy;
        laying_.spacing =
            std::clamp(std::sqrt(2.0 * radius * budget_.above), 0.05 * radius, radius);
    }

    PlannedOperation plan()
    {
        const auto begin = std::chrono::steady_clock::now();
        check_coverage(operation_, region_, floor_);
        ClearingSettings settings;
        settings.first = budget_.first;
        settings.step = 2.0 * operation_.tool.radius;
        settings.step_from = [&](const Region2d& level) {
            return interval_from(level, floor_, budget_);
        };
        settings.direction = operation_.direction_of_cut;
        settings.cover_corners = *operation_.scallop > operation_.floor_tolerance;
        const ClearedRegion cleared = clear_region(region_, settings);
        if (cleared.passes.empty()) {
            throw InputError(operation_.boundary_file + ": the tool of radius " +
                             number(operation_.tool.radius) + " mm fits nowhere into the pocket");
        }
        for (const ClearingPass& pass : cleared.passes) {
            add_pass(pass);
        }
        moves_.retract();
        PlannedOperation result;
        fill(result, cleared);
        const auto end = std::chrono::steady_clock::now();
        result.stats.planning_s = std::chrono::duration<double>(end - begin).count();
        return result;
    }

private:
    FloorPath laid(const std::vector<Edge>& plan, bool arcs)
    {
        FloorPathSettings laying = laying_;
        laying.arcs = arcs;
        FloorPath path = lay_on_floor(plan, floor_, laying);
        if (!path.over_floor) {
            const std::string file =
                operation_.floor_files.empty() ? "floor" : operation_.floor_files.front();
            throw InputError(file + ": the floor does not cover the pocket at " +
                             place(path.missing) + " mm");
        }
        least_gap_ = std::min(least_gap_, path.least_gap);
        return path;
    }

    void add_pass(const ClearingPass& pass)
    {
        const bool arcs = operation_.output == OutputForm::kArcs;
        if (pass.start == PassStart::kLink) {
            moves_.link(laid({line_edge(last_, pass.path.front().start)}, false));
        } else {
            moves_.retract();
            enter(pass);
        }
        moves_.cut(laid(pass.path, arcs));
        last_ = pass.path.front().start;
    }

    void enter(const ClearingPass& pass)
    {
        const double room = pass.distance - budget_.first;
        const double radius = std::min(0.6 * operation_.tool.radius, room);
        const bool long_enough = length(pass.path) > 6.0 * operation_.tool.radius;
        const EntryKind kind = operation_.entry;
        const bool helix = kind == EntryKind::kHelix || (kind == EntryKind::kAuto && !long_enough);
        const FloorPath path = laid(pass.path, false);
        if (helix && radius > 0.2 * operation_.tool.radius) {
            moves_.enter_by_helix(path.start, radius, floor_);
            return;
        }
        moves_.enter_along(path, kind == EntryKind::kPlunge);
    }

    void fill(PlannedOperation& result, const ClearedRegion& cleared)
    {
        result.path.tool = operation_.tool;
        result.path.feed = job_.feed;
        result.path.plunge_feed = job_.plunge_feed;
        result.path.spindle = job_.spindle;
        OperationStats& stats = result.stats;
        stats.strategy = operation_.strategy;
        stats.passes = static_cast<int>(cleared.passes.size());
        stats.levels = cleared.levels;
        stats.cl_points = moves_.points();
        stats.retracts = moves_.retracts();
        stats.gouge_bound_mm = std::max(0.0, -least_gap_);
        stats.scallop_bound_mm = budget_.cusp + operation_.floor_tolerance;
        stats.counts = {{"loops", static_cast<double>(cleared.passes.size())},
                        {"leaves", static_cast<double>(cleared.leaves)},
                        {"islands", static_cast<double>(cleared.islands)}};
        result.path.comments = {"contour_pocket: Suh and Lee 1990, " + number(stats.levels) +
                                    " levels, " + number(stats.passes) + " loops",
                                "left at most " + number(stats.scallop_bound_mm) +
                                    " mm, gouge at most " + number(stats.gouge_bound_mm) + " mm"};
        result.path.moves = moves_.take();
    }

    const Job& job_;
    const Operation& operation_;
    Budget budget_;
    Region2d region_;
    TipFloor floor_;
    FloorPathSettings laying_;
    PocketMoves moves_;
    Vec2d last_{};
    double least_gap_{1e300};
};

}  // namespace

std::vector<PlannedOperation> plan_contour_pocket(const Job& job, const Operation& operation)
{
    std::vector<PlannedOperation> result;
    result.push_back(PocketPlanner{job, operation}.plan());
    return result;
}

}  // namespace cusp::host
