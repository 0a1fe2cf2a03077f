// Parts of loops between two rings: where a part of a ring needs its neighbour nearer than the
// rest, only that part is repeated (as the partial isocurves of Elber & Cohen 1993).
#pragma once

#include <vector>

#include "host_tools/cam/clearing/clearing.hpp"

namespace cusp::clearing {

// The stretches of a ring at `distance` (mm) from the contours that lie straight inward from a
// point no farther than `margin` (mm) from `feet` on the ring at `outer`. Stretches longer than
// half of their loop become the whole loop.
std::vector<PartialLoop> loops_over(const std::vector<offset::Edge>& feet,
                                    const offset::RegionOffset& walls,
                                    double outer,
                                    double distance,
                                    double margin);

// mm: path length of partial loops, detours included.
double added_length(const std::vector<PartialLoop>& loops);

// mm: path length of all passes and partial loops.
double length(const ClearedRegion& cleared);

// Inserts the partial loops into their passes. Each is a detour straight inward from the loop
// outside it, along it in the direction of loops, and back over material already cut. Loops stay
// closed and in their order.
void put_in_partial_loops(ClearedRegion& cleared);

// Leaves the paths of passes unchanged: their final_path contains the partial loops.
void end_with_partial_loops(ClearedRegion& cleared);

}  // namespace cusp::clearing
