// The parts of a face of the unit sphere in the eight octants of the axes.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "firmware/base/vec.hpp"
#include "host_tools/job/import/face_edges.hpp"

namespace cusp::import {

// signs  of x, y and z
// loops  closed; what they enclose lies on their left. None: no part of the face.
struct SphereOctant {
    Vec3d signs;
    std::vector<FaceLoop> loops;
};

// Quality of the cuts of edges by the planes of the axes, 0 to 1: the least of the distance of ends
// from a plane, the angle at which edges cross one, and their distance from the corners of octants.
double cut_quality(const std::vector<FaceEdge>& edges);

// edges  on the unit sphere, as in sphere_patches()
// gap    how far ends that meet may lie apart, of the radius
// place  begins the message
std::array<SphereOctant, 8> sphere_octants(const std::vector<FaceEdge>& edges,
                                           double gap,
                                           const std::string& place);

}  // namespace cusp::import
