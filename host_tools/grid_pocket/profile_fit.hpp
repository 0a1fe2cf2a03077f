// Few straight moves through a band of heights along a straight run in plan.
#pragma once

#include <vector>

namespace cusp::grid_pocket {

// The range of the tip's height at one sample of the run.
struct BandPoint {
    double s{};    // mm along the run, ascending
    double low{};  // heights, low <= high
    double high{};
};

struct ProfilePoint {
    double s{};
    double z{};
};

// A chain of chords from the first sample to the last that stays in the band at every sample. Each
// chord is as long as some straight line from its start allows. Its end is as near to the middle of
// the band as the chord allows. O(n).
//
// z  height of the start, in the band
std::vector<ProfilePoint> fit_chords(const std::vector<BandPoint>& band, double z);

}  // namespace cusp::grid_pocket
