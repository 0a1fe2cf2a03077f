// Passes along the feet of cliffs and creases of a floor: loops that cross them askew leave metal
// between each other there.
#pragma once

#include <vector>

#include "host_tools/clearing/clearing.hpp"
#include "host_tools/clearing/tip_floor.hpp"
#include "host_tools/contour_pocket/floor_path.hpp"

namespace cusp::host {

struct CliffSettings {
    double first{};  // mm: least distance of the tool's axis from the contours
    double most{};   // mm: what may stay over the best that the tool reaches
    double off{};    // mm: how far beside a jump passes run at least
    // Short lines are followed whatever they leave: else only where long ones leave more than
    // `most`.
    bool fragments{true};
    FloorPathSettings laying;  // of passes; chords of a line keep within a third of its `aside`
};

// Open and closed passes, all PassStart::kDrop. Where the height of the tip jumps, along all of the
// low side, `off` from the jump, or up to four times as far where a pass can not be laid low
// otherwise; where only its slope turns up, along what the tool takes more than `most` off what the
// given passes leave, square to the floor: looked at every tenth of the tool's radius.
std::vector<ClearingPass> cliff_passes(const Region2d& region,
                                       const TipFloor& floor,
                                       const ClearedRegion& cleared,
                                       const CliffSettings& settings);

}  // namespace cusp::host
