// Bounds on the bend of a surface around one of its cells, for `MoveClearanceBound`.
#pragma once

#include "host_tools/geometry/part_model/bezier_cell.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"

namespace cusp::part_model {

// The cell, widened by its width on either side up to the next crease, with bounds on metric and
// bend there. `extra_bend` is kInfinite where nothing can be proved: beside poles, where du and dv are
// nearly parallel, or where the cell bends too much.
BezierCell::Surroundings find_surroundings(const PartModel::State& state, const BezierCell& cell);

// True if the whole cell lies within the domain of `box`.
bool lies_in(const BezierCell& cell, const BezierCell::Surroundings& box);

}  // namespace cusp::part_model
