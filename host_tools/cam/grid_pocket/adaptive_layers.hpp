// Layers of bounded engagement: level planes, from the top of the stock to the floor.
//
// They leave an allowance at walls and floor, and on slopes steps as high as a layer. The passes
// along the wall and over the cells take both; stock that they are to take is thick enough for
// AxialDepthTracker to see it, so the limit of the axial depth holds there too.
#pragma once

#include <cstdint>
#include <vector>

#include "host_tools/cam/adaptive_clearing/adaptive_clearing.hpp"
#include "host_tools/cam/grid_pocket/pocket_space.hpp"

namespace cusp::grid_pocket {

struct AdaptiveLayer {
    double above;             // z: stock begins there at most
    double z;                 // of the tip
    offset::Region2d region;  // of the axis
    adaptive_clearing::AdaptivePath path;
};

struct AdaptiveLayers {
    std::vector<AdaptiveLayer> layers;  // from the top down
    double max_engagement{};            // degrees, as asked
    double scallops{};                  // mm: left between passes by a round end
    double clears{};                    // mm: radius that is cleared to the scallops
    double chord{};                     // mm: tolerance of arcs written as lines
};

// Errors: InputError where the job has more than 10000 layers, or one can't be cleared.
AdaptiveLayers adaptive_layers(const PocketSpace& pocket);

enum class LayerReach : std::uint8_t {
    kNone,
    kBeside,  // but for the allowance
    kCut,     // the tip has been there, and nothing over the scallops is left in the cell
};

// The reach of the layer's passes, by cell.
std::vector<LayerReach> reach_of(const AdaptiveLayer& layer,
                                 const AdaptiveLayers& layers,
                                 const PocketSpace& pocket);

}  // namespace cusp::grid_pocket
