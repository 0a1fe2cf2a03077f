// A short tour of places.
#pragma once

#include <cstddef>
#include <vector>

#include "host_tools/nurbs/plan_vector.hpp"

namespace cusp::prismatic {

// The order in which to visit the places, each once: nearest neighbour from `start`, then 2-opt.
// Never longer than the nearest-neighbour tour. Over 2000 places 2-opt is left out.
std::vector<std::size_t> short_tour(const std::vector<Vec2d>& places, Vec2d start);

}  // namespace cusp::prismatic
