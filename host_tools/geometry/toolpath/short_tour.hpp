// Short tours of places in plan: holes, contours, curves, pockets.
//
//     short_tour(places, {0, 0});                     // indices of the places, in order
//     for (const TourStep& step : short_tour(stops, at)) { ... }  // open curves may be turned around
//     inner_first_tour(starts, outer, {0, 0});        // the holes of a part before its outline
//
// Same input, same tour. Ten thousand places take about a second, twice as many about twice that.
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
// Or-opt among near stops, shaken. Never longer than the nearest-neighbour tour. The way from the last stop to `end`
// counts where there is one; else the tour is open.
//
// Accuracy: 5000 random places within 1.05 of the shortest tour (tests/cli/tours_test.py).
std::vector<TourStep> short_tour(const std::vector<TourStop>& stops,
                                 Vec2d start,
                                 std::optional<Vec2d> end = std::nullopt);

// The same of single places, as their indices.
std::vector<std::size_t> short_tour(const std::vector<Vec2d>& places,
                                    Vec2d start,
                                    std::optional<Vec2d> end = std::nullopt);

// A short tour in which each place comes after all that lie inside it: at first those inside an outermost one right
// before it, then with the exchanges of short_tour() that keep that order.
//
// outer  of each place the one that it lies in directly; none: an outermost one. No cycles.
std::vector<std::size_t> inner_first_tour(const std::vector<Vec2d>& places,
                                          const std::vector<std::optional<std::size_t>>& outer,
                                          Vec2d start);

}  // namespace cusp::toolpath
