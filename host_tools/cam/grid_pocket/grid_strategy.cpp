// The record of grid_pocket.
#include "host_tools/cam/grid_pocket/grid_pocket.hpp"
#include "host_tools/job/job/operation_check.hpp"
#include "host_tools/job/job/operation_keys.hpp"

namespace cusp::grid_pocket {

using job::choice;
using job::KeyValues;
using job::kPositive;
using job::Operation;
using job::Refuse;
using Kind = job::KeyKind;

namespace {

using Axes = std::vector<std::string>;

job::Traits traits()
{
    job::Traits traits;
    traits.bounds_engagement = true;
    return traits;
}

std::any read(const KeyValues& values, const Operation& operation, const Refuse&)
{
    GridKeys keys;
    const auto grid = values.find<std::vector<double>>("grid").value_or(std::vector{0.0});
    keys.grid_x = grid.front();
    keys.grid_y = grid.back();
    for (const auto& axis : values.find<std::vector<std::string>>("zigzag").value_or(Axes{})) {
        keys.zigzag.push_back(axis.front());
    }
    keys.arc_tolerance = values.number("arc_tolerance").value_or(operation.tolerance.floor);
    keys.max_arc_radius = values.get<double>("max_arc_radius");
    keys.max_roughness = values.number("max_roughness");
    return keys;
}

void check(const Operation& operation, const Refuse& refuse)
{
    check_end(operation, refuse);
    need(operation.outline.boundary.has_value(), "boundary", "the loop that bounds the pocket",
         operation, refuse);
    need(grid_keys(operation).grid_x > 0, "grid", "the size of its cells, [gx, gy]", operation,
         refuse);
    check_least_depth(operation, refuse);
    if (operation.passes.max_engagement && !operation.levels.max_depth &&
        operation.levels.layers.empty()) {
        refuse("clearing",
               "\"adaptive\" needs max_depth or layers: without them nothing is roughed");
    }
}

}  // namespace

const job::Strategy kGridPocket{
    "grid_pocket",
    "what a boundary encloses, in cells of a grid, down to a floor of surfaces",
    job::surface_keys(),
    {{"grid", Kind::kMargin, "needed", "size of a cell, `[gx, gy]`", kPositive},
     {"zigzag",
      Kind::kTexts,
      "none",
      "`[\"x\"]`, `[\"y\"]` or both, between the tracks",
      {},
      {"x", "y"}},
     {"arc_tolerance", Kind::kLength, "`floor_tolerance`", "of arcs in place of lines",
      job::kToleranceRange},
     {"max_arc_radius", Kind::kLength, "1000 mm", "of arcs in place of lines", kPositive},
     {"max_roughness", Kind::kLength, "none",
      "a grid that leaves more is refused, and one that does not is named", kPositive},
     choice("clearing",
            {"contour", "adaptive"},
            "`\"adaptive\"`, with `max_depth` or `layers`: passes of bounded engagement",
            "cells")},
    traits(),
    read,
    check,
    plan_grid_pocket};

}  // namespace cusp::grid_pocket
