// Samples NURBS faces, and finds their smallest concave radius.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/part_info/ground.hpp"

namespace cusp::part_info {

struct SurfaceAt {
    int surface;
    double u, v;
};

struct SurfacePlaces {
    std::vector<GroundPlace> places;
    std::vector<SurfaceAt> at;  // parameters of each
};

// Centres of cells with their areas, some 30 000 in total and at least nine in each Bezier patch;
// and corners of patches and points on trimmed edges, without areas.
//
// outwards  of each surface: +1 if du x dv points out of a solid, -1 if into it, 0 if it bounds
//           none; empty: all 0
SurfacePlaces surface_places(const std::vector<nurbs::Surface>& surfaces,
                             const std::vector<double>& outwards);

// mm: the radius of the greatest concave principal curvature on the side of the normal; no value
// where the surface is not concave.
std::optional<double> hollow_radius(const nurbs::SurfacePoint& p, Vec3d normal);

struct Hollow {
    double radius;  // mm
    GroundPlace place;
};

// The smallest concave radius of the faces from above: the best sample, improved by a local search.
// No value: nothing is concave.
// Accuracy: 1e-6 of the radius at the point; a smaller radius between samples may be missed.
std::optional<Hollow> smallest_hollow(const std::vector<nurbs::Surface>& surfaces,
                                      const SurfacePlaces& places,
                                      const std::vector<char>& hidden);

}  // namespace cusp::part_info
