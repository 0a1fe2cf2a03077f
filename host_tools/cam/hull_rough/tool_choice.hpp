// The choice of a cutter for each layer (future work in Chuang & Pan).
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
    double seconds_with_one{};          // with the best single cutter; kInfinite if there is none
};

// Chooses by least time, tool changes included. A cutter is fit for a layer if it clears at least
// `kLeastShare` of the area that the best one clears there.
//
// offers  layers x cutters; not empty
constexpr double kLeastShare = 0.99;
ToolChoice choose_tools(const std::vector<std::vector<ToolOffer>>& offers, double change_seconds);

}  // namespace cusp::hull_rough
