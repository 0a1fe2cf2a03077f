// The passes are planned once, in plan, and written at each height.
#include "host_tools/contour_pocket/adaptive_pocket.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/adaptive_clearing/adaptive_clearing.hpp"
#include "host_tools/contour_pocket/pocket_report.hpp"
#include "host_tools/contour_pocket/pocket_task.hpp"
#include "host_tools/drop_cutter/drop_cutter.hpp"
#include "host_tools/offset/offset.hpp"
#include "host_tools/toolpath/toolpath_writer.hpp"

namespace cusp::contour_pocket {

using adaptive_clearing::AdaptivePath;
using adaptive_clearing::AdaptiveRun;
using adaptive_clearing::AdaptiveSettings;
using adaptive_clearing::clear_adaptively;
using adaptive_clearing::EntryHelix;
using adaptive_clearing::OverEngagement;
using drop_cutter::DropCutter;
using job::EntryKind;
using job::Job;
using job::Operation;
using job::OutputForm;
using job::PocketRefusal;
using nurbs::Surface;
using offset::Edge;
using offset::point_on;
using offset::Region2d;
using offset::RegionOffset;
using toolpath::ArcPlane;
using toolpath::kRapidClearance;
using toolpath::MoveKind;
using toolpath::OperationStats;
using toolpath::PlannedOperation;
using toolpath::ToolpathWriter;

namespace {

constexpr double kDegrees = kPi / 180.0;
constexpr double kHelixSlope = 0.0524;  // 3 degrees
constexpr double kLevel = 1e-6;         // mm: heights of a level floor differ by less
constexpr double kRaised = 0.2;         // mm: of rapid moves in swept ground
constexpr std::size_t kNamedPlaces = 5;

double level_of(const Operation& operation)
{
    const Vec3d first = operation.floor.front().points.front();
    for (const Surface& surface : operation.floor) {
        for (const Vec3d p : surface.points) {
            if (std::abs(p.z - first.z) > kLevel) {
                throw InputError(operation.floor_files.front() +
                                 ": clearing \"adaptive\" needs a level floor; it has z " +
                                 number_text(first.z) + " mm and " + number_text(p.z) + " mm");
            }
        }
    }
    return first.z;
}

std::vector<double> heights_of(const Job& job, const Operation& operation, double floor)
{
    const double deep = job.stock_top - floor;
    std::vector<double> heights;
    for (const double below : operation.layers) {
        if (below < deep - kLevel) {
            heights.push_back(job.stock_top - below);
        }
    }
    const int n = operation.layers.empty() && operation.max_depth && deep > 0.0
                      ? layer_count(job, operation, deep, *operation.max_depth)
                      : 1;
    for (int i = 1; i < n; ++i) {
        heights.push_back(job.stock_top - deep * i / n);
    }
    heights.push_back(floor);
    return heights;
}

// Writes runs at one height after the other.
class AdaptiveWriter {
public:
    struct Settings {
        bool arcs;
        double chord_tolerance;  // mm, > 0
        bool plunges;            // entries go straight down
    };

    AdaptiveWriter(ToolpathWriter& writer, const Settings& settings)
        : writer_{writer}, settings_{settings}
    {
    }

    // above  z: stock begins there at most
    void write(const AdaptivePath& path, double above, double z)
    {
        for (const AdaptiveRun& run : path.runs) {
            if (run.helix) {
                enter(*run.helix, above, z);
                continue;
            }
            const Vec2d start = run.path.front().start;
            if (run.link.empty()) {
                // Lower down the tool may meet slivers, so it descends at the plunge feed.
                writer_.approach(start, std::min(above + kRapidClearance, writer_.clearance_z()));
                writer_.line(MoveKind::kPlunge, {start.x, start.y, z});
            }
            for (std::size_t i = 0; i < run.link.size(); ++i) {
                // Rapid legs run above the floor.
                const bool raised =
                    run.link[i].free || (i + 1 < run.link.size() && run.link[i + 1].free);
                const Vec2d to = run.link[i].end;
                writer_.line(run.link[i].free ? MoveKind::kRapid : MoveKind::kLink,
                             {to.x, to.y, raised ? z + kRaised : z});
            }
            for (const Edge& edge : run.path) {
                cut(edge, z);
            }
        }
    }

