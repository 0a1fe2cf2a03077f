// What a curve or surface must fulfil before anything here computes with it.
#pragma once

#include <string>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::import {

// Coordinates beyond this, in mm, are refused: no machine is that large, and doubles keep
// nanometres up to there.
inline constexpr double kLargestCoordinate = 1e6;

// Of the largest weight over the smallest: what is beyond is a corner, for which there are knots.
inline constexpr double kLargestWeightRatio = 1000;

// Of the length of a domain, and one over it the least.
inline constexpr double kLargestDomain = 1e9;

// Knots that differ by rounding only (1e-15 of the whole) become the same.
void merge_close_knots(std::vector<double>& knots);

// Both throw InputError that starts with `place` (file and which curve or surface) and names the
// quantity, its value and its limit.
void check_curve(const nurbs::Curve& curve, const std::string& place);
void check_surface(const nurbs::Surface& surface, const std::string& place);

}  // namespace cusp::import
