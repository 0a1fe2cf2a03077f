// A quick answer to whether a ball gets lower over a place of a mesh than what passes leave there:
// mostly none does where the ball can't touch the place, and the search for the lowest is spared.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "host_tools/finishing/gouge_free_path.hpp"

namespace cusp::finishing {

// Contacts of a ball dropped on a grid, made where first needed, block directions
// (`ApproachDirections`); all directions are parted round the one that the lowest ball known comes
// from, since only near that one contacts bar little more than they have to.
//
// Not for use by two threads at once.
class LowerPositionProof {
public:
    // path_fitter  passes over a mesh
    // pitch      mm, of the grid
    LowerPositionProof(const GougeFreePathFitter& path_fitter, double pitch);

    enum class Verdict : std::uint8_t { kNone, kOne, kUnknown };
    // Whether a free ball passes through the point or straight below it; both answers are proved.
    //
    // centre  of a ball that passes straight above the point, not much higher
    Verdict verdict_over(Vec3d point, Vec3d centre);

private:
    static constexpr std::int64_t kSide = 4;  // places of the grid, each way
    using Block = std::vector<Vec3d>;         // what its places' contacts are, each once

    const Block& block(std::int64_t i, std::int64_t j);

    const GougeFreePathFitter& path_fitter_;
    double pitch_;
    double radius_;
    double contact_radius_;  // mm: of a ball that touches what the tool keeps `offset` off
    std::unordered_map<std::uint64_t, Block> blocks_;
};

}  // namespace cusp::finishing
