// Cells of Bezier patches, depth first.
#include "host_tools/geometry/part_model/certified_facets.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/part_model/bezier_cell.hpp"
#include "host_tools/geometry/part_model/trim_region.hpp"

namespace cusp::part_model {

using nurbs::Surface;

namespace {

constexpr double kEdgeShare = 0.1;    // of the error: of polylines along edges
constexpr double kLeastArea = 1e-12;  // mm2
constexpr int kMostHalvings = 60;

// Counter-clockwise (Andrew 1979).
std::vector<Vec2d> convex_hull(std::vector<Vec2d> points)
{
    std::sort(points.begin(), points.end(),
              [](Vec2d a, Vec2d b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    std::vector<Vec2d> out;
    for (int side = 0; side < 2; ++side) {
        const std::size_t first = out.size();
        for (const Vec2d& p : points) {
            while (out.size() >= first + 2 &&
                   cross(out.back() - out[out.size() - 2], p - out.back()) <= 0) {
                out.pop_back();
            }
            out.push_back(p);
        }
        out.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return out;
}

class FacetMaker {
public:
    FacetMaker(const Surface& surface, double error, std::vector<std::array<Vec3d, 3>>& out)
        : region_{surface, kEdgeShare * error}, error_{error}, out_{out}
    {
    }

    void add(const BezierCell& cell, int depth)
    {
        TrimRegion::Remnant rest;
        const TrimRegion::Part part =
            region_.trimmed()
                ? region_.remnant(cell.u_begin(), cell.u_end(), cell.v_begin(), cell.v_end(), rest)
                : TrimRegion::Part::kInside;
        if (part == TrimRegion::Part::kOutside) {
            return;
        }
        std::vector<Vec2d> polygon{{cell.u_begin(), cell.v_begin()},
                                   {cell.u_end(), cell.v_begin()},
                                   {cell.u_end(), cell.v_end()},
                                   {cell.u_begin(), cell.v_end()}};
        bool fits = bow(cell) <= error_;
        if (part == TrimRegion::Part::kCut) {
            std::vector<Vec2d> points = rest.corners;
            points.insert(points.end(), rest.edge.begin(), rest.edge.end());
            polygon = convex_hull(points);
            fits = fits && beyond_edges(cell, rest, polygon) <= error_;
        }
        if (!fits && depth > 0) {
            for (const BezierCell* half : cell.halves()) {
                add(*half, depth - 1);
            }
            return;
        }
        add_fan(cell, polygon);
    }

private:
    // mm: upper bound of how far triangles between points of the cell are off it.
    static double bow(const BezierCell& cell)
    {
        const nurbs::SurfacePoint& m = cell.middle();
        const BezierCell::Spread& e = cell.spread();
        return (norm(m.duu) + e.dss + 2 * (norm(m.duv) + e.dst) + norm(m.dvv) + e.dtt) / 8;
    }

    // mm: how far edges in the cell are from the border of the hull, in which they lie; 0 where one edge
    // crosses the cell, turning to the outside.
    static double beyond_edges(const BezierCell& cell,
                               const TrimRegion::Remnant& rest,
                               const std::vector<Vec2d>& hull)
    {
        const double by_s = norm(cell.middle().du) + cell.spread().ds;
        const double by_t = norm(cell.middle().dv) + cell.spread().dt;
        const auto at = [&](Vec2d p) {
            return Vec2d{by_s * cell.s_of(p.x), by_t * cell.t_of(p.y)};
        };
        double most = 0;
        for (const Vec2d& corner : rest.edge) {
            const Vec2d p = at(corner);
            double nearest = kInfinite;
            for (std::size_t k = 0; k < hull.size(); ++k) {
                const Vec2d a = at(hull[k]);
                const Vec2d along = at(hull[(k + 1) % hull.size()]) - a;
                const double square = dot(along, along);
                const double share =
                    square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0;
                nearest = std::min(nearest, norm(p - a - along * share));
            }
            most = std::max(most, nearest);
        }
        return hull.size() < 3 ? 0 : most;
    }

    void add_fan(const BezierCell& cell, const std::vector<Vec2d>& polygon)
    {
        std::vector<Vec3d> corners;
        for (const Vec2d& p : polygon) {
            corners.push_back(cell.tangents_at(cell.s_of(p.x), cell.t_of(p.y)).point);
        }
        for (std::size_t k = 2; k < corners.size(); ++k) {
            const std::array<Vec3d, 3> facet{corners[0], corners[k - 1], corners[k]};
            if (norm(cross(facet[1] - facet[0], facet[2] - facet[0])) > kLeastArea) {
                out_.push_back(facet);
            }
        }
    }

    TrimRegion region_;
    double error_;
    std::vector<std::array<Vec3d, 3>>& out_;
};

}  // namespace

std::vector<std::array<Vec3d, 3>> certified_facets(const std::vector<Surface>& surfaces,
                                                   double error)
{
    std::vector<std::array<Vec3d, 3>> out;
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        FacetMaker maker{surfaces[k], error, out};
        for (const nurbs::BezierPatch& patch : bezier_patches(surfaces[k])) {
            const BezierCell cell{patch, static_cast<int>(k)};
            maker.add(cell, kMostHalvings);
        }
    }
    return out;
}

}  // namespace cusp::part_model
