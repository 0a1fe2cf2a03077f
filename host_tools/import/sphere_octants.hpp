// The parts of a face of the unit sphere in the eight octants of the axes.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "firmware/base/vec.hpp"

namespace cusp::import {

struct PointAndTangent {
    Vec3d point;
    Vec3d tangent;  // by the parameter
};

// An edge of a face, from parameter `from` to `to`, which may be less. The face lies on its left, seen
// from outside.
struct SphereEdge {
    std::function<PointAndTangent(double)> at;
    double from;
    double to;

    Vec3d begin() const { return at(from).point; }
    Vec3d end() const { return at(to).point; }
};

using SphereLoop = std::vector<SphereEdge>;

// signs  of x, y and z
// loops  closed; what they enclose lies on their left. None: no part of the face.
struct SphereOctant {
    Vec3d signs;
    std::vector<SphereLoop> loops;
};

// How well the planes of the axes cut the edges, 0 to 1: the least of how far ends lie from a plane, how
// steeply edges cross one, and how far they stay from the corners of octants.
double cut_quality(const std::vector<SphereEdge>& edges);

// edges  on the unit sphere, as in sphere_patches()
// gap    how far ends that meet may lie apart, of the radius
// place  begins the message
std::array<SphereOctant, 8> sphere_octants(const std::vector<SphereEdge>& edges,
                                           double gap,
                                           const std::string& place);

}  // namespace cusp::import
