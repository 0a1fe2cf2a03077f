// Certificate that no lower position of a ball exists over a point of a mesh. If the ball cannot
// touch the point there is usually none, and the certificate replaces the search for the lowest.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "host_tools/cam/finishing/blocking_facets.hpp"
#include "host_tools/cam/finishing/gouge_free_path.hpp"

namespace cusp::finishing {

// Facets that a ball rests on when dropped on a grid, found when first needed, block directions
// (`BlockingFacets`). All directions are divided around that of the lowest ball known: near it most of the
// facets block that block anything, so triangles that have it as a corner need no division towards it.
//
// Not for use by two threads at once.
class LowerPositionProof {
public:
    // path_fitter  of passes over a mesh; must outlive this
    // pitch        mm, of the grid
    LowerPositionProof(const GougeFreePathFitter& path_fitter, double pitch);

    enum class Verdict : std::uint8_t { kNone, kOne, kUnknown };
    // True if a ball clear of the mesh passes through the point or straight below it. kNone and
    // kOne are proved.
    //
    // centre  of a ball that passes a little above the point
    Verdict verdict_over(Vec3d point, Vec3d centre);

private:
    static constexpr std::int64_t kSide = 4;              // grid points in x and in y
    using Block = std::vector<const part_model::Facet*>;  // that the ball rests on there

    const Block& block(std::int64_t i, std::int64_t j);
    Block facets_near(Vec3d point);

    const GougeFreePathFitter& path_fitter_;
    double pitch_;
    double radius_;
    double contact_radius_;  // mm: of the ball grown by the band's offset, which touches the model
    part_model::ToolProfile profile_;  // of that ball
    std::unordered_map<std::uint64_t, Block> blocks_;
};

}  // namespace cusp::finishing
