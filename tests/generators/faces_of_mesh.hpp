// The faces of a mesh as a CAD file has them: trimmed planes.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/loops.hpp"

namespace cusp::test {

// A plane, u and v in mm, trimmed to the polygon. The first side lies along u.
//
// Precondition: the corners lie in one plane and turn counter-clockwise seen against `normal`.
inline nurbs::Surface plane_face(const std::vector<Vec3d>& corners, Vec3d normal)
{
    const Vec3d along = (corners[1] - corners[0]) / norm(corners[1] - corners[0]);
    const Vec3d across = cross(normal, along);
    std::vector<Vec2d> polygon;
    Vec2d low{0, 0};
    Vec2d high{0, 0};
    for (const Vec3d& p : corners) {
        const Vec2d at{dot(p - corners[0], along), dot(p - corners[0], across)};
        polygon.push_back(at);
        low = {std::min(low.x, at.x), std::min(low.y, at.y)};
        high = {std::max(high.x, at.x), std::max(high.y, at.y)};
    }
    nurbs::Surface s;
    s.degree_u = s.degree_v = 1;
    s.knots_u = {low.x, low.x, high.x, high.x};
    s.knots_v = {low.y, low.y, high.y, high.y};
    s.size_u = s.size_v = 2;
    for (const double u : {low.x, high.x}) {
        for (const double v : {low.y, high.y}) {
            s.points.push_back(corners[0] + along * u + across * v);
        }
    }
    s.weights.assign(4, 1.0);
    s.trims = {loop_of(polygon)};
    return s;
}

// A face for each triangle; one for two that follow each other, share a diagonal as add_quad() makes
// them, and lie in one plane.
inline std::vector<nurbs::Surface> faces_of(const Triangles& mesh)
{
    constexpr double kInPlane = 1e-12;  // mm
    std::vector<nurbs::Surface> out;
    for (std::size_t k = 0; k < mesh.size(); ++k) {
        const auto& t = mesh[k];
        const Vec3d area = cross(t[1] - t[0], t[2] - t[0]);
        const Vec3d normal = area / norm(area);
        std::vector<Vec3d> corners{t[0], t[1], t[2]};
        const bool with_next = k + 1 < mesh.size() && norm(mesh[k + 1][0] - t[0]) == 0 &&
                               norm(mesh[k + 1][1] - t[2]) == 0 &&
                               std::abs(dot(mesh[k + 1][2] - t[0], normal)) < kInPlane;
        if (with_next) {
            corners.push_back(mesh[++k][2]);
        }
        out.push_back(plane_face(corners, normal));
    }
    return out;
}

}  // namespace cusp::test
