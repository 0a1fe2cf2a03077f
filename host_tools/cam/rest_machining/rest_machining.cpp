// Runs of feed moves between rapids become stretches; rapids are made anew.
#include "host_tools/cam/rest_machining/rest_machining.hpp"

#include <algorithm>
#include <optional>

#include "host_tools/cam/rest_machining/rest_transitions.hpp"
#include "host_tools/cam/rest_machining/run_intervals.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

#include "fmt/format.h"

namespace cusp::rest_machining {

using job::Job;
using job::Operation;
using toolpath::end_of;
using toolpath::LineTo;
using toolpath::MoveKind;
using toolpath::PlannedOperation;
using toolpath::points_of;
using toolpath::Tool;
using toolpath::ToolMove;
using toolpath::Toolpath;

namespace {

constexpr double kRunIn = 0.25;    // of the diameter
constexpr double kNothing = 1e-6;  // mm
// mm: at the start of a run, where a descent comes to stock
constexpr double kShortAir = 1.5;

// Without their folders.
std::string names_of(const std::vector<std::string>& programs)
{
    std::string text;
    for (const std::string& program : programs) {
        text += (text.empty() ? "" : ", ") + program.substr(program.find_last_of('/') + 1);
    }
    return text;
}

std::vector<FeedRun> runs_of(const Toolpath& path)
{
    std::vector<FeedRun> runs;
    bool is_open = false;
    Vec3d at{};
    for (const ToolMove& move : path.moves) {
        if (move.kind == MoveKind::kRapid) {
            is_open = false;
        } else {
            if (!is_open) {
                runs.emplace_back(at);
            }
            is_open = true;
            runs.back().add(move);
        }
        at = end_of(move);
    }
    return runs;
}

// Joins intervals where going on through air is no slower than leaving it out.
std::vector<RunInterval> joined(const std::vector<RunInterval>& intervals,
                                const FeedRun& run,
                                const Toolpath& path,
                                const RestTransitions& transitions)
{
    std::vector<RunInterval> out;
    for (const RunInterval& next : intervals) {
        if (!out.empty() && (next.begin <= out.back().end ||
                             run.seconds(path, {out.back().end, next.begin}) <=
                                 transitions.seconds_over(run.point_at(out.back().end),
                                                          run.point_at(next.begin)))) {
            out.back().end = std::max(out.back().end, next.end);
        } else {
            out.push_back(next);
        }
    }
    return out;
}

// The tool less the tolerance, and less what chords lie beside curves.
EndProfile inner_end(const Tool& tool, const RestTolerance& tolerance)
{
    EndProfile end{tool, tolerance.surface - kChordError};
    if (tool.corner_radius <= 0 && !is_conical(tool)) {
        end.radius = std::max(0.0, tool.radius - tolerance.wall + kChordError);
        end.flat = end.radius;
    }
    return end;
}

std::vector<RunInterval> kept_of(const FeedRun& run,
                                 const SweptStock& stock,
                                 const Toolpath& path,
                                 const RestTolerance& tolerance,
                                 const RestTransitions& transitions)
{
    std::vector<RunInterval> kept = run.in_stock(stock, inner_end(path.tool, tolerance));
    for (RunInterval& interval : kept) {
        interval = run.widened(interval, kRunIn * 2 * path.tool.radius);
        if (interval.begin <= kShortAir) {
            interval.begin = 0;
        }
    }
    return joined(kept, run, path, transitions);
}

struct RestPath {
    std::vector<ToolMove> moves;
    double kept{};     // mm
    double removed{};  // mm
    int retracts{};
};

RestPath rest_of_runs(const SweptStock& stock,
                      const Job& job,
                      const RestTolerance& tolerance,
                      const Toolpath& path)
{
    RestPath rest;
    RestTransitions transitions{stock, job, path, inner_end(path.tool, tolerance), rest.moves};
    for (const FeedRun& run : runs_of(path)) {
        double kept = 0;
        for (const RunInterval& interval : kept_of(run, stock, path, tolerance, transitions)) {
            transitions.go_to(run.point_at(interval.begin), interval.begin <= 0);
            transitions.cut(run.moves_in(interval));
            kept += interval.end - interval.begin;
        }
        rest.kept += kept;
        rest.removed += run.length() - kept;
    }
    transitions.retract();
    rest.retracts = transitions.retracts();
    return rest;
}

// A drilling cycle is divided into whole holes, each from its rapid over the place on.
RestPath rest_of_holes(const SweptStock& stock,
                       const Job& job,
                       const RestTolerance& tolerance,
                       const Toolpath& path)
{
    const double clearance_z = job.stock_top + job.clearance;
    RestPath rest;
    FeedRun feeds{{}};
    std::vector<ToolMove> moves;
    bool meets_stock = false;
    double length = 0;
    Vec3d at{};
    const auto finish = [&] {
        (meets_stock ? rest.kept : rest.removed) += length;
        if (meets_stock) {
            rest.moves.insert(rest.moves.end(), moves.begin(), moves.end());
            ++rest.retracts;
        }
        moves.clear();
        meets_stock = false;
        length = 0;
    };
    for (const ToolMove& move : path.moves) {
        const Vec3d end = end_of(move);
        const bool is_over = at.z >= clearance_z && end.z >= clearance_z;
        if (is_over && in_plan(end).x != in_plan(at).x) {
            finish();
        } else if (is_over && in_plan(end).y != in_plan(at).y) {
            finish();
        }
        moves.push_back(move);
        if (move.kind != MoveKind::kRapid) {
            FeedRun feed{at};
            feed.add(move);
            length += feed.length();
            meets_stock =
                meets_stock || !feed.in_stock(stock, inner_end(path.tool, tolerance)).empty();
        }
        at = end;
    }
    finish();
    return rest;
}

}  // namespace

RestTolerance rest_tolerance(const Operation& operation)
{
    constexpr double kOfScallop = 1.0 / 20;
    constexpr double kLeast = 1e-3;  // mm
    double tolerance = std::min(operation.tolerance.plan, operation.tolerance.floor);
    if (operation.tolerance.scallop) {
        tolerance = std::min(tolerance, kOfScallop * *operation.tolerance.scallop);
    }
    tolerance = std::max(operation.rest.tolerance.value_or(tolerance), kLeast);
    return {tolerance,
            operation.prismatic ? std::max(tolerance, operation.tolerance.plan) : tolerance};
}

void take_away(const Toolpath& path, SweptStock& stock)
{
    const EndProfile whole{path.tool};
    const EndProfile inner{path.tool, kChordError};
    Vec3d at{};
    for (const ToolMove& move : path.moves) {
        if (move.kind == MoveKind::kRapid) {
            at = end_of(move);
            continue;
        }
        const EndProfile& end = std::holds_alternative<LineTo>(move.shape) ? whole : inner;
        for (const Vec3d p : points_of(move, at, kChordError)) {
            stock.add(end, at, p);
            at = p;
        }
    }
}

void keep_rest(const SweptStock& stock,
               const Job& job,
               const RestRequest& request,
               PlannedOperation& operation)
{
    const double tolerance = request.tolerance.surface;
    Toolpath& path = operation.path;
    RestPath rest = path.cycle ? rest_of_holes(stock, job, request.tolerance, path)
                               : rest_of_runs(stock, job, request.tolerance, path);
    operation.stats.rest =
        toolpath::RestFigures{request.programs, rest.removed, rest.kept, tolerance};
    if (rest.removed <= kNothing) {
        return;
    }
    path.moves = std::move(rest.moves);
    operation.stats.retracts = rest.retracts;
    if (operation.stats.scallop_bound_mm > 0) {
        operation.stats.scallop_bound_mm += tolerance;
    }
    path.comments.push_back(
        fmt::format("rest machining after {}: {:.0f} of {:.0f} mm, tolerance {:g} mm",
                    names_of(request.programs), rest.kept, rest.kept + rest.removed, tolerance));
}

}  // namespace cusp::rest_machining
