// Interval arithmetic on the spreads of the derivatives over cells, which are halved while the
// bounds are loose.
#include "host_tools/cam/contour_pocket/height_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/part_model/bezier_cell.hpp"

namespace cusp::contour_pocket {

using nurbs::BezierPatch;
using nurbs::crease_knots;
using nurbs::Surface;
using offset::Box2d;
using part_model::bend_bounds;
using part_model::BendBounds;
using part_model::BezierCell;
using part_model::kNoBendBounds;

namespace {

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
    const BendBounds bounds = bend_bounds(cell, cell.spread());
    const BendBounds middle = bend_bounds(cell, {});
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
        return kNoBendBounds;
    }
    BendBounds bounds;
    visit(box, [&](std::size_t bin) { widen(bounds, bins_[bin]); });
    return bounds;
}

}  // namespace cusp::contour_pocket
