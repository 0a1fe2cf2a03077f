// Checks the input, slices, clears every layer with every cutter offered, and writes the chosen
// ones.
#include "host_tools/hull_rough/hull_rough.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "host_tools/hull_rough/depth_layers.hpp"
#include "host_tools/hull_rough/layer_clearing.hpp"
#include "host_tools/hull_rough/tool_choice.hpp"

namespace cusp::host {
namespace {

// A change by hand on a small mill; only the choice of cutters uses it.
constexpr double kChangeSeconds = 60.0;

constexpr int kMostSubdivisions = 8;

// Lines exactly a diameter apart leave fins of no width that stand through all layers: they overlap
// by at least this share of the diameter.
constexpr double kLeastOverlap = 0.01;

// Of the height of ridges, with several cutters: what one may leave where another has been.
constexpr double kRestShare = 0.25;

// Chords on rounded corners keep this much, so that G-code rounded to a micrometre still does.
constexpr double kLeastTolerance = 2e-3;

std::string text(double value)
{
    std::string out = std::to_string(value);
    out.erase(out.find_last_not_of('0') + 1);
    return out.back() == '.' ? out + '0' : out;
}

[[noreturn]] void refuse(const Job& job, const std::string& what)
{
    throw InputError(job.file + ": hull_rough: " + what);
}

void check(const Job& job, const Operation& operation, const std::vector<Tool>& tools)
{
    if (operation.floor.empty()) {
        refuse(job, "floor names no surface");
    }
    if (operation.boundary || !operation.islands.empty()) {
        refuse(job,
               "boundary and islands are not used by this strategy: the stock is the boundary");
    }
    if (operation.output == OutputForm::kNurbs) {
        refuse(job, "output \"nurbs\": layers are lines or arcs");
    }
    if (operation.extra_subdivision < 0 || operation.extra_subdivision > kMostSubdivisions) {
        refuse(job, "extra_subdivision " + std::to_string(operation.extra_subdivision) +
                        " lies outside 0 to " + std::to_string(kMostSubdivisions));
    }
    for (const double size : {operation.allowance, operation.plan_tolerance}) {
        if (!(size >= 0) || !std::isfinite(size)) {
            refuse(job, "allowance or tolerance " + text(size) + " mm must be at least 0");
        }
    }
    for (const Tool& tool : tools) {
        if (!(tool.radius > 0)) {
            refuse(job, "tool " + std::to_string(tool.number) + " has radius " + text(tool.radius) +
                            " mm; it must be above 0");
        }
        if (!(operation.overlap >= 0 && operation.overlap < 2 * tool.radius)) {
            refuse(job, "overlap " + text(operation.overlap) +
                            " mm lies outside 0 to the diameter " + text(2 * tool.radius) +
                            " mm of tool " + std::to_string(tool.number));
        }
    }
}

DepthLimits depth_limits(const Job& job, const Operation& operation, const Tool& tool)
{
    const double most = operation.max_depth.value_or(tool.radius);
    const double least = operation.min_depth.value_or(most / 2);
    if (!(most > 0) || !std::isfinite(most)) {
        refuse(job, "max_depth " + text(most) + " mm must be above 0");
    }
    if (!(least >= 0 && least <= most)) {
        refuse(job, "min_depth " + text(least) + " mm lies outside 0 to max_depth " + text(most) +
                        " mm");
    }
    return {most, least};
}

// Width that the cutter clears but for ridges of this height, which a round corner leaves.
double cleared_width(const Tool& tool, double ridge)
{
    const double corner = tool.shape == ToolShape::kFlat ? 0.0 : tool.corner_radius;
    const double height = std::min(corner, ridge);
    return 2 * (tool.radius - corner + std::sqrt(height * (2 * corner - height)));
}

struct Stock {
    Rectangle plan;
    double top;
    double bottom;
};

// The box of all hulls, of what is trimmed away too, widened to the job's stock and raised to its
// top where that is higher.
Stock stock_of(const Job& job, std::vector<Surface> surfaces)
{
    Stock stock{{1e300, 1e300, -1e300, -1e300}, -1e300, 1e300};
    for (Surface& surface : surfaces) {
        surface.trims.clear();
    }
    for (const HullPatch& patch : hull_patches(surfaces)) {
        const Rectangle box = plan_box(patch);
        stock.plan = {std::min(stock.plan.x_min, box.x_min), std::min(stock.plan.y_min, box.y_min),
                      std::max(stock.plan.x_max, box.x_max), std::max(stock.plan.y_max, box.y_max)};
        stock.top = std::max(stock.top, patch.top);
        stock.bottom = std::min(stock.bottom, patch.bottom);
    }
    if (job.stock_x) {
        stock.plan.x_min = std::min(stock.plan.x_min, (*job.stock_x)[0]);
        stock.plan.x_max = std::max(stock.plan.x_max, (*job.stock_x)[1]);
    }
    if (job.stock_y) {
        stock.plan.y_min = std::min(stock.plan.y_min, (*job.stock_y)[0]);
        stock.plan.y_max = std::max(stock.plan.y_max, (*job.stock_y)[1]);
    }
    stock.top = std::max(stock.top, job.stock_top);
    if (job.stock_bottom) {
        stock.bottom = std::max(stock.bottom, *job.stock_bottom);
    }
    return stock;
}

LayerPlan planned_layers(const Job& job,
                         const Operation& operation,
                         std::vector<HullPatch> patches,
                         const Stock& stock,
                         DepthLimits limits)
{
    if (stock.top - stock.bottom < 1e-3) {
        refuse(job, "the part is flat: its hull is " + text(stock.top - stock.bottom) +
                        " mm high and leaves nothing to rough");
    }
    if ((stock.top - stock.bottom) / limits.most > 1e4) {
        refuse(job, "max_depth " + text(limits.most) +
                        " mm makes more than 10000 layers of a stock " +
                        text(stock.top - stock.bottom) + " mm high");
    }
    if (!operation.layers.empty()) {
        LayerPlan plan;
        plan.planes.push_back(stock.top);
        for (const double depth : operation.layers) {
            const double z = job.stock_top - depth;
            if (z >= plan.planes.back() || z < stock.bottom - 1e-9) {
                refuse(job, "layers: depth " + text(depth) +
                                " mm is not below the one before and above " + "the bottom at z " +
                                text(stock.bottom) + " mm");
            }
            plan.planes.push_back(z);
        }
        plan.patches = std::move(patches);
        return plan;
    }
    LayerPlan plan = depth_layers(std::move(patches), stock.top, stock.bottom, limits);
    if (operation.extra_subdivision > 0) {
        plan.planes = least_leftover_planes(plan, limits);
    }
    return plan;
}

// Everything about one operation that its steps share.
struct Roughing {
    const Job& job;
    const Operation& operation;
    std::vector<Tool> tools;  // largest first
    Stock stock;
    LayerPlan plan;
    double most_depth;                                  // mm: of a layer
    std::vector<std::vector<LayerClearing>> clearings;  // layers x tools
    ToolChoice choice;
    double left_under_boxes{};  // mm^3 of the stock that the boxes keep
    std::size_t boxes{};

