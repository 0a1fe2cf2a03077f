// A shortest path through the layers, with a node for each fit cutter and a cost for each change.
#include "host_tools/cam/hull_rough/tool_choice.hpp"

#include <algorithm>

#include "host_tools/geometry/nurbs/plan_vector.hpp"

namespace cusp::hull_rough {
namespace {

double cost(const std::vector<ToolOffer>& layer, std::size_t tool)
{
    double best = 0;
    for (const ToolOffer& offer : layer) {
        best = std::max(best, offer.cleared_area);
    }
    return layer[tool].cleared_area >= kLeastShare * best ? layer[tool].seconds : kInfinite;
}

}  // namespace

ToolChoice choose_tools(const std::vector<std::vector<ToolOffer>>& offers, double change_seconds)
{
    const std::size_t layers = offers.size();
    const std::size_t tools = offers.front().size();
    std::vector<std::vector<double>> sum(layers, std::vector<double>(tools, kInfinite));
    std::vector<std::vector<std::size_t>> before(layers, std::vector<std::size_t>(tools, 0));
    for (std::size_t layer = 0; layer < layers; ++layer) {
        for (std::size_t tool = 0; tool < tools; ++tool) {
            double best = layer == 0 ? 0 : kInfinite;
            for (std::size_t other = 0; layer > 0 && other < tools; ++other) {
                const double way = sum[layer - 1][other] + (other == tool ? 0 : change_seconds);
                if (way < best) {
                    best = way;
                    before[layer][tool] = other;
                }
            }
            sum[layer][tool] = best + cost(offers[layer], tool);
        }
    }
    ToolChoice choice;
    choice.seconds_with_one = kInfinite;
    for (std::size_t tool = 0; tool < tools; ++tool) {
        double alone = 0;
        for (const auto& layer : offers) {
            alone += cost(layer, tool);
        }
        choice.seconds_with_one = std::min(choice.seconds_with_one, alone);
    }
    const auto least = std::min_element(sum.back().begin(), sum.back().end());
    choice.seconds = *least;
    choice.of_layer.assign(layers, static_cast<std::size_t>(least - sum.back().begin()));
    for (std::size_t layer = layers - 1; layer > 0; --layer) {
        choice.of_layer[layer - 1] = before[layer][choice.of_layer[layer]];
        choice.changes += choice.of_layer[layer - 1] == choice.of_layer[layer] ? 0 : 1;
    }
    return choice;
}

}  // namespace cusp::hull_rough
