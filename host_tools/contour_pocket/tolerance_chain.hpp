// The fewest lines and arcs through a band about a row of stations.
#pragma once

#include <vector>

#include "host_tools/contour_pocket/cl_path.hpp"

namespace cusp::contour_pocket {

// A place on the plan path with the lowest height of the tip there.
struct Station {
    Vec2d at;
    double height;
    Vec2d gradient;  // of the floor, dz/dx and dz/dy
    double bend{};   // of the plan path from the station before, 1/mm, > 0 to the left
    bool exact{};    // a move ends here, at half of the band
};

// How far from a station moves may pass it.
struct StationBand {
    double plan_tolerance;  // mm: in plan, either way
    double low;             // mm over the station's height
    double high;

    double middle() const { return 0.5 * (low + high); }
};

struct Chain {
    Vec3d start;
    std::vector<ClMove> moves;
};

// Goes from station to station by the longest move that passes every station within the band: a
// straight move is looked for among all that the stations' bands let through (a wedge that narrows
// from station to station), not only between stations. O(n) for lines. closed: the last station is
// the first, and the chain ends where it starts.
Chain chain_through(const std::vector<Station>& stations,
                    const StationBand& band,
                    bool arcs,
                    bool closed);

}  // namespace cusp::contour_pocket
