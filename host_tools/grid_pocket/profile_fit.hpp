// Few straight moves through a band of heights along a straight run seen from above.
#pragma once

#include <vector>

namespace cusp::grid_pocket {

// Where the tip may be at one place of the run.
struct BandPoint {
    double s{};    // mm along the run, ascending
    double low{};  // heights, low <= high
    double high{};
};

struct ProfilePoint {
    double s{};
    double z{};
};

// A chain of chords from the first place to the last that stays in the band at every place: each
// chord reaches as far as some straight line from its start can. Heights at chord ends are the
// nearest to the middle of the band that the chord allows. Starts at `z`, which must lie in the
// band. O(n).
std::vector<ProfilePoint> fit_chords(const std::vector<BandPoint>& band, double z);

}  // namespace cusp::grid_pocket
