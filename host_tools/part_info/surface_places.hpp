// Samples NURBS faces, and finds their smallest hollow radius.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"
#include "host_tools/part_info/ground.hpp"

namespace cusp::part_info {

struct SurfaceAt {
    int surface;
    double u, v;
};

struct SurfacePlaces {
    std::vector<GroundPlace> places;
    std::vector<SurfaceAt> at;  // of each
};

// Middles of cells, some 30 000 in all but at least nine for each Bezier patch, with their areas;
// corners of patches and places along trimmed edges, without.
//
// outwards  of each surface: +1 where du x dv points out of a solid, -1 where in, 0 where it bounds
//           none; empty: all 0
SurfacePlaces surface_places(const std::vector<nurbs::Surface>& surfaces,
                             const std::vector<double>& outwards);

// mm, of the ball that follows the surface across its sharpest hollow there, on the side that the
// normal points to: one over the greater principal curvature; none where it is not hollow.
std::optional<double> hollow_radius(const nurbs::SurfacePoint& p, Vec3d normal);

struct Hollow {
    double radius;  // mm
    GroundPlace place;
};

// The smallest hollow radius of the faces as seen from above: the best place, improved by a local
// search. No value: nothing is hollow.
// Accuracy: 1e-6 of the radius at the place; a smaller hollow between places may be missed.
std::optional<Hollow> smallest_hollow(const std::vector<nurbs::Surface>& surfaces,
                                      const SurfacePlaces& places,
                                      const std::vector<char>& hidden);

}  // namespace cusp::part_info
