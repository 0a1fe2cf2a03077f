// Which cutter clears which layer: Chuang & Pan's second piece of future work.
#pragma once

#include <cstddef>
#include <vector>

namespace cusp::hull_rough {

struct ToolOffer {
    double seconds{};       // to clear the layer
    double cleared_area{};  // mm^2
};

struct ToolChoice {
    std::vector<std::size_t> of_layer;  // index of the cutter for each layer
    int changes{};                      // between layers; the first cutter is not one
    double seconds{};                   // of clearing and changes
    double seconds_with_one{};          // with the one cutter that does best alone
};

// Chooses by least time, changes included. A cutter is fit for a layer when it clears at least
// `kLeastShare` of what the best one clears there.
//
//   offers  layers x cutters; not empty
constexpr double kLeastShare = 0.99;
ToolChoice choose_tools(const std::vector<std::vector<ToolOffer>>& offers, double change_seconds);

}  // namespace cusp::hull_rough
