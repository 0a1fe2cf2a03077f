// Interval arithmetic on the spreads of the derivatives over cells, which are halved while the
// bounds are loose.
#include "host_tools/contour_pocket/height_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/nurbs/knot_insertion.hpp"
#include "host_tools/nurbs/plan_vector.hpp"
#include "host_tools/part_model/bezier_cell.hpp"
#include "host_tools/part_model/enclosure.hpp"

namespace cusp::contour_pocket {

using nurbs::BezierPatch;
using nurbs::crease_knots;
using nurbs::Surface;
using nurbs::SurfacePoint;
using offset::Box2d;
using part_model::BezierCell;
using part_model::Enclosure;

namespace {

constexpr BendBounds kUnknown{kInfinite, kInfinite, kInfinite};

struct EnclosureVector {
    Enclosure x, y, z;
};

EnclosureVector around(Vec3d p, double spread)
{
    return {
        {p.x - spread, p.x + spread}, {p.y - spread, p.y + spread}, {p.z - spread, p.z + spread}};
}

EnclosureVector cross(const EnclosureVector& a, const EnclosureVector& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

Enclosure dot(const EnclosureVector& a, const EnclosureVector& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Along a line of the plan with unit direction e the second derivative of the height is
//   N . (S_ss a^2 + 2 S_st a b + S_tt b^2) / N_z
// with a = e x S_t / N_z, b = S_s x e / N_z and N = S_s x S_t.
BendBounds bounds_of(const BezierCell& cell, const BezierCell::Spread& e)
{
    const SurfacePoint& m = cell.middle();
    const EnclosureVector p = around(m.du, e.ds);
    const EnclosureVector q = around(m.dv, e.dt);
    const EnclosureVector n = cross(p, q);
    if (n.z.low <= 0.0 && n.z.high >= 0.0) {
        return kUnknown;
    }
    const Enclosure inverse_z = inverse(n.z);
    const EnclosureVector unit{n.x * inverse_z, n.y * inverse_z, {1.0, 1.0}};
    const Enclosure ss = dot(unit, around(m.duu, e.dss));
    const Enclosure st = dot(unit, around(m.duv, e.dst));
    const Enclosure tt = dot(unit, around(m.dvv, e.dtt));
    const Enclosure px = p.x * inverse_z;
    const Enclosure py = p.y * inverse_z;
    const Enclosure qx = q.x * inverse_z;
    const Enclosure qy = q.y * inverse_z;
    const Enclosure xx = ss * (qy * qy) - 2.0 * (st * (qy * py)) + tt * (py * py);
    const Enclosure xy = st * (qy * px + qx * py) - ss * (qx * qy) - tt * (px * py);
    const Enclosure yy = ss * (qx * qx) - 2.0 * (st * (qx * px)) + tt * (px * px);
    const auto largest = [&](double a, double b) {
        return 0.5 * (a + b) + std::hypot(0.5 * (a - b), magnitude(xy));
    };
    return {std::hypot(magnitude(unit.x), magnitude(unit.y)),
            std::max(0.0, largest(xx.high, yy.high)), std::max(0.0, largest(-xx.low, -yy.low))};
}

void widen(BendBounds& bounds, const BendBounds& by)
{
    bounds = {std::max(bounds.slope, by.slope), std::max(bounds.up, by.up),
              std::max(bounds.down, by.down)};
}

Box2d plan_box(const BezierCell& cell)
{
    return {cell.low().x, cell.low().y, cell.high().x, cell.high().y};
}

bool folds(const std::vector<double>& knots, int degree, int size)
{
    return crease_knots(knots, degree, static_cast<std::size_t>(size)).size() > 2;
}

}  // namespace

double proven_reach(double radius, double scallop_height, const BendBounds& bounds)
{
    if (!(bounds.up * radius < 1.0) || !(bounds.slope < kInfinite) || !(bounds.down < kInfinite)) {
        return 0.0;
    }
    const double up = bounds.up / (1.0 - bounds.up * radius);
    const double cosine = 1.0 / std::sqrt(1.0 + bounds.slope * bounds.slope);
    const double foot = radius - scallop_height;
    const auto cut = [&](double d) {
        const double climb = bounds.slope * d;
        const double rise = 0.5 * up * d * d;
        const double fall = 0.5 * bounds.down * d * d;
        const double higher = 2.0 * foot * rise + (climb + rise) * (climb + rise);
        const double lower = (climb + fall) * (climb + fall) - 2.0 * foot * cosine * fall;
        // The worst case is a pass higher than the slope predicts on the downhill side, and a lower
        // one uphill.
        const double across = climb * climb;
        return foot * foot + d * d + std::max({higher, lower, across}) <= radius * radius;
    };
    constexpr int kHalvings = 30;
    double good = 0.0;
    double bad = radius;
    for (int i = 0; i < kHalvings; ++i) {
        const double middle = 0.5 * (good + bad);
        (cut(middle) ? good : bad) = middle;
    }
    return good;
}

HeightBounds::HeightBounds(const std::vector<Surface>& floor, double reach)
    : reach_{reach}, bin_{0.5 * reach}
{
    if (floor.size() != 1) {
        return;
    }
    const Surface& surface = floor.front();
    if (!surface.trims.empty() || folds(surface.knots_u, surface.degree_u, surface.size_u) ||
        folds(surface.knots_v, surface.degree_v, surface.size_v)) {
        return;
    }
    std::vector<Cell> found;
    for (const BezierPatch& patch : bezier_patches(surface)) {
        subdivide(BezierCell{patch, 0}, 0, found);
    }
    for (const Cell& cell : found) {
        field_ = {std::min(field_.x0, cell.box.x0), std::min(field_.y0, cell.box.y0),
                  std::max(field_.x1, cell.box.x1), std::max(field_.y1, cell.box.y1)};
    }
    fill_bins(found);
}

void HeightBounds::subdivide(const BezierCell& cell, int halvings, std::vector<Cell>& found) const
{
    constexpr int kMostHalvings = 10;
    constexpr double kLoose = 1.1;
    const double slack = 0.01 / reach_;
    const Box2d box = plan_box(cell);
    const BendBounds bounds = bounds_of(cell, cell.spread());
    const BendBounds middle = bounds_of(cell, {});
    const bool tight = bounds.up <= kLoose * middle.up + slack &&
                       bounds.down <= kLoose * middle.down + slack &&
                       bounds.slope <= kLoose * middle.slope + 0.01;
    const bool small = std::max(box.x1 - box.x0, box.y1 - box.y0) < 0.125 * reach_;
    if (tight || small || halvings == kMostHalvings) {
        found.push_back({box, bounds});
        return;
    }
    for (const BezierCell* half : cell.halves()) {
        subdivide(*half, halvings + 1, found);
    }
}

void HeightBounds::fill_bins(const std::vector<Cell>& found)
{
    constexpr double kMostBins = 400.0;  // a side
    bin_ =
        std::max({bin_, (field_.x1 - field_.x0) / kMostBins, (field_.y1 - field_.y0) / kMostBins});
    columns_ = static_cast<int>((field_.x1 - field_.x0) / bin_) + 1;
    rows_ = static_cast<int>((field_.y1 - field_.y0) / bin_) + 1;
    bins_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), {});
    for (const Cell& cell : found) {
        const Box2d near{cell.box.x0 - reach_, cell.box.y0 - reach_, cell.box.x1 + reach_,
                         cell.box.y1 + reach_};
        visit(near, [&](std::size_t bin) { widen(bins_[bin], cell.bounds); });
    }
}

template <class Visit>
void HeightBounds::visit(const Box2d& box, Visit visit) const
{
    const auto bin = [&](double at, double from, int count) {
        return std::clamp(static_cast<int>(std::floor((at - from) / bin_)), 0, count - 1);
    };
    const int first = bin(box.x0, field_.x0, columns_);
    const int last = bin(box.x1, field_.x0, columns_);
    for (int j = bin(box.y0, field_.y0, rows_); j <= bin(box.y1, field_.y0, rows_); ++j) {
        for (int i = first; i <= last; ++i) {
            visit(static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(i));
        }
    }
}

BendBounds HeightBounds::near(const Box2d& box) const
{
    const bool whole = box.x0 - reach_ >= field_.x0 && box.y0 - reach_ >= field_.y0 &&
                       box.x1 + reach_ <= field_.x1 && box.y1 + reach_ <= field_.y1;
    if (bins_.empty() || !whole) {
        return kUnknown;
    }
    BendBounds bounds;
    visit(box, [&](std::size_t bin) { widen(bounds, bins_[bin]); });
    return bounds;
}

}  // namespace cusp::contour_pocket
