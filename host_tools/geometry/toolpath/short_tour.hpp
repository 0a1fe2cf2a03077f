// Short tours of places in plan: holes, contours, curves, pockets.
//
//     short_tour(places, {0, 0});                     // indices of the places, in order
//     for (const TourStep& step : short_tour(stops, at)) { ... }  // open curves may be turned around
//     inner_first_tour(starts, outer, {0, 0});        // the holes of a part before its outline
//
// Same input, same tour. Ten thousand places take about a second.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/plan_vector.hpp"

namespace cusp::toolpath {

// A path that is cut in one go, from either end if the ends differ.
struct TourStop {
    Vec2d begin;
    Vec2d end;
};

struct TourStep {
    std::size_t stop;
    bool turned;  // from its end to its begin
};

// The order in which to visit the stops, each once: nearest neighbour from `start`, then 2-opt and
// Or-opt among near stops. Never longer than the nearest-neighbour tour. The tour is open: it does not
// return to its start.
std::vector<TourStep> short_tour(const std::vector<TourStop>& stops, Vec2d start);

// The same of single places, as their indices.
std::vector<std::size_t> short_tour(const std::vector<Vec2d>& places, Vec2d start);

// A short tour in which each place comes after all that lie inside it. Paths inside an outermost
// one are visited right before it.
//
// outer  of each place the one that it lies in directly; none: an outermost one. No cycles.
std::vector<std::size_t> inner_first_tour(const std::vector<Vec2d>& places,
                                          const std::vector<std::optional<std::size_t>>& outer,
                                          Vec2d start);

}  // namespace cusp::toolpath
