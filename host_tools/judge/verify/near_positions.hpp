// The part of a run that reaches a piece of the stock: the tool is lifted over what is left out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host_tools/judge/verify/tool_positions.hpp"

namespace cusp::verify {

// The place of a lifted position.
inline constexpr std::size_t kNoPlace = SIZE_MAX;

struct NearPositions {
    ToolPositions positions;
    std::vector<std::size_t> places;  // in the run, of each position
};

// The positions of a run at `places`, which rise. Where two do not follow each other the tool goes up to z `high`
// over the one and comes down over the other: a part of the move that is left out there.
NearPositions near_positions(const ToolPositions& run,
                             const std::vector<std::size_t>& places,
                             double high);

}  // namespace cusp::verify