    double top(std::size_t layer) const { return plan.planes[layer]; }
    double bottom(std::size_t layer) const { return plan.planes[layer + 1]; }
    std::size_t layers() const { return plan.planes.size() - 1; }
    double thickness(std::size_t layer) const { return top(layer) - bottom(layer); }

    // How high ridges may stand in a layer: the next one cuts them with its own depth, which stays
    // within the limit where a tenth of it allows that.
    double ridge(std::size_t layer) const
    {
        const double next = layer + 1 < layers() ? thickness(layer + 1) : 0.0;
        return std::min(thickness(layer) / 4, std::max(most_depth - next, most_depth / 10));
    }

    bool round() const
    {
        return std::any_of(tools.begin(), tools.end(),
                           [](const Tool& t) { return t.corner_radius > 0; });
    }

    // How much of a ridge one cutter may leave that another counts as cleared; the rest of the
    // ridge is what each leaves between its own lines.
    double rest_ridge(std::size_t layer) const
    {
        return tools.size() > 1 ? kRestShare * ridge(layer) : 0.0;
    }

    // What may stand over the bottom of a layer where it is cleared.
    double left_over(std::size_t layer) const { return round() ? ridge(layer) : 0.0; }

    double deepest_cut() const
    {
        double deepest = thickness(0);
        for (std::size_t layer = 1; layer < layers(); ++layer) {
            deepest = std::max(deepest, thickness(layer) + left_over(layer - 1));
        }
        return deepest;
    }
};

void clear_layers(Roughing& work)
{
    const Operation& operation = work.operation;
    std::vector<std::vector<ToolOffer>> offers;
    for (std::size_t layer = 0; layer < work.layers(); ++layer) {
        const double thickness = work.thickness(layer);
        const auto boxes = boxes_above(work.plan.patches, work.bottom(layer) - operation.allowance,
                                       operation.extra_subdivision);
        work.boxes += boxes.size();
        work.left_under_boxes += thickness * union_area(boxes, work.stock.plan);
        offers.emplace_back();
        work.clearings.emplace_back();
        for (const Tool& tool : work.tools) {
            LayerSettings settings;
            // The overlap is that of the cutter; what it clears to the ridge is narrower already.
            settings.clears = cleared_width(tool, work.ridge(layer) - work.rest_ridge(layer)) / 2;
            settings.step =
                std::min(std::max(2 * tool.radius - operation.overlap, tool.radius / 50),
                         2 * settings.clears * (1 - kLeastOverlap));
            settings.tolerance = std::max(operation.plan_tolerance, kLeastTolerance);
            settings.side_allowance = operation.allowance;
            settings.one_way = operation.traversal == Traversal::kOneWay;
            settings.contour = operation.contour_clearing;
            settings.direction = operation.direction_of_cut;
            work.job.report_progress(0.9 * static_cast<double>(layer) /
                                     static_cast<double>(work.layers()));
            work.clearings.back().push_back(
                clear_layer(boxes, work.stock.plan, tool.radius, settings));
            const LayerClearing& made = work.clearings.back().back();
            offers.back().push_back({made.length / work.job.feed * 60, made.cleared_area});
        }
    }
    work.choice = choose_tools(offers, kChangeSeconds);
}

// The cutters that have cleared each layer so far, in order. What the first leaves is known to the
// height of its ridges; what the others leave, to that of `rest_ridge` too.
using Cutters = std::vector<std::vector<std::size_t>>;

// Writes layers of one cutter, after what other cutters have cleared.
class GroupWriter {
public:
    GroupWriter(const Roughing& work, std::size_t tool)
        : work_{work}, tool_{tool}, moves_{path_, settings(work)}
    {
        path_.tool = work.tools[tool];
        path_.feed = work.job.feed;
        path_.plunge_feed = work.job.plunge_feed;
        path_.spindle = work.job.spindle;
    }

