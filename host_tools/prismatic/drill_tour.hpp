// A short way through places.
#pragma once

#include <cstddef>
#include <vector>

#include "host_tools/nurbs/plan_vector.hpp"

namespace cusp::prismatic {

// The order in which to visit the places, each once: the nearest next one from `start`, then
// pieces turned around as long as that shortens the way (2-opt). No longer than the nearest-next
// order; for up to 2000 places, beyond that only the nearest next.
std::vector<std::size_t> short_tour(const std::vector<Vec2d>& places, Vec2d start);

}  // namespace cusp::prismatic
