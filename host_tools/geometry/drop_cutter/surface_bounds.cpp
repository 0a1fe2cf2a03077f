// Cells that overlap the box, halved until they are about as small.
#include "host_tools/geometry/drop_cutter/surface_bounds.hpp"

#include <algorithm>

#include "host_tools/geometry/nurbs/knot_insertion.hpp"

namespace cusp::drop_cutter {

using nurbs::Surface;
using part_model::bend_bounds;
using part_model::BendBounds;
using part_model::BezierCell;
using part_model::TrimRegion;

namespace {

constexpr double kSmallest = 2e-3;  // mm: cells of this size are not halved

bool is_among(const std::vector<double>& knots, double knot)
{
    return std::find(knots.begin(), knots.end(), knot) != knots.end();
}

}  // namespace

SurfaceBounds::SurfaceBounds(const std::vector<Surface>& surfaces)
{
    constexpr double kTrimError = 1e-4;  // mm: as of PartModel
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
        const Surface& surface = surfaces[s];
        trims_.emplace_back(surface, kTrimError);
        const std::vector<double> u = nurbs::crease_knots(surface.knots_u, surface.degree_u,
                                                          static_cast<std::size_t>(surface.size_u));
        const std::vector<double> v = nurbs::crease_knots(surface.knots_v, surface.degree_v,
                                                          static_cast<std::size_t>(surface.size_v));
        for (const nurbs::BezierPatch& patch : bezier_patches(surface)) {
            patches_.push_back({s,
                                std::make_unique<BezierCell>(patch, static_cast<int>(s), &made_),
                                {is_among(u, patch.u_begin), is_among(u, patch.u_end),
                                 is_among(v, patch.v_begin), is_among(v, patch.v_end)}});
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
    const BendBounds here = bend_bounds(cell, cell.spread());
    const bool tight =
        here.slope <= bounds.slope && here.up <= bounds.up && here.down <= bounds.down;
    const bool steep = !(here.slope < kInfinite) && size > kSmallest;
    if ((small && !steep) || (tight && (!ends || bounds.edges))) {
        widen(bounds, here);
        bounds.edges = bounds.edges || ends;
        return;
    }
    for (const BezierCell* half : cell.halves()) {
        add(*half, patch, low, high, bounds);
    }
}

}  // namespace cusp::drop_cutter
