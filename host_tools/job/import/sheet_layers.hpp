// The operation that cuts a layer of a drawing: as an option says, or by the layer's name.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/job/job/strategy.hpp"

namespace cusp::import {

// Lengths in the unit of the request.
struct LayerUse {
    std::string layer;
    std::string word;                   // of the operation, as in the option
    std::optional<job::Region> region;  // of its strategy; none: left out
    bool only_fitting{};                // of holes: those that fit no drill are cut inside
    std::string side;                   // of a profile; "": as the request says
    std::optional<double> depth;        // of a chamfer its width
    bool by_name{};                     // not asked for
    bool isolates{};                    // cuts around copper, no deeper than it is thick
};

// The strategy that cuts the region along a drawing; where there are several, the one that can take a part of it
// (the key `loops`). Precondition: there is one.
const job::Strategy& strategy_for(job::Region region, const job::Strategies& strategies);

// text  NAME=OPERATION or NAME=OPERATION:DEPTH; the operation a 2.5-D strategy, or outside, inside,
//       on (sides of a profile), none
//
// Errors: InputError with the text and the operations that there are.
LayerUse layer_use_of_text(const std::string& text, const job::Strategies& strategies);

// By words of its name, such as "Pockets 4mm", "holes", "text"; nothing where they say nothing.
std::optional<LayerUse> layer_use_of_name(const std::string& layer,
                                          const job::Strategies& strategies);

}  // namespace cusp::import
