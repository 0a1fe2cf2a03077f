// Edges of a face that is cut into cells.
#pragma once

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

// True if a point lies on the left of the edge nearest to it; of edges nearest by the same, at a vertex,
// by their sum.
//
// same   how much farther than the nearest one an edge may lie and count as well
// way    from one point to another one, on the surface
// up     out of the surface at a point
bool is_left_of_nearest(const std::vector<FaceEdge>& edges,
                        Vec3d point,
                        double same,
                        const std::function<Vec3d(Vec3d from, Vec3d to)>& way,
                        const std::function<Vec3d(Vec3d)>& up);

// off    how far a point lies beside the surface, mm
// gap    how far points of edges may, mm
// place  begins the message
//
// Errors: InputError where an edge lies farther beside it.
void check_on_surface(const std::vector<FaceEdge>& edges,
                      const std::function<double(Vec3d)>& off,
                      double gap,
                      const std::string& place);

}  // namespace cusp::import
