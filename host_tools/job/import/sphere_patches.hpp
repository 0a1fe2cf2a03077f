// Faces of spheres in patches that meet no seam and no pole.
//
//   // the cap above a circle of radius 6 about z, on a sphere of radius 10 about the origin
//   const FaceEdge circle{[](double t) {
//       return PointAndTangent{{6 * elementary::cos(t), 6 * elementary::sin(t), 8},
//                              {-6 * elementary::sin(t), 6 * elementary::cos(t), 0}};
//   }, 0, 2 * kPi};
//   const std::vector<nurbs::Surface> cap = sphere_patches({{0, 0, 0}, 10}, {circle}, 0.01, "cap");
//
// The longitude of a sphere jumps at its seam and has no value at its poles, so an edge that meets
// one has no continuous curve in (u, v). Here the sphere is cut into octants by three planes through
// its centre, turned so that they cut the edges well; an octant is one rational biquadratic patch.
#pragma once

#include <string>
#include <vector>

#include "firmware/base/vec.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/import/sphere_octants.hpp"

namespace cusp::import {

// Millimetres.
struct Sphere {
    Vec3d centre;
    double radius;
};

// edges  in any order; each end meets the beginning of another one, or of its own. None: the whole
//        sphere.
// gap    mm: how far ends that meet may lie apart, and edges beside the sphere
// place  begins the message
//
// Returns trimmed surfaces, none for an octant outside the face; du x dv points out of the sphere. Their
// trims lie within 1e-5 mm of the edges, put on the sphere along its radius. Parts of the face narrower
// than 2e-5 of a patch's side are left out.
// Errors: InputError where edges do not close, leave the sphere, cross, or bound no face.
std::vector<nurbs::Surface> sphere_patches(const Sphere& sphere,
                                           const std::vector<FaceEdge>& edges,
                                           double gap,
                                           const std::string& place);

}  // namespace cusp::import
