// The fewest lines and arcs through the bands of a row of stations.
#pragma once

#include <vector>

#include "host_tools/cam/cl_path/cl_path.hpp"

namespace cusp::cl_path {

// A point of the plan path with the lowest height of the tip there.
struct Station {
    Vec2d at;
    double height;
    Vec2d gradient;  // of the floor, dz/dx and dz/dy
    double bend{};   // curvature of the plan path from the last station, 1/mm, > 0 to the left
    bool exact{};    // a move ends here, in the middle of the band
    bool level{};    // moves pass it at its height, without a band
};

// Distance within which moves may pass a station.
struct StationBand {
    double plan_tolerance;  // mm: in plan, to either side
    double low;             // mm above the station's height
    double high;

    double middle() const { return 0.5 * (low + high); }
    double low_at(const Station& s) const { return s.level ? 0.0 : low; }
    double high_at(const Station& s) const { return s.level ? 0.0 : high; }
    double middle_at(const Station& s) const { return s.level ? 0.0 : middle(); }
};

struct Chain {
    Vec3d start;
    std::vector<ClMove> moves;
};

// Takes the longest move from station to station that passes all stations within the band. A
// straight move is chosen among all lines through the stations' bands (a wedge that narrows from
// station to station), not only those between stations. O(n) for lines.
//
// closed  the last station is the first, and the chain ends at its start
Chain chain_through(const std::vector<Station>& stations,
                    const StationBand& band,
                    bool arcs,
                    bool closed);

}  // namespace cusp::cl_path