    void clear(std::size_t layer) { add(work_.clearings[layer][tool_].runs, layer); }

    // What the cutters before left of a layer, so that this one can work below it. Returns false
    // where they left nothing.
    bool clear_rest(std::size_t layer, const std::vector<std::size_t>& before)
    {
        const Tool& tool = work_.tools[tool_];
        std::vector<ClearedBy> cleared;
        for (std::size_t i = 0; i < before.size(); ++i) {
            const Tool& other = work_.tools[before[i]];
            const double ridge = i == 0 ? work_.rest_ridge(layer) : 0.0;
            if (before[i] == tool_ || leaves_nothing_for(other, tool, ridge)) {
                return false;
            }
            if (const auto nested = nested_reach(other, tool, ridge)) {
                cleared.push_back({&work_.clearings[layer][before[i]], *nested});
            }
        }
        add(rest_runs(work_.clearings[layer][tool_], tool.radius, cleared), layer);
        return true;
    }

    PlannedOperation finish()
    {
        moves_.retract();
        PlannedOperation out;
        out.path = std::move(path_);
        out.stats.passes = passes_;
        out.stats.retracts = moves_.retracts();
        out.stats.cl_points = static_cast<int>(out.path.moves.size());
        if (moves_.steep_plunges() > 0) {
            out.stats.warnings.push_back(std::to_string(moves_.steep_plunges()) +
                                         " entries had no room for a ramp and plunge");
        }
        return out;
    }

private:
    const Roughing& work_;
    std::size_t tool_;
    Toolpath path_;
    LevelMoves moves_;
    int passes_{0};

