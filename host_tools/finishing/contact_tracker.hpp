// A ball dropped at neighbouring places: its contact is followed over the surface, and proved
// to be the only one; the search over the whole model is for where that fails.
#pragma once

#include <optional>

#include "host_tools/finishing/gouge_free_path.hpp"

namespace cusp::finishing {

// Not for use by two threads at once.
class ContactTracker {
public:
    explicit ContactTracker(const GougeFreePathFitter& path_fitter) : path_fitter_{path_fitter} {}

    struct BallPosition {
        Vec3d tip;
        CcParameters contact;
        // Cosine between the way to the centre and the surface's normal where it rests: less than 1
        // where the ball leans over a rim or a crease.
        double facing{1};
    };

    // As `GougeFreePathFitter::dropped`, with the foot where the ball touches one smooth place
    // only. Places beside the last one are quickest.
    std::optional<BallPosition> at(double x, double y);

private:
    std::optional<BallPosition> beside(double x, double y);

    const GougeFreePathFitter& path_fitter_;
    CcParameters last_;
};

}  // namespace cusp::finishing
