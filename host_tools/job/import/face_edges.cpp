#include "host_tools/job/import/face_edges.hpp"

#include <algorithm>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"

#include "fmt/format.h"

namespace cusp::import {

bool is_left_of_nearest(const std::vector<FaceEdge>& edges,
                        Vec3d point,
                        double same,
                        const std::function<Vec3d(Vec3d from, Vec3d to)>& way,
                        const std::function<Vec3d(Vec3d)>& up)
{
    double least = kInfinite;
    double side = 0;
    for (const FaceEdge& edge : edges) {
        Vec3d a = edge.begin();
        double nearest = kInfinite;
        double left_by = 0;  // of the chord nearest to the point
        for (int k = 1; k <= kEdgeChords; ++k) {
            const Vec3d b = edge.at(parameter_of(edge, k)).point;
            const Vec3d along = way(a, b);
            const Vec3d to = way(a, point);
            const double t = std::clamp(dot(to, along) / dot(along, along), 0.0, 1.0);
            const Vec3d apart = to - along * t;
            if (norm(apart) < nearest) {
                nearest = norm(apart);
                left_by = dot(cross(up(a), along) / norm(along), apart);
            }
            a = b;
        }
        if (nearest < least - same) {
            side = 0;
        }
        if (nearest < least + same) {
            side += left_by;
            least = std::min(least, nearest);
        }
    }
    return side > 0;
}

void check_on_surface(const std::vector<FaceEdge>& edges,
                      const std::function<double(Vec3d)>& off,
                      double gap,
                      const std::string& place)
{
    for (const FaceEdge& edge : edges) {
        for (int k = 0; k <= kEdgeChords; ++k) {
            const double beside = off(edge.at(parameter_of(edge, k)).point);
            if (!(beside <= gap)) {
                throw InputError(
                    fmt::format("{}: an edge lies {:.3g} mm beside the surface, allowed {:.3g}",
                                place, beside, gap));
            }
        }
    }
}

}  // namespace cusp::import
