// The range of slopes that keep a line from the chord's start inside the band narrows with every
// sample.
#include "host_tools/grid_pocket/profile_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "host_tools/nurbs/plan_vector.hpp"

namespace cusp::grid_pocket {

std::vector<ProfilePoint> fit_chords(const std::vector<BandPoint>& band, double z)
{
    std::vector<ProfilePoint> out{{band.front().s, z}};
    for (std::size_t start = 0; start + 1 < band.size();) {
        const ProfilePoint from = out.back();
        double least = -kUnbounded;
        double most = kUnbounded;
        std::size_t reached = start;
        double slope = 0;
        for (std::size_t i = start + 1; i < band.size(); ++i) {
            const double way = band[i].s - from.s;
            const double lowest = std::max(least, (band[i].low - from.z) / way);
            const double highest = std::min(most, (band[i].high - from.z) / way);
            if (lowest > highest) {
                break;
            }
            least = lowest;
            most = highest;
            const double middle = ((band[i].low + band[i].high) / 2 - from.z) / way;
            slope = std::clamp(middle, least, most);
            reached = i;
        }
        out.push_back({band[reached].s, from.z + slope * (band[reached].s - from.s)});
        start = reached;
    }
    return out;
}

}  // namespace cusp::grid_pocket
