// The report of a plan: counts of the paper, bounds, and stock left.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/hull_rough/hull_rough.hpp"
#include "host_tools/cam/hull_rough/roughing.hpp"

namespace cusp::hull_rough {

using job::EntryKind;
using toolpath::OperationStats;
using toolpath::PlannedOperation;
using toolpath::Tool;

namespace {

// Adds the largest engagement of the cutter: depth, width, and entries.
void add_engagement(const Roughing& work, PlannedOperation& operation)
{
    const Tool& tool = operation.path.tool;
    double step = 0;
    for (std::size_t layer = 0; layer < work.layers(); ++layer) {
        step = std::max(step, layer_settings(work, layer, tool).step);
    }
    const double degrees = elementary::acos(std::max(-1.0, 1 - step / tool.radius)) * 180 / kPi;
    OperationStats& stats = operation.stats;
    if (work.operation.passes.max_engagement) {
        stats.warnings.push_back("cuts are at most " + plain_number(work.deepest_cut()) +
                                 " mm deep; entries descend as a helix where there is room");
        return;
    }
    stats.counts.emplace_back("engagement_deg", 180);
    stats.counts.emplace_back("step_mm", step);
    stats.counts.emplace_back("step_engagement_deg", degrees);
    stats.counts.emplace_back("entry_deg",
                              work.operation.passes.entry == EntryKind::kPlunge ? 90 : 3);
    stats.warnings.push_back(
        "cuts are at most " + plain_number(work.deepest_cut()) +
        " mm deep; first passes, necks and corners are cut at "
        "the full width of " +
        plain_number(2 * tool.radius) + " mm (180 degrees), straight passes beside " +
        "another at " + plain_number(step) + " mm (" + plain_number(std::round(degrees)) +
        " degrees); " +
        (work.operation.passes.entry == EntryKind::kPlunge ? "entries plunge"
                                                           : "entries descend at up to 3 degrees"));
}

// Figures of all layers.
struct LayerFigures {
    double thinnest{kUnbounded};  // mm
    double thickest{};
    int islands{};
    int zigzags{};      // layers cleared by zigzag
    double closed{};    // mm^2, LayerClearing::closed_area
    double left{};      // mm^2 that no run clears
    std::string place;  // the first such spot
};

LayerFigures layer_figures(const Roughing& work)
{
    LayerFigures sums;
    for (std::size_t layer = 0; layer < work.layers(); ++layer) {
        sums.thinnest = std::min(sums.thinnest, work.thickness(layer));
        sums.thickest = std::max(sums.thickest, work.thickness(layer));
        const LayerClearing& clearing = work.clearings[layer][work.choice.of_layer[layer]];
        sums.islands += clearing.islands;
        sums.zigzags += clearing.by_contours || clearing.adaptive ? 0 : 1;
        sums.closed += clearing.closed_area;
        if (sums.left <= 0 && clearing.left.area > 0) {
            const Rectangle& spot = clearing.left.squares.front();
            sums.place = "x " + plain_number((spot.x_min + spot.x_max) / 2) + ", y " +
                         plain_number((spot.y_min + spot.y_max) / 2) + ", z " +
                         plain_number(work.bottom(layer)) + " mm";
        }
        sums.left += clearing.left.area;
    }
    return sums;
}

}  // namespace

std::string plain_number(double value)
{
    constexpr double kLeast = 1e-3;
    if (value != 0 && std::abs(value) < kLeast) {
        std::array<char, 32> digits{};
        std::snprintf(digits.data(), digits.size(), "%g", value);
        return digits.data();
    }
    std::string out = std::to_string(value);
    out.erase(out.find_last_not_of('0') + 1);
    return out.back() == '.' ? out + '0' : out;
}

void add_report(const Roughing& work, std::vector<PlannedOperation>& out, double seconds)
{
    const LayerFigures layers = layer_figures(work);
    const Rectangle& plan = work.stock.plan;
    const double volume = (plan.x_max - plan.x_min) * (plan.y_max - plan.y_min) *
                          (work.stock.top - work.plan.planes.back());
    // There is no comparison if no cutter clears every layer alone.
    const double saved = std::isfinite(work.choice.seconds_with_one)
                             ? work.choice.seconds_with_one - work.choice.seconds
                             : 0.0;
    for (PlannedOperation& operation : out) {
        OperationStats& stats = operation.stats;
        stats.strategy = work.operation.name();
        stats.roughing = true;
        stats.gouge_bound_mm = 0;
        // Hulls bound what is cut, not what is left: the only bound of that is the stock's height.
        stats.scallop_bound_mm = work.stock.top - work.plan.planes.back();
        stats.planning_s = seconds / static_cast<double>(out.size());
        const std::vector<std::pair<std::string, double>> written = std::move(stats.counts);
        stats.counts = {{"layers", static_cast<double>(work.layers())},
                        {"raw_layers", work.plan.raw_layers},
                        {"split_layers", work.plan.split_layers},
                        {"thinnest_layer_mm", layers.thinnest},
                        {"thickest_layer_mm", layers.thickest},
                        {"patches", static_cast<double>(work.plan.patches.size())},
                        {"boxes", static_cast<double>(work.boxes)},
                        {"islands", layers.islands},
                        {"zigzag_layers", layers.zigzags},
                        {"stock_mm3", volume},
                        {"left_under_boxes_mm3", work.left_under_boxes},
                        {"tool_changes", work.choice.changes},
                        {"seconds_saved_by_tools", saved},
                        {"deepest_cut_mm", work.deepest_cut()},
                        {"closed_mm2", layers.closed},
                        {"left_mm2", layers.left}};
        stats.counts.insert(stats.counts.end(), written.begin(), written.end());
        add_engagement(work, operation);
        if (hull_keys(work.operation).contour_clearing && layers.zigzags > 0) {
            stats.warnings.push_back(std::to_string(layers.zigzags) +
                                     " layers are cleared by zigzag: loops parallel to their "
                                     "islands would have too little clearance");
        }
        if (layers.left > 0) {
            stats.warnings.push_back(plain_number(layers.left) +
                                     " mm2 of layers are left uncleared, first at " + layers.place);
        }
        // Each comment fits in one line of G-code.
        operation.path.comments = {
            "hull_rough: " + std::to_string(work.layers()) +
                (work.layers() == 1 ? " layer of " : " layers of ") +
                plain_number(layers.thinnest) + " to " + plain_number(layers.thickest) + " mm",
            "no overcut by the hulls of " + std::to_string(work.plan.patches.size()) + " patches",
            "cuts at most " + plain_number(work.deepest_cut()) + " mm deep"};
    }
}

}  // namespace cusp::hull_rough
