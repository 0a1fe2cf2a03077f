// One roughing operation amid its planning: what slicing, clearing, writing and the report share.
#pragma once

#include <string>
#include <vector>

#include "host_tools/hull_rough/depth_layers.hpp"
#include "host_tools/hull_rough/layer_clearing.hpp"
#include "host_tools/hull_rough/tool_choice.hpp"
#include "host_tools/job/job.hpp"
#include "host_tools/toolpath/toolpath.hpp"

namespace cusp::hull_rough {

// Chords on rounded corners keep this much, mm, so that G-code rounded to a micrometre still does.
constexpr double kLeastTolerance = 2e-3;

// Of the height of ridges, with several cutters: what one may leave where another has been.
constexpr double kRestShare = 0.25;

struct StockBox {
    Rectangle plan;
    double top;
    double bottom;
};

// Everything about one operation that its steps share.
struct Roughing {
    const job::Job& job;
    const job::Operation& operation;
    std::vector<toolpath::Tool> tools;  // largest first
    StockBox stock;
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
                           [](const toolpath::Tool& t) { return t.corner_radius > 0; });
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

// How the cutter clears the layer: steps that leave no higher ridges than the layer may have.
LayerSettings layer_settings(const Roughing& work, std::size_t layer, const toolpath::Tool& tool);

// Writes all layers with the cutters chosen: one result for each run of layers with the same
// cutter.
std::vector<toolpath::PlannedOperation> write_layers(const Roughing& work);

// Adds the statistics, warnings and comments to all results. seconds: that planning took.
void add_report(const Roughing& work, std::vector<toolpath::PlannedOperation>& out, double seconds);

// A number for people, without idle zeros.
std::string plain_number(double value);

}  // namespace cusp::hull_rough
