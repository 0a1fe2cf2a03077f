// Groups the curves of a drawing into closed loops, nested in each other, and open chains.
#pragma once

#include <string>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/import/drawn_shapes.hpp"
#include "host_tools/job/job/part_geometry.hpp"

namespace cusp::import {

// mm: largest distance of ends that meet.
inline constexpr double kEndsMeet = 1e-3;
// mm: the least largest gap that is joined by default.
inline constexpr double kJoinTolerance = 0.02;
// mm: the greatest.
inline constexpr double kWidestJoin = 0.1;

// The largest gap that is joined by default, mm: ends that are both rounded to the last decimal place of a
// drawing meet.
//
// resolution  mm: of that place; 0: none
double join_limit(double resolution);

// Closed paths are loops as they are, even where they have edges in common. All other curves meet
// where their ends are within 1e-3 mm, as join_chains() joins them. Remaining open chains are
// joined where their ends are at most `join` mm apart, the nearest first. Lengths and areas are
// integrals over the curves, with a relative error of 1e-9 for arcs of up to a quarter turn for
// each span.
job::LoopNesting nest_loops(const std::vector<DrawingPath>& paths, double join = kJoinTolerance);
job::LoopNesting nest_loops(const std::vector<nurbs::Curve>& curves, double join = kJoinTolerance);

// The curves without those that lie on an earlier one, either way round, to 1e-4 mm at ends and middle.
//
// repeated  grows by the number of those left out
std::vector<nurbs::Curve> without_repeats(const std::vector<nurbs::Curve>& curves,
                                          std::size_t& repeated);

// "plate.dxf#text: 2 curves are drawn twice and taken once"
std::string repeats_text(const std::string& name, std::size_t repeated);

}  // namespace cusp::import
