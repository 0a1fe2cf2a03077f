// Edges of a face that is cut into cells.
#pragma once

#include <functional>
#include <vector>

#include "firmware/base/vec.hpp"

namespace cusp::import {

struct PointAndTangent {
    Vec3d point;
    Vec3d tangent;  // by the parameter
};

// An edge of a face, from parameter `from` to `to`, which may be less. The face lies on its left, seen
// from outside.
struct FaceEdge {
    std::function<PointAndTangent(double)> at;
    double from;
    double to;

    Vec3d begin() const { return at(from).point; }
    Vec3d end() const { return at(to).point; }
};

using FaceLoop = std::vector<FaceEdge>;

constexpr int kEdgeChords = 64;  // of an edge, to find its crossings and what is nearest

inline double parameter_of(const FaceEdge& edge, int chord)
{
    return edge.from + (edge.to - edge.from) * chord / kEdgeChords;
}

}  // namespace cusp::import
