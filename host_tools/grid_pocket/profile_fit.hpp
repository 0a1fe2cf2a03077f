// Few straight moves through a band of heights along a straight run seen from above.
#pragma once

#include <vector>

namespace cusp::host {

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

// A line or an arc of the profile; it starts where the one before ends.
struct ProfilePiece {
    ProfilePoint end;
    double curvature{};   // 1/mm; > 0 bends to the left of the travel, 0 is a line
    ProfilePoint centre;  // of an arc
};

// Arcs and lines from the first place to the last that stay in the band at every place: each
// reaches as far as some arc through its start and the middle of the band at its end can. The
// curvatures that pass a place within the band lie between those of the two circles through its
// ends, so no search is needed. Arcs flatter than `max_radius` (mm) are left out.
//
// O(n log n). Source: Choi, Cho & Kim, section 3.5, whose arc goes through the middle point and
// backs off one point at a time.
std::vector<ProfilePiece> fit_arcs(const std::vector<BandPoint>& band, double z, double max_radius);

}  // namespace cusp::host