    int entries() const { return entries_; }
    int plunges() const { return plunges_; }
    int points() const { return points_; }

private:
    void enter(const EntryHelix& helix, double above, double z)
    {
        const Vec2d c = helix.centre;
        const Vec2d side[2] = {{c.x + helix.radius, c.y}, {c.x - helix.radius, c.y}};
        writer_.approach(side[0], std::min(above + kRapidClearance, writer_.clearance_z()));
        ++entries_;
        if (helix.radius <= 0.0 || settings_.plunges) {
            plunges_ += above > z ? 1 : 0;
            writer_.line(MoveKind::kPlunge, {side[0].x, side[0].y, z});
        } else {
            writer_.line(MoveKind::kPlunge, {side[0].x, side[0].y, std::max(above, z)});
        }
        if (helix.radius <= 0.0) {
            return;
        }
        const double from = writer_.at().z;
        const double turn = 2 * kPi * helix.radius * kHelixSlope;
        const int halves = 2 * static_cast<int>(std::ceil((from - z) / turn));
        // A level turn clears what the last slope left.
        for (int i = 1; i <= halves + 2; ++i) {
            const Vec2d p = side[i % 2];
            const double at = i < halves ? from + (z - from) * i / halves : z;
            writer_.arc(MoveKind::kPlunge, {{p.x, p.y, at}, {c.x, c.y, at}, ArcPlane::kXY, false});
        }
    }

    void cut(const Edge& edge, double z)
    {
        // Rounded to G-code's digits a short arc could close to a full circle.
        constexpr double kShortArc = 0.02;
        ++points_;
        if (edge.turn != 0 && settings_.arcs && norm(edge.end - edge.start) >= kShortArc) {
            writer_.arc(MoveKind::kCut, {{edge.end.x, edge.end.y, z},
                                         {edge.centre.x, edge.centre.y, z},
                                         ArcPlane::kXY,
                                         edge.turn < 0});
            return;
        }
        int n = 1;
        if (edge.turn != 0) {
            const double step =
                2 * std::sqrt(2 * std::min(settings_.chord_tolerance / edge.radius, 0.5));
            n = static_cast<int>(std::ceil(sweep(edge) / step));
        }
        for (int i = 1; i < n; ++i) {
            const Vec2d p = point_on(edge, static_cast<double>(i) / n);
            writer_.line(MoveKind::kCut, {p.x, p.y, z});
        }
        writer_.line(MoveKind::kCut, {edge.end.x, edge.end.y, z});
    }

