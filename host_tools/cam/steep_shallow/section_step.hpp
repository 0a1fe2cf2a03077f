// How far apart sections of the part may be for a scallop: vertical planes, or levels.
#pragma once

#include <optional>

#include "host_tools/cam/finishing/surface_operation.hpp"
#include "host_tools/geometry/part_model/facet_drop.hpp"

namespace cusp::steep_shallow {

// Neighbouring sections lie a distance apart along a unit vector: across the planes, or straight up.
class SectionStep {
public:
    // work     kept
    // scallop  mm, tolerance included
    SectionStep(const finishing::SurfaceOperation& work, double scallop);

    // mm: on ground that lies along the vector and is flat; where that is farther it says nothing.
    double widest() const { return widest_; }

    // The step of the tool's centre at a place of a surface; none where that has no normal. 0 where the
    // ground is so square to the vector that the cosine of their angle is less than `least_cosine`.
    std::optional<double> at(
        int surface, double u, double v, Vec3d across, double least_cosine = 1e-6) const;

    // Likewise on flat ground of this normal, or on a facet of a mesh, which bends; for any end.
    double on_facet(Vec3d normal, Vec3d across) const;

private:
    double width(Vec3d normal, Vec3d way) const;

    const finishing::SurfaceOperation& work_;
    part_model::ToolProfile profile_;
    double radius_;  // mm: of the ball
    double height_;  // mm, of the scallop between passes on the path itself
    double widest_;
};

}  // namespace cusp::steep_shallow
