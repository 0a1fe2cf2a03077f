// Jobs of one-line calls with a solid: `cusp plan bracket.step --tool flat:10 drill:5 ball:6 --scallop 0.05`.
#pragma once

#include <optional>

#include "host_tools/job/import/one_line_choice.hpp"

namespace cusp::import {

// The 2.5-D operations of a solid, beside those that finish its slanted ground.
struct SolidCuts {
    std::string before;             // tables of operations: the face, the holes
    std::string after;              // likewise: the walls, or all levels where nothing else is cut
    std::vector<std::string> said;  // in words
    bool is_all{};                  // no other operation is needed
    std::string stock;              // keys of [stock] that they need
};

// True if the call has one model or mesh, a flat end or a drill, and nothing that asks for another way.
bool is_solid_request(const OneLineRequest& request);

// Holes that fit a drill are drilled. If all ground is level, or no ball is given, flat ends clear the part level
// by level, walls included. Else they finish its upright walls, after a ball has finished the slanted ground.
//
// choice  tools and unit of the whole request
//
// Errors: InputError that names the option or the file.
SolidCuts solid_cuts(const OneLineRequest& request,
                     const OneLineChoice& choice,
                     const job::Strategies& strategies,
                     PartFiles& parts);

}  // namespace cusp::import
