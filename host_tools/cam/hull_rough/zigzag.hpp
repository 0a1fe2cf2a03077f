// Continuous zigzag over a clear zone with islands: Chuang & Pan, section 6.
#pragma once

#include <vector>

#include "host_tools/cam/hull_rough/clear_zone.hpp"

namespace cusp::hull_rough {

// A run of the cutter inside the zone: consecutive points are joined by clear straight moves.
using Chain = std::vector<Vec2d>;

struct ZigzagLayout {
    double first_line{};  // y
    double spacing{};     // > 0
    int lines{};
    bool one_way{false};  // every interval is a chain of its own, towards +x
};

// Equally spaced lines, at most `step` apart, that cover y_min to y_max with a cutter that clears a
// width of `step`.
ZigzagLayout zigzag_layout(double y_min, double y_max, double step);

// The intervals of the lines in the zone, joined to chains while a clear path leads to the next
// line. Every interval is in exactly one chain.
std::vector<Chain> zigzag_chains(const ClearZone& zone, const ZigzagLayout& layout);

}  // namespace cusp::hull_rough
