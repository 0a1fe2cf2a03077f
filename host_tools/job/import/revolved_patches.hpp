// Faces of rings, cones and cylinders in patches that meet no seam.
//
//   // a ring of radii 10 and 3 about z, whole
//   const Revolved ring{{0, 0, 0}, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, 10, 3, 0};
//   const std::vector<nurbs::Surface> patches = revolved_patches(ring, {}, 0.01, "ring");
//
// The angles of such a surface jump at its seams, so an edge that crosses one has no continuous curve in
// (u, v). Here the surface is cut at quarters of its turns, where no edge ends or runs along.
#pragma once

#include <string>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/import/face_edges.hpp"
#include "host_tools/job/import/revolved_cells.hpp"

namespace cusp::import {

// edges  in space, mm, in any order; each end meets the beginning of another one, or of its own. None: the
//        whole of a ring.
// gap    mm: how far ends that meet may lie apart, and edges beside the surface
// place  begins the message
//
// Returns trimmed surfaces; du x dv points away from the axis or from the tube's middle. Their trims lie
// within 1e-5 mm of the edges, put on the surface along its normal. Parts of the face narrower than 2e-5
// of a patch's side are left out.
// Errors: InputError where edges do not close, leave the surface, come near the axis, cross, or bound no face.
std::vector<nurbs::Surface> revolved_patches(const Revolved& surface,
                                             const std::vector<FaceEdge>& edges,
                                             double gap,
                                             const std::string& place);

}  // namespace cusp::import
