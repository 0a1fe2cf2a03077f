// A quick answer to whether a ball gets lower over a place of a mesh than what passes leave there:
// mostly none does where the ball can't touch the place, and the search for the lowest is spared.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "host_tools/surface_passes/certified_pass.hpp"

namespace cusp::host {

// Contacts of a ball that is let down on a grid, made where first asked for, bar directions
// (`BallDirections`); all directions are parted round the one that the lowest ball known comes
// from, since only near that one contacts bar little more than they have to.
//
// Not for use by two threads at once.
class LowerBall {
public:
    // certified  passes over a mesh
    // pitch      mm, of the grid
    LowerBall(const CertifiedPasses& certified, double pitch);

    enum class Answer : std::uint8_t { kNone, kOne, kUnknown };
    // Whether a free ball passes through the point or straight below it; both answers are proved.
    //
    // centre  of a ball that passes straight above the point, not much higher
    Answer over(Vec3d point, Vec3d centre);

private:
    static constexpr std::int64_t kSide = 4;  // places of the grid, each way
    using Block = std::vector<Vec3d>;         // what its places' contacts are, each once

    const Block& block(std::int64_t i, std::int64_t j);

    const CertifiedPasses& certified_;
    double pitch_;
    double radius_;
    double contact_radius_;  // mm: of a ball that touches what the tool stays `lift` off
    std::unordered_map<std::uint64_t, Block> blocks_;
};

}  // namespace cusp::host
