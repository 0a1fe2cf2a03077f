// Pieces of loops between two levels: where a part of a level needs its neighbour nearer than the
// rest, only that part is gone over once more (as the partial isocurves of Elber & Cohen 1993).
#pragma once

#include <vector>

#include "host_tools/clearing/clearing.hpp"

namespace cusp::clearing {

// The stretches of a level at `distance` (mm) from the contours that lie straight inward from a
// place no farther than `margin` (mm) from `feet` on the level at `outer`. Stretches that are
// longer than half of their loop become the whole loop.
std::vector<PartialLoop> loops_over(const std::vector<offset::Edge>& feet,
                                    const offset::RegionOffset& walls,
                                    double outer,
                                    double distance,
                                    double margin);

// mm of path that partial loops make, ways there and back included.
double added_length(const std::vector<PartialLoop>& loops);

// mm of path of all passes and partial loops.
double length(const ClearedRegion& cleared);

// Puts the partial loops into their passes: each is a way straight inward from the loop that it
// refines, along it the way that loops run, and back over what is cut. Loops stay closed and in
// their order.
void put_in_partial_loops(ClearedRegion& cleared);

// Leaves the passes' paths as they are: ClearingPass::last has the partial loops put in.
void end_with_partial_loops(ClearedRegion& cleared);

}  // namespace cusp::clearing
