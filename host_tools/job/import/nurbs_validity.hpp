// Conditions that a curve or surface must meet before it is used.
#pragma once

#include <string>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::import {

// Largest coordinate, mm: larger than any machine, and doubles resolve nanometres up to it.
inline constexpr double kLargestCoordinate = 1e6;

// Limit of a drawing before it is moved, mm: as survey coordinates have it. Doubles resolve 2e-6 up
// to it.
inline constexpr double kLargestDrawn = 1e10;

// Limit of the ratio of the largest weight to the smallest. A larger ratio approximates a corner,
// which is to be modelled by a multiple knot.
inline constexpr double kLargestWeightRatio = 1000;

// Greatest length of a domain; its reciprocal is the least.
inline constexpr double kLargestDomain = 1e9;

// Makes knots equal that differ by rounding only (1e-15 of the domain).
void merge_close_knots(std::vector<double>& knots);

// Both throw InputError that starts with `place` (file and which curve or surface) and names the
// quantity, its value and its limit.
//
// largest  mm, of coordinates
void check_curve(const nurbs::Curve& curve,
                 const std::string& place,
                 double largest = kLargestCoordinate);
void check_surface(const nurbs::Surface& surface, const std::string& place);

}  // namespace cusp::import
