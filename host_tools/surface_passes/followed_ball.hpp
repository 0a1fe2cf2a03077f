// A ball let down at places beside each other: its contact is followed over the surface, and proved
// to be the only one; the search over the whole model is for where that fails.
#pragma once

#include <optional>

#include "host_tools/surface_passes/certified_pass.hpp"

namespace cusp::host {

// Not for use by two threads at once.
class FollowedBall {
public:
    explicit FollowedBall(const CertifiedPasses& certified) : certified_{certified} {}

    struct Stand {
        Vec3d tip;
        Foot foot;
        // Cosine between the way to the centre and the surface's normal where it rests: less than 1
        // where the ball leans over a rim or a crease.
        double facing{1};
    };

    // As `CertifiedPasses::dropped`, with the foot where the ball touches one smooth place only.
    // Places beside the last one are quickest.
    std::optional<Stand> at(double x, double y);

private:
    std::optional<Stand> beside(double x, double y);

    const CertifiedPasses& certified_;
    Foot last_;
};

}  // namespace cusp::host
