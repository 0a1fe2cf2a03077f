// Work shared out among threads by place: a search keeps what it has found nearby, so neighbours
// belong to one.
//
//     for (const auto& share : shares_of_neighbours(middles, 32)) { ... }  // numbers of middles
#pragma once

#include <cstddef>
#include <vector>

#include "host_tools/geometry/nurbs/plan_vector.hpp"

namespace cusp::finishing {

// The numbers 0 to places.size() - 1 in shares that hardly overlap in plan, each in rising order.
// Their sizes differ by one at most.
//
// places  in plan
// most    >= 1: shares, a power of two; fewer where there are fewer places
std::vector<std::vector<std::size_t>> shares_of_neighbours(const std::vector<Vec2d>& places,
                                                           std::size_t most);

}  // namespace cusp::finishing
