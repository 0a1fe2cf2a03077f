// Grooves beside closed loops, for an engraving: their upper edges run along the loops.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/geometry/toolpath/tool.hpp"
#include "host_tools/job/job/prismatic_keys.hpp"

namespace cusp::import {

struct BesideLoops {
    std::vector<job::Chain> chains;  // the ways of the tip, closed
    double unreached{};  // mm of the loops that no groove runs along: another one is too near
    std::optional<Vec2d> place;  // on the first of these
};

// Accuracy: the ways are away from the loops by half of the cut's width at the depth, within 0.001 mm.
//
// loops   counter-clockwise
// inside  of the loops' material
//
// Errors: InputError: a loop encloses nothing.
BesideLoops beside_loops(const std::vector<job::NestedLoop>& loops,
                         const toolpath::Tool& tool,
                         double depth,
                         bool inside);

}  // namespace cusp::import