    static LevelMoves::Settings settings(const Roughing& work)
    {
        return {std::max(work.stock.top, work.job.stock_top) + work.job.clearance,
                work.operation.entry, work.operation.output == OutputForm::kArcs,
                std::max(work.operation.plan_tolerance, kLeastTolerance) / 2};
    }

    void add(const std::vector<LevelRun>& runs, std::size_t layer)
    {
        const ClearZone& zone = *work_.clearings[layer][tool_].zone;
        LayerSpace space{work_.top(layer), work_.bottom(layer), zone.radius(), {}, {}, {}};
        space.room = [&zone](Vec2d place, double extra) {
            return zone.room(place, extra);
        };
        space.beside_stock = [&](Vec2d place) {
            return distance(place, place, work_.stock.plan) >= zone.radius();
        };
        if (layer > 0) {
            space.cleared_above = [&](Vec2d from, Vec2d to) {
                return work_.clearings[layer - 1][tool_].zone->clear(from, to);
            };
        }
        space.ridge = std::max(work_.left_over(layer), layer > 0 ? work_.left_over(layer - 1) : 0);
        for (const LevelRun& run : runs) {
            moves_.add(run, space);
            ++passes_;
        }
    }
};

std::vector<PlannedOperation> write_groups(const Roughing& work)
{
    std::vector<PlannedOperation> out;
    const auto& of_layer = work.choice.of_layer;
    Cutters cutters(work.layers());
    for (std::size_t first = 0; first < work.layers();) {
        const std::size_t tool = of_layer[first];
        GroupWriter writer{work, tool};
        for (std::size_t layer = 0; layer < first; ++layer) {
            if (writer.clear_rest(layer, cutters[layer])) {
                cutters[layer].push_back(tool);
            }
        }
        std::size_t last = first;
        for (; last < work.layers() && of_layer[last] == tool; ++last) {
            writer.clear(last);
            cutters[last].push_back(tool);
        }
        out.push_back(writer.finish());
        out.back().stats.levels = static_cast<int>(last - first);
        first = last;
    }
    return out;
}

void report(const Roughing& work, std::vector<PlannedOperation>& out, double seconds)
{
    double thinnest = 1e300;
    double thickest = 0;
    int islands = 0;
    int zigzags = 0;
    double closed = 0;
    double left = 0;
    std::string left_place;
    for (std::size_t layer = 0; layer < work.layers(); ++layer) {
        thinnest = std::min(thinnest, work.thickness(layer));
        thickest = std::max(thickest, work.thickness(layer));
        const LayerClearing& clearing = work.clearings[layer][work.choice.of_layer[layer]];
        islands += clearing.islands;
        zigzags += clearing.by_contours ? 0 : 1;
        closed += clearing.closed_area;
        if (left <= 0 && clearing.left.area > 0) {
            const Rectangle& spot = clearing.left.squares.front();
            left_place = "x " + text((spot.x_min + spot.x_max) / 2) + ", y " +
                         text((spot.y_min + spot.y_max) / 2) + ", z " + text(work.bottom(layer)) +
                         " mm";
        }
        left += clearing.left.area;
    }
    const Rectangle& plan = work.stock.plan;
    const double volume = (plan.x_max - plan.x_min) * (plan.y_max - plan.y_min) *
                          (work.stock.top - work.plan.planes.back());
    // Where no cutter clears every layer alone there is nothing to compare with.
    const double saved = std::isfinite(work.choice.seconds_with_one)
                             ? work.choice.seconds_with_one - work.choice.seconds
                             : 0.0;
    for (PlannedOperation& operation : out) {
        OperationStats& stats = operation.stats;
        stats.strategy = "hull_rough";
        stats.roughing = true;
        stats.gouge_bound_mm = 0;
        // Hulls bound what is cut, not what is left: only the height of the stock does.
        stats.scallop_bound_mm = work.stock.top - work.plan.planes.back();
        stats.planning_s = seconds / static_cast<double>(out.size());
        stats.counts = {{"layers", static_cast<double>(work.layers())},
                        {"raw_layers", work.plan.raw_layers},
                        {"split_layers", work.plan.split_layers},
                        {"thinnest_layer_mm", thinnest},
                        {"thickest_layer_mm", thickest},
                        {"patches", static_cast<double>(work.plan.patches.size())},
                        {"boxes", static_cast<double>(work.boxes)},
                        {"islands", islands},
                        {"zigzag_layers", zigzags},
                        {"stock_mm3", volume},
                        {"left_under_boxes_mm3", work.left_under_boxes},
                        {"tool_changes", work.choice.changes},
                        {"seconds_saved_by_tools", saved},
                        {"deepest_cut_mm", work.deepest_cut()},
                        {"closed_mm2", closed},
                        {"left_mm2", left},
                        {"engagement_deg", 180}};
        stats.warnings.push_back(
            "the first line of a layer and the ends of islands are cut at the full width "
            "of " +
            text(2 * operation.path.tool.radius) + " mm (180 degrees), at most " +
            text(work.deepest_cut()) + " mm deep");
        if (work.operation.contour_clearing && zigzags > 0) {
            stats.warnings.push_back(std::to_string(zigzags) +
                                     " layers are cleared by zigzag: loops parallel to their "
                                     "islands would come too near to them");
        }
        if (left > 0) {
            stats.warnings.push_back(text(left) + " mm2 of layers are left uncleared, first at " +
                                     left_place);
        }
        operation.path.comments = {"hull_rough: " + std::to_string(work.layers()) + " layers of " +
                                   text(thinnest) + " to " + text(thickest) +
                                   " mm, no overcut by the hull of " +
                                   std::to_string(work.plan.patches.size()) + " patches"};
    }
}

}  // namespace

std::vector<PlannedOperation> plan_hull_rough(const Job& job, const Operation& operation)
{
    const auto start = std::chrono::steady_clock::now();
    std::vector<Tool> tools = operation.tools;
    if (tools.empty()) {
        tools.push_back(operation.tool);
    }
    std::sort(tools.begin(), tools.end(),
              [](const Tool& a, const Tool& b) { return a.radius > b.radius; });
    check(job, operation, tools);
    std::vector<HullPatch> patches = hull_patches(operation.floor);
    if (patches.empty()) {
        refuse(job, "the trims of the floor leave nothing of it");
    }
    const Stock stock = stock_of(job, operation.floor);
    const DepthLimits limits = depth_limits(job, operation, tools.back());
    LayerPlan plan = planned_layers(job, operation, std::move(patches), stock, limits);
    Roughing work{job, operation, std::move(tools), stock, std::move(plan), limits.most, {}, {},
                  0,   0};
    clear_layers(work);
    std::vector<PlannedOperation> out = write_groups(work);
    job.report_progress(1);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    report(work, out, spent.count());
    return out;
}

}  // namespace cusp::host
