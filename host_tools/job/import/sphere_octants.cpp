// An octant's boundary is three quarter circles.
#include "host_tools/job/import/sphere_octants.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/job/import/cell_loops.hpp"

namespace cusp::import {

namespace {

std::size_t octant_of(const FaceEdge& part)
{
    const Vec3d middle = part.at(0.5 * (part.from + part.to)).point;
    return (middle.x > 0 ? 1U : 0U) + (middle.y > 0 ? 2U : 0U) + (middle.z > 0 ? 4U : 0U);
}

class OctantBoundary : public CellBoundary {
public:
    explicit OctantBoundary(Vec3d signs) : CellBoundary{3}
    {
        const bool straight = signs.x * signs.y * signs.z > 0;
        for (unsigned k = 0; k < 3; ++k) {
            const unsigned axis = straight ? k : 2 - k;
            corners_[k][axis] = signs[axis];
        }
    }

    double beside(Vec3d p, unsigned arc) const override
    {
        return std::abs(dot(p, corners_[(arc + 2) % 3]));
    }
    double along(Vec3d p, unsigned arc) const override
    {
        return elementary::atan2(dot(p, corners_[(arc + 1) % 3]), dot(p, corners_[arc])) /
               (0.5 * kPi);
    }
    FaceEdge part(unsigned arc, double from, double to) const override
    {
        const Vec3d a = corners_[arc];
        const Vec3d b = corners_[(arc + 1) % 3];
        return {[a, b](double t) {
                    const double angle = 0.5 * kPi * t;
                    return PointAndTangent{
                        a * elementary::cos(angle) + b * elementary::sin(angle),
                        (b * elementary::cos(angle) - a * elementary::sin(angle)) * (0.5 * kPi)};
                },
                from, to};
    }
    double distance(Vec3d a, Vec3d b) const override { return norm(a - b); }

private:
    std::array<Vec3d, 3> corners_{};
};

}  // namespace

double cut_quality(const std::vector<FaceEdge>& edges)
{
    double least = 1;
    for (const FaceEdge& edge : edges) {
        for (int k = 0; k <= kEdgeChords; ++k) {
            const auto [p, tangent] = edge.at(parameter_of(edge, k));
            const Vec3d along = tangent / norm(tangent);
            for (unsigned axis = 0; axis < 3; ++axis) {
                const double off = std::abs(p[axis]);
                const bool is_end = k == 0 || k == kEdgeChords;
                least = std::min(least, is_end ? off : elementary::hypot(off, along[axis]));
                least = std::min(least, std::max(off, std::abs(p[(axis + 1) % 3])));
            }
        }
    }
    return least;
}

std::array<SphereOctant, 8> sphere_octants(const std::vector<FaceEdge>& edges,
                                           double gap,
                                           const std::string& place)
{
    const auto side_of = [](Vec3d p, unsigned axis) {
        return p[axis] > 0 ? 1 : 0;
    };
    std::array<std::vector<CellEdge>, 8> parts;
    for (const FaceEdge& edge : edges) {
        for (const CellEdge& part : cut_at_cells(edge, 3, side_of)) {
            parts[octant_of(part.edge)].push_back(part);
        }
    }
    const auto way = [](Vec3d from, Vec3d to) {
        return to - from;
    };
    const auto up = [](Vec3d p) {
        return p;
    };
    const auto is_inside = [&](Vec3d p) {
        return edges.empty() || is_left_of_nearest(edges, p, gap, way, up);
    };
    std::array<SphereOctant, 8> octants;
    for (std::size_t i = 0; i < octants.size(); ++i) {
        octants[i].signs = {(i & 1U) != 0 ? 1.0 : -1.0, (i & 2U) != 0 ? 1.0 : -1.0,
                            (i & 4U) != 0 ? 1.0 : -1.0};
        const OctantBoundary boundary{octants[i].signs};
        octants[i].loops = cell_loops(std::move(parts[i]), boundary, is_inside, gap, place);
    }
    return octants;
}

}  // namespace cusp::import
