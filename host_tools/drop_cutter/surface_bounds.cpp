// Cells that overlap the box, halved until they are about as small.
#include "host_tools/drop_cutter/surface_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/nurbs/plan_vector.hpp"

namespace cusp::drop_cutter {

using nurbs::Surface;
using part_model::BezierCell;
using part_model::TrimRegion;

namespace {

constexpr double kSmallest = 2e-3;  // mm: cells of this size are not halved

// Whether the surface may have a crease at a knot: derivatives are continuous where it is repeated less often than
// the degree.
bool is_crease(const std::vector<double>& knots, int degree, double at)
{
    constexpr double kSame = 1e-12;
    return std::count_if(knots.begin(), knots.end(),
                         [&](double knot) { return std::abs(knot - at) < kSame; }) >= degree;
}

// Bounds on one cell, without its edges.
SurfaceBounds::Bounds bounds_on(const BezierCell& cell)
{
    const nurbs::SurfacePoint& m = cell.middle();
    const BezierCell::Spread& e = cell.spread();
    const double along_u = norm(m.du) + e.ds;
    const double along_v = norm(m.dv) + e.dt;
    // of the normal du x dv; the spread of a product
    const Vec3d normal = cross(m.du, m.dv);
    const double spread = norm(m.du) * e.dt + norm(m.dv) * e.ds + e.ds * e.dt;
    const double up = std::abs(normal.z) - spread;
    if (!(up > 0)) {
        return {kInfinite, kInfinite, false};
    }
    const double slope = (std::hypot(normal.x, normal.y) + spread) / up;
    // (-slope, 1) . second derivative = normal . second derivative / normal.z
    const auto rise = [&](Vec3d second, double its_spread) {
        return (std::abs(dot(normal, second)) + spread * norm(second) +
                (norm(normal) + spread) * its_spread) /
               up;
    };
    // parameters that a millimetre in plan takes at most
    const double u = std::min(along_v, std::hypot(m.dv.x, m.dv.y) + e.dt) / up;
    const double v = std::min(along_u, std::hypot(m.du.x, m.du.y) + e.ds) / up;
    return {
        slope,
        rise(m.duu, e.dss) * u * u + 2 * rise(m.duv, e.dst) * u * v + rise(m.dvv, e.dtt) * v * v,
        false};
}

}  // namespace

SurfaceBounds::SurfaceBounds(const std::vector<Surface>& surfaces)
{
    constexpr double kTrimError = 1e-4;  // mm: as of PartModel
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
        const Surface& surface = surfaces[s];
        trims_.emplace_back(surface, kTrimError);
        for (const nurbs::BezierPatch& patch : bezier_patches(surface)) {
            patches_.push_back({s,
                                std::make_unique<BezierCell>(patch, static_cast<int>(s), &made_),
                                {is_crease(surface.knots_u, surface.degree_u, patch.u_begin),
                                 is_crease(surface.knots_u, surface.degree_u, patch.u_end),
                                 is_crease(surface.knots_v, surface.degree_v, patch.v_begin),
                                 is_crease(surface.knots_v, surface.degree_v, patch.v_end)}});
        }
    }
}

SurfaceBounds::Bounds SurfaceBounds::over(Vec2d low, Vec2d high) const
{
    constexpr std::size_t kMostHalves = 100000;  // some 100 MB
    if (made_ > kMostHalves) {
        for (const Patch& patch : patches_) {
            patch.cell->forget();
        }
        made_ = 0;
    }
    Bounds bounds;
    for (const Patch& patch : patches_) {
        add(*patch.cell, patch, low, high, bounds);
    }
    return bounds;
}

void SurfaceBounds::add(
    const BezierCell& cell, const Patch& patch, Vec2d low, Vec2d high, Bounds& bounds) const
{
    if (cell.high().x < low.x || cell.low().x > high.x || cell.high().y < low.y ||
        cell.low().y > high.y) {
        return;
    }
    const TrimRegion& trims = trims_[patch.surface];
    TrimRegion::Part part = TrimRegion::Part::kInside;
    if (trims.trimmed()) {
        part = trims.part(cell.u_begin(), cell.u_end(), cell.v_begin(), cell.v_end());
        if (part == TrimRegion::Part::kOutside) {
            return;
        }
    }
    const double size = std::max(
        {cell.high().x - cell.low().x, cell.high().y - cell.low().y, cell.high().z - cell.low().z});
    const bool small = size <= std::max(kSmallest, std::max(high.x - low.x, high.y - low.y));
    const BezierCell& whole = *patch.cell;
    const std::array<bool, 4> reached{
        cell.u_begin() == whole.u_begin(), cell.u_end() == whole.u_end(),
        cell.v_begin() == whole.v_begin(), cell.v_end() == whole.v_end()};
    bool ends = part == TrimRegion::Part::kCut;
    for (std::size_t k = 0; k < reached.size(); ++k) {
        ends = ends || (reached[k] && patch.ends[k]);
    }
    const Bounds here = bounds_on(cell);
    const bool tight = here.curvature <= bounds.curvature && here.slope <= bounds.slope;
    const bool steep = !(here.slope < kInfinite) && size > kSmallest;
    if ((small && !steep) || (tight && (!ends || bounds.edges))) {
        bounds.slope = std::max(bounds.slope, here.slope);
        bounds.curvature = std::max(bounds.curvature, here.curvature);
        bounds.edges = bounds.edges || ends;
        return;
    }
    for (const BezierCell* half : cell.halves()) {
        add(*half, patch, low, high, bounds);
    }
}

}  // namespace cusp::drop_cutter
