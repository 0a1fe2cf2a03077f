// The state of one roughing operation during planning, common to its steps.
#pragma once

#include <string>
#include <vector>

#include "host_tools/cam/hull_rough/depth_layers.hpp"
#include "host_tools/cam/hull_rough/layer_clearing.hpp"
#include "host_tools/cam/hull_rough/tool_choice.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::hull_rough {

// mm: least tolerance of chords on rounded corners, for G-code rounded to a micrometre.
constexpr double kLeastTolerance = 2e-3;

// Share of the scallop height, with several cutters: what one may leave where another has been.
constexpr double kRestShare = 0.25;

struct StockBox {
    Rectangle plan;
    double top;
    double bottom;
};

// Filled step by step: layers, clearings, choice of cutters.
struct Roughing {
    const job::Job& job;
    const job::Operation& operation;
    std::vector<toolpath::Tool> tools;  // largest first
    StockBox stock;
    LayerPlan plan;
    double most_depth;                                  // mm: limit of a layer's thickness
    std::vector<std::vector<LayerClearing>> clearings;  // layers x tools
    ToolChoice choice;
    double left_under_boxes{};  // mm^3 of stock inside the boxes
    std::size_t boxes{};

    double top(std::size_t layer) const { return plan.planes[layer]; }
    double bottom(std::size_t layer) const { return plan.planes[layer + 1]; }
    std::size_t layers() const { return plan.planes.size() - 1; }
    double thickness(std::size_t layer) const { return top(layer) - bottom(layer); }

    // mm: the allowed scallop height of a layer. The next layer cuts the scallops in addition to
    // its own depth, together within the limit unless they would be less than a tenth of it.
    double scallop_height(std::size_t layer) const
    {
        const double next = layer + 1 < layers() ? thickness(layer + 1) : 0.0;
        return std::min(thickness(layer) / 4, std::max(most_depth - next, most_depth / 10));
    }

    // True if some tool has a corner radius.
    bool round() const
    {
        return std::any_of(tools.begin(), tools.end(),
                           [](const toolpath::Tool& t) { return t.corner_radius > 0; });
    }

    // mm: the part of the scallop height that one cutter may leave where another has cleared; the
    // other part is for scallops between the lines of each cutter.
    double rest_height(std::size_t layer) const
    {
        return tools.size() > 1 ? kRestShare * scallop_height(layer) : 0.0;
    }

    // mm: the height of stock left over the bottom of a cleared layer.
    double left_over(std::size_t layer) const { return round() ? scallop_height(layer) : 0.0; }

    double deepest_cut() const
    {
        double deepest = thickness(0);
        for (std::size_t layer = 1; layer < layers(); ++layer) {
            deepest = std::max(deepest, thickness(layer) + left_over(layer - 1));
        }
        return deepest;
    }
};

// Settings with a stepover that leaves at most the allowed scallop height.
LayerSettings layer_settings(const Roughing& work, std::size_t layer, const toolpath::Tool& tool);

// Writes all layers with the chosen cutters: one result for each run of layers with the same
// cutter.
std::vector<toolpath::PlannedOperation> write_layers(const Roughing& work);

// Adds statistics, warnings and comments to all results.
//
// seconds  time of planning
void add_report(const Roughing& work, std::vector<toolpath::PlannedOperation>& out, double seconds);

// A number for messages, without trailing zeros.
std::string plain_number(double value);

}  // namespace cusp::hull_rough
