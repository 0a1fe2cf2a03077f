// Divides each Bezier patch into equal cells, by its second derivatives. Trimmed cells are
// quartered until the convex hull of their remaining part is inside the face.
#include "host_tools/job/part_info/surface_facets.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/part_model/trim_region.hpp"

namespace cusp::part_info {

using nurbs::BezierPatch;
using nurbs::Surface;
using nurbs::SurfacePoint;
using part_model::TrimRegion;

namespace {

constexpr double kMostFacets = 2e6;
constexpr int kMostAlong = 4000;       // cells of a patch
constexpr double kSmallestCut = 0.05;  // mm: size of the smallest trimmed cell
constexpr double kEdgeShare = 5;       // times the tolerance, along trimmed edges

struct Cells {
    int u, v;
};

// From the second-order terms of the deviation between a cell and the surface.
Cells cells_of(const Surface& s, double tolerance)
{
    constexpr int kLooks = 6;
    double bend_u = 0;
    double bend_v = 0;
    double twist = 0;
    for (int k = 0; k < kLooks * kLooks; ++k) {
        const double a = static_cast<double>(k % kLooks) / (kLooks - 1);
        const double b = static_cast<double>(k / kLooks) / (kLooks - 1);
        const SurfacePoint p = derivatives_at(s, s.u_begin() + a * (s.u_end() - s.u_begin()),
                                              s.v_begin() + b * (s.v_end() - s.v_begin()));
        const Vec3d n = upward_normal(p);
        bend_u = std::max(bend_u, std::abs(dot(p.duu, n)));
        bend_v = std::max(bend_v, std::abs(dot(p.dvv, n)));
        twist = std::max(twist, std::abs(dot(p.duv, n)));
    }
    const double width_u = s.u_end() - s.u_begin();
    const double width_v = s.v_end() - s.v_begin();
    const double half = tolerance / 2;
    double u = std::max(1.0, width_u * std::sqrt(bend_u / (8 * half)));
    double v = std::max(1.0, width_v * std::sqrt(bend_v / (8 * half)));
    const double off = bend_u * width_u * width_u / (8 * u * u) +
                       bend_v * width_v * width_v / (8 * v * v) +
                       twist * width_u * width_v / (4 * u * v);
    const double more = std::sqrt(std::max(1.0, off / tolerance));
    u = std::min(more * u, static_cast<double>(kMostAlong));
    v = std::min(more * v, static_cast<double>(kMostAlong));
    return {static_cast<int>(std::ceil(u)), static_cast<int>(std::ceil(v))};
}

// Counter-clockwise; Andrew's monotone chain.
std::vector<Vec2d> convex_hull(std::vector<Vec2d> points)
{
    std::sort(points.begin(), points.end(),
              [](Vec2d a, Vec2d b) { return a.x < b.x || (a.x == b.x && a.y < b.y); });
    std::vector<Vec2d> hull;
    for (int half = 0; half < 2; ++half) {
        const std::size_t first = hull.size();
        for (const Vec2d p : points) {
            while (hull.size() >= first + 2 &&
                   cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0) {
                hull.pop_back();
            }
            hull.push_back(p);
        }
        hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

class Faceting {
public:
    explicit Faceting(double tolerance) { out_.tolerance = tolerance; }

    void add(const Surface& patch, const TrimRegion& region)
    {
        const Cells cells = cells_of(patch, out_.tolerance);
        const Vec2d size{(patch.u_end() - patch.u_begin()) / cells.u,
                         (patch.v_end() - patch.v_begin()) / cells.v};
        for (int i = 0; i < cells.u; ++i) {
            for (int j = 0; j < cells.v; ++j) {
                add_cell(patch, region,
                         {patch.u_begin() + i * size.x, patch.v_begin() + j * size.y}, size);
            }
        }
    }

    SurfaceFacets facets() && { return std::move(out_); }

private:
    void add_cell(const Surface& patch, const TrimRegion& region, Vec2d low, Vec2d size)
    {
        const auto part = region.part(low.x, low.x + size.x, low.y, low.y + size.y);
        if (part == TrimRegion::Part::kInside) {
            add_polygon(patch, {low, {low.x + size.x, low.y}, low + size, {low.x, low.y + size.y}});
        } else if (part == TrimRegion::Part::kCut) {
            add_cut_cell(patch, region, low, size);
        }
    }

    void add_cut_cell(const Surface& patch, const TrimRegion& region, Vec2d low, Vec2d size)
    {
        TrimRegion::Remnant left;
        region.remnant(low.x, low.x + size.x, low.y, low.y + size.y, left);
        std::vector<Vec2d> points = left.corners;
        points.insert(points.end(), left.edge.begin(), left.edge.end());
        if (points.size() < 3) {
            return;
        }
        // relative to the cell, so that both directions have equal weight
        for (Vec2d& p : points) {
            p = {(p.x - low.x) / size.x, (p.y - low.y) / size.y};
        }
        std::vector<Vec2d> hull = convex_hull(std::move(points));
        for (Vec2d& p : hull) {
            p = {low.x + p.x * size.x, low.y + p.y * size.y};
        }
        if (hull.size() < 3) {
            return;
        }
        const double width =
            norm(point_at(patch, low.x + size.x, low.y + size.y) - point_at(patch, low.x, low.y)) +
            norm(point_at(patch, low.x + size.x, low.y) - point_at(patch, low.x, low.y + size.y));
        if (width < 2 * kSmallestCut || is_face(hull, region, width)) {
            add_polygon(patch, hull);
            return;
        }
        const Vec2d half = 0.5 * size;
        for (const Vec2d corner :
             {low, Vec2d{low.x + half.x, low.y}, Vec2d{low.x, low.y + half.y}, low + half}) {
            add_cell(patch, region, corner, half);
        }
    }

    // True if the hull is inside the face at the midpoints of its sides.
    bool is_face(const std::vector<Vec2d>& hull, const TrimRegion& region, double width) const
    {
        Vec2d middle;
        for (const Vec2d p : hull) {
            middle = middle + p * (1.0 / static_cast<double>(hull.size()));
        }
        const double pull = std::clamp(2 * kEdgeShare * out_.tolerance / width, 1e-3, 0.5);
        const auto is_inside = [&](Vec2d p) {
            const Vec2d at = p + pull * (middle - p);
            return region.inside(at.x, at.y);
        };
        for (std::size_t k = 0; k < hull.size(); ++k) {
            const Vec2d next = hull[(k + 1) % hull.size()];
            if (!is_inside(0.5 * (hull[k] + next)) || !is_inside(0.75 * hull[k] + 0.25 * next) ||
                !is_inside(0.25 * hull[k] + 0.75 * next)) {
                return false;
            }
        }
        return region.inside(middle.x, middle.y);
    }

    void add_polygon(const Surface& patch, const std::vector<Vec2d>& polygon)
    {
        constexpr double kLeastHeight = 1e-9;  // mm
        const Vec3d a = point_at(patch, polygon[0].x, polygon[0].y);
        Vec3d b = point_at(patch, polygon[1].x, polygon[1].y);
        for (std::size_t k = 2; k < polygon.size(); ++k) {
            const Vec3d c = point_at(patch, polygon[k].x, polygon[k].y);
            const double longest = std::max({norm(b - a), norm(c - b), norm(a - c)});
            if (norm(cross(b - a, c - a)) > kLeastHeight * longest) {
                out_.triangles.push_back({a, b, c});
            }
            b = c;
        }
    }

    SurfaceFacets out_;
};

}  // namespace

SurfaceFacets surface_facets(const std::vector<Surface>& surfaces, double tolerance)
{
    std::vector<std::vector<BezierPatch>> patches;
    for (const Surface& surface : surfaces) {
        patches.push_back(bezier_patches(surface));
    }
    const auto facets_with = [&](double allowed) {
        double count = 0;
        for (const auto& of_surface : patches) {
            for (const BezierPatch& patch : of_surface) {
                const Cells cells = cells_of(patch.surface, allowed);
                count += 2.0 * cells.u * cells.v;
            }
        }
        return count;
    };
    while (facets_with(tolerance) > kMostFacets) {
        tolerance *= 2;
    }
    Faceting faceting{tolerance};
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        const TrimRegion region{surfaces[k], tolerance};
        for (const BezierPatch& patch : patches[k]) {
            faceting.add(patch.surface, region);
        }
    }
    return std::move(faceting).facets();
}

}  // namespace cusp::part_info
