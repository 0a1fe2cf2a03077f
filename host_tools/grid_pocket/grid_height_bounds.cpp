// Cells of the floor are halved until their bounds are near the values in their middle.
#include "host_tools/grid_pocket/grid_height_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host_tools/part_model/bezier_cell.hpp"
#include "host_tools/part_model/trim_region.hpp"

namespace cusp::grid_pocket {

using nurbs::BezierPatch;
using nurbs::Surface;
using nurbs::SurfacePoint;
using offset::Box2d;
using part_model::BezierCell;
using part_model::TrimRegion;

namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

struct Fold {
    bool left;
    bool right;
    bool front;
    bool back;
};

// Upper bound of how much the height bends down, in any direction of the plan, anywhere in the
// cell.
//
// With N = S_s x S_t the height bends by N . (S_ss a^2 + 2 S_st a b + S_tt b^2) / N_z along a unit
// way of the plan, where |a| <= |S_t| / N_z and |b| <= |S_s| / N_z.
double bend_bound(const BezierCell& cell, bool middle_only)
{
    const SurfacePoint& m = cell.middle();
    const BezierCell::Spread none{};
    const BezierCell::Spread& e = middle_only ? none : cell.spread();
    const double ds = norm(m.du);
    const double dt = norm(m.dv);
    Vec3d normal = cross(m.du, m.dv);
    normal = normal.z < 0 ? -normal : normal;
    const double turn = ds * e.dt + dt * e.ds + e.ds * e.dt;
    const double upright = normal.z - turn;
    if (!(upright > 1e-3 * norm(normal))) {
        return kNoBound;
    }
    const auto down = [&](Vec3d second, double spread) {
        return -dot(normal, second) + norm(normal) * spread + turn * (norm(second) + spread);
    };
    const auto either = [&](Vec3d second, double spread) {
        return std::abs(dot(normal, second)) + norm(normal) * spread +
               turn * (norm(second) + spread);
    };
    const double a = (dt + e.dt) / upright;
    const double b = (ds + e.ds) / upright;
    return (a * a * std::max(0.0, down(m.duu, e.dss)) + 2 * a * b * either(m.duv, e.dst) +
            b * b * std::max(0.0, down(m.dvv, e.dtt))) /
           upright;
}

Box2d plan_box(const BezierCell& cell)
{
    return {cell.low().x, cell.low().y, cell.high().x, cell.high().y};
}

double size_of(const Box2d& box) { return std::max(box.x1 - box.x0, box.y1 - box.y0); }

// Whether the surface may have a ridge along the knot: its multiplicity reaches the degree.
bool folds_at(const std::vector<double>& knots, int degree, double at)
{
    const auto same = std::count_if(knots.begin(), knots.end(),
                                    [&](double k) { return std::abs(k - at) < 1e-12; });
    return same >= degree;
}

class Folds {
public:
    Folds(double fine, double cap) : fine_{fine}, cap_{cap} {}

    void look(const BezierCell& cell, Fold fold, int halvings)
    {
        constexpr int kMostHalvings = 14;
        const bool folded = fold.left || fold.right || fold.front || fold.back;
        const double bound = bend_bound(cell, false);
        const bool tight = bound <= 1.3 * bend_bound(cell, true) + 0.02 * cap_;
        const bool small = size_of(plan_box(cell)) < fine_;
        if (halvings == kMostHalvings || ((tight || small) && (!folded || small))) {
            if (folded || bound > cap_) {
                sharp.push_back(plan_box(cell));
            } else {
                most = std::max(most, bound);
            }
            return;
        }
        const auto [a, b] = cell.halves();
        const bool across_u = a->u_end() != cell.u_end();
        Fold first = fold;
        Fold second = fold;
        (across_u ? first.right : first.back) = false;
        (across_u ? second.left : second.front) = false;
        look(*a, first, halvings + 1);
        look(*b, second, halvings + 1);
    }

    double most{0};
    std::vector<Box2d> sharp;

private:
    double fine_;
    double cap_;
};

}  // namespace

GridHeightBounds::GridHeightBounds(const std::vector<Surface>& floor, double reach)
    : reach_{reach}, bin_{reach / 8}
{
    // A floor that bends more than this is looked at more closely rather than everywhere.
    Folds folds{reach / 16, 4 / reach};
    int number = 0;
    for (const Surface& s : floor) {
        for (const BezierPatch& patch : bezier_patches(s)) {
            const BezierCell cell{patch, number};
            const Box2d box = plan_box(cell);
            field_ = {std::min(field_.x0, box.x0), std::min(field_.y0, box.y0),
                      std::max(field_.x1, box.x1), std::max(field_.y1, box.y1)};
            const auto fold_u = [&](double at) {
                return folds_at(s.knots_u, s.degree_u, at);
            };
            const auto fold_v = [&](double at) {
                return folds_at(s.knots_v, s.degree_v, at);
            };
            folds.look(cell,
                       {fold_u(patch.u_begin), fold_u(patch.u_end), fold_v(patch.v_begin),
                        fold_v(patch.v_end)},
                       0);
        }
        // A trimmed surface ends at its trims too.
        const double edge_error = reach / 64;
        const TrimRegion trims{s, edge_error};
        for (const auto& [a, b] : trims.edges()) {
            folds.sharp.push_back({std::min(a.x, b.x) - edge_error, std::min(a.y, b.y) - edge_error,
                                   std::max(a.x, b.x) + edge_error,
                                   std::max(a.y, b.y) + edge_error});
        }
        ++number;
    }
    max_bend_ = folds.most;
    columns_ = static_cast<int>((field_.x1 - field_.x0) / bin_) + 1;
    rows_ = static_cast<int>((field_.y1 - field_.y0) / bin_) + 1;
    bent_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), false);
    std::for_each(folds.sharp.begin(), folds.sharp.end(), [&](const Box2d& box) { mark(box); });
}

void GridHeightBounds::mark(const Box2d& box)
{
    const auto bin = [&](double at, double from, int count) {
        return std::clamp(static_cast<int>(std::floor((at - from) / bin_)), 0, count - 1);
    };
    for (int j = bin(box.y0 - reach_, field_.y0, rows_);
         j <= bin(box.y1 + reach_, field_.y0, rows_); ++j) {
        for (int i = bin(box.x0 - reach_, field_.x0, columns_);
             i <= bin(box.x1 + reach_, field_.x0, columns_); ++i) {
            bent_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(i)] = true;
        }
    }
}

bool GridHeightBounds::is_bent_near(const Box2d& box) const
{
    if (box.x0 < field_.x0 || box.y0 < field_.y0 || box.x1 > field_.x1 || box.y1 > field_.y1) {
        return true;
    }
    const int last_row = std::min(rows_ - 1, static_cast<int>((box.y1 - field_.y0) / bin_));
    const int last_column = std::min(columns_ - 1, static_cast<int>((box.x1 - field_.x0) / bin_));
    for (int j = static_cast<int>((box.y0 - field_.y0) / bin_); j <= last_row; ++j) {
        for (int i = static_cast<int>((box.x0 - field_.x0) / bin_); i <= last_column; ++i) {
            if (bent_[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
                      static_cast<std::size_t>(i)]) {
                return true;
            }
        }
    }
    return false;
}

}  // namespace cusp::grid_pocket