    ToolpathWriter& writer_;
    Settings settings_;
    int entries_{0};
    int plunges_{0};
    int points_{0};
};

std::string over_text(const OverEngagement& over)
{
    return "the engagement is " + number_text(std::round(over.engagement / kDegrees)) +
           " degrees at (" + number_text(std::round(over.at.x * 1e3) * 1e-3) + ", " +
           number_text(std::round(over.at.y * 1e3) * 1e-3) + ") mm, over max_engagement on " +
           number_text(std::round(over.length * 1e2) * 1e-2) +
           " mm: no pass into this corner or neck has less";
}

void report_engagement(const Operation& operation,
                       const AdaptivePath& path,
                       std::size_t layers,
                       OperationStats& stats)
{
    double over = 0.0;
    for (const OverEngagement& place : path.over) {
        over += place.length;
    }
    stats.counts.emplace_back("max_engagement_deg", *operation.max_engagement);
    stats.counts.emplace_back("engagement_bound_deg", path.engagement_bound / kDegrees);
    stats.counts.emplace_back("over_engagement_mm", over * static_cast<double>(layers));
    stats.counts.emplace_back("over_engagement_places", static_cast<double>(path.over.size()));
    stats.counts.emplace_back("sliver_points", static_cast<double>(path.left.size()));
    if (!path.left.empty()) {
        stats.warnings.push_back("a sliver stays at (" + number_text(path.left.front().x) + ", " +
                                 number_text(path.left.front().y) +
                                 ") mm: no straight move reaches it");
    }
    for (std::size_t i = 0; i < std::min(kNamedPlaces, path.over.size()); ++i) {
        stats.warnings.push_back(over_text(path.over[i]));
    }
    if (path.over.size() > kNamedPlaces) {
        stats.warnings.push_back(number_text(static_cast<double>(path.over.size() - kNamedPlaces)) +
                                 " more places over max_engagement");
    }
}

// The swept area is kept in cells of a twelfth of the radius.
void check_size(const Operation& operation, const Region2d& region)
{
    constexpr double kMostCells = 2e7;
    const double pitch = operation.tool.radius / 12.0;
    const offset::Box2d box = box_of(region);
    const double x = box.x1 - box.x0;
    const double y = box.y1 - box.y0;
    if (x * y > kMostCells * pitch * pitch) {
        throw InputError(
            operation.boundary_file + ": the pocket of " + number_text(x) + " x " + number_text(y) +
            " mm is over " + number_text(kMostCells * pitch * pitch) +
            " mm^2, the most that clearing \"adaptive\" takes with the tool of radius " +
            number_text(operation.tool.radius) + " mm");
    }
}

// mm: of chords in place of arcs. The bound of SweptArea has room for this share of the radius.
double chord_tolerance(const Operation& operation, const ToleranceSplit& tolerances)
{
    return std::min(tolerances.plan_tolerance, 0.005 * operation.tool.radius);
}

AdaptivePath passes_of(const Job& job,
                       const Operation& operation,
                       const Region2d& region,
                       const ToleranceSplit& tolerances)
{
    AdaptiveSettings settings;
    settings.tool_radius = operation.tool.radius;
    settings.wall_clearance = tolerances.wall_clearance;
    settings.max_engagement = *operation.max_engagement * kDegrees;
    settings.tolerance = chord_tolerance(operation, tolerances);
    settings.corner = tolerances.plan_tolerance;
    settings.direction = operation.direction_of_cut;
    settings.progress = [&](double share) {
        job.report_progress(share);
    };
    AdaptivePath path = clear_adaptively(region, settings);
    if (path.runs.empty()) {
        throw PocketRefusal(operation.boundary_file + ": the tool of radius " +
                            number_text(operation.tool.radius) +
                            " mm fits nowhere into the pocket");
    }
    return path;
}

}  // namespace

std::vector<PlannedOperation> plan_adaptive_pocket(const Job& job, const Operation& operation)
{
    const auto begin = std::chrono::steady_clock::now();
    const ToleranceSplit tolerances = split_tolerances(job, operation);
    const Region2d region = make_region(operation, tolerances.fit);
    check_work(job, operation, region, tolerances);
    check_size(operation, region);
    const DropCutter floor{operation.floor, operation.tool, tolerances.accuracy};
    check_coverage(operation, region, floor);
    const std::vector<double> heights = heights_of(job, operation, level_of(operation));
    const AdaptivePath path = passes_of(job, operation, region, tolerances);

    PlannedOperation result;
    set_tool(result.path, job, operation.tool);
    ToolpathWriter writer{result.path.moves,
                          {job.stock_top + job.clearance, operation.entry, operation.tool.radius}};
    AdaptiveWriter cutter{
        writer,
        {operation.output != OutputForm::kLines, chord_tolerance(operation, tolerances),
         operation.entry == EntryKind::kPlunge}};
    double above = job.stock_top;
    for (const double z : heights) {
        cutter.write(path, above, z);
        above = z;
    }
    writer.retract();

    OperationStats& stats = result.stats;
    stats.strategy = operation.strategy;
    stats.passes = static_cast<int>(path.runs.size() * heights.size());
    stats.levels = static_cast<int>(heights.size());
    stats.cl_points = cutter.points();
    stats.retracts = writer.retracts();
    stats.scallop_bound_mm = operation.floor_tolerance;
    stats.counts = {{"layers", static_cast<double>(heights.size())},
                    {"islands", static_cast<double>(operation.islands.size())},
                    {"entries", static_cast<double>(cutter.entries())},
                    {"lifts", static_cast<double>(writer.retracts())}};
    report_engagement(operation, path, heights.size(), stats);
    report_plunges(cutter.plunges(), stats);
    report_air(result.path.moves, job.stock_top, stats);
    const RegionOffset walls{region};
    report_uncut({job, operation, region, walls, floor, tolerances.wall_clearance, false}, stats);
    result.path.comments = {"contour_pocket: adaptive clearing, engagement at most " +
                            number_text(path.engagement_bound / kDegrees) + " degrees"};
    stats.planning_s =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return {std::move(result)};
}

}  // namespace cusp::contour_pocket
