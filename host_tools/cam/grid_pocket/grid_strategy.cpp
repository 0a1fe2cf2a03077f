// The record of grid_pocket.
#include "host_tools/cam/grid_pocket/grid_pocket.hpp"
#include "host_tools/job/job/operation_check.hpp"
#include "host_tools/job/job/operation_keys.hpp"

namespace cusp::grid_pocket {

using job::kPositive;
using job::Operation;
using job::Refuse;
using Kind = job::KeyKind;

namespace {

void check(const Operation& operation, const Refuse& refuse)
{
    check_end(operation, refuse);
    need(operation.boundary.has_value(), "boundary", "the loop that bounds the pocket", operation,
         refuse);
    need(operation.grid_x > 0, "grid", "the size of its cells, [gx, gy]", operation, refuse);
    check_least_depth(operation, refuse);
    if (operation.max_engagement && !operation.max_depth && operation.layers.empty()) {
        refuse("clearing",
               "\"adaptive\" needs max_depth or layers: without them nothing is roughed");
    }
}

}  // namespace

const job::Strategy kGridPocket{
    "grid_pocket",
    "what a boundary encloses, in cells of a grid, down to a floor of surfaces",
    job::surface_keys(),
    {{"grid", Kind::kLengths, "needed", "size of a cell, `[gx, gy]`", kPositive},
     {"zigzag", Kind::kFiles, "none", "`[\"x\"]`, `[\"y\"]` or both, between the tracks"},
     {"arc_tolerance", Kind::kLength, "`floor_tolerance`", "of arcs in place of lines",
      job::kTolerance},
     {"max_arc_radius", Kind::kLength, "1000 mm", "of arcs in place of lines", kPositive},
     {"max_roughness", Kind::kLength, "none",
      "a grid that leaves more is refused, and one that does not is named", kPositive},
     {"clearing",
      Kind::kChoice,
      "cells",
      "`\"adaptive\"`, with `max_depth` or `layers`: passes of bounded engagement",
      {},
      {"contour", "adaptive"}}},
    {},
    check,
    plan_grid_pocket};

}  // namespace cusp::grid_pocket
