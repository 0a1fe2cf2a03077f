// What is near by the surroundings of a contact's cell; boxes for what is not.
#include "host_tools/part_model/move_clearance_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host_tools/part_model/cell_surroundings.hpp"

namespace cusp::part_model {

using nurbs::SurfacePoint;

namespace {

constexpr double kLargestCell = 0.6;    // radii
constexpr double kSmallestCell = 0.4;   // radii
constexpr double kSpare = 0.03;         // of the metric: what a form of one end has over for both
constexpr int kDeepest = 4;             // halvings of a way
constexpr int kFootSteps = 4;           // of Newton's method
constexpr double kFootSlack = 1e-5;     // mm off the normal
constexpr double kLeastBox = 1 / 12.0;  // radii: boxes that small prove nothing if they are near
constexpr double kUsualMargin = 0.01;   // radii
constexpr double kRangeMore = 0.4;      // radii, for other contacts of the same cell

double square(Vec3d a) { return dot(a, a); }

// Below (y - c)^2 - d^2 for the centre c over a contact, d over it, by what lies between the
// contact and y in the domain.
QuadraticForm rise_of(const BezierCell::Surroundings& near, double distance)
{
    const double share = near.nearness - distance * near.more;
    return {share * near.metric.a - distance * near.bend.a,
            share * near.metric.b - distance * near.bend.b,
            share * near.metric.c - distance * near.bend.c};
}

// The most of one form in terms of another that is positive.
double most_of(const QuadraticForm& p, const QuadraticForm& metric)
{
    const double det = metric.determinant();
    const double mean = (metric.a * p.c - 2 * metric.b * p.b + metric.c * p.a) / (2 * det);
    return mean + std::sqrt(std::max(0.0, mean * mean - p.determinant() / det));
}

QuadraticForm less(const QuadraticForm& p, const QuadraticForm& q, double times)
{
    return {p.a - times * q.a, p.b - times * q.b, p.c - times * q.c};
}

// A form that is nowhere above either: the first, less what it is over the second at most in terms
// of the metric.
QuadraticForm below_both(const QuadraticForm& p,
                         const QuadraticForm& q,
                         const QuadraticForm& metric)
{
    return less(p, metric, std::max(0.0, most_of(less(p, q, 1), metric)));
}

// Whether the shank keeps off what of the surroundings is higher than the centres.
// contact  z in mm of the end that the surroundings are of
// centre   z in mm of the lower centre
// apart    mm, between the ends as the metric has it
bool clears_shank(const QuadraticForm& rise,
                  const BezierCell::Surroundings& near,
                  double contact,
                  double centre,
                  double apart)
{
    const double over = near.top - centre;
    if (over <= 0) {
        return true;
    }
    // At the least so long is w for the lowest and the highest of these places.
    const double low = (centre - contact) / near.climb - 0.5 * apart;
    const double high = (near.top - contact) / near.climb - 0.5 * apart;
    const double spare = -most_of(less({}, rise, 1), near.metric);
    return low >= 0 && high >= 0 && spare * high * high >= over * over;
}

double size_of(const BezierCell& cell)
{
    return std::sqrt(std::max(square(cell.middle().du), square(cell.middle().dv)));
}

const BezierCell& half_at(const BezierCell& cell, const CcPoint& at)
{
    const auto [low, high] = cell.halves();
    const bool above = low->u_end() < cell.u_end() ? at.u > low->u_end() : at.v > low->v_end();
    return above ? *high : *low;
}

// Whether the bounds prove enough.
bool holds(const BezierCell::Surroundings& near, const CcPoint& at)
{
    if (!std::isfinite(near.more)) {
        return false;
    }
    const QuadraticForm rise = less(rise_of(near, at.distance), near.metric, kSpare);
    return rise.never_negative() && clears_shank(rise, near, at.point.z, at.centre().z, 0);
}

}  // namespace

const BezierCell& MoveClearanceBound::cell_of(const CcPoint& at) const
{
    if (at.cell != nullptr) {
        return *at.cell;
    }
    const BezierCell* cell = &state_.cell_at(at.surface, at.u, at.v);
    while (size_of(*cell) > kLargestCell * radius_) {
        cell = &half_at(*cell, at);
    }
    for (;;) {
        if (cell->surroundings() == nullptr) {
            cell->set_surroundings(find_surroundings(state_, *cell));
        }
        if (size_of(*cell) <= kSmallestCell * radius_ || holds(*cell->surroundings(), at)) {
            break;
        }
        cell = &half_at(*cell, at);
    }
    at.cell = cell;
    return *cell;
}

std::optional<double> MoveClearanceBound::between(const CcPoint& a,
                                                  const CcPoint& b,
                                                  double sufficient,
                                                  int depth) const
{
    const Cells cells{cell_of(a), cell_of(b)};
    if (!near_rise(a, cells.of_a, b, cells.of_b)) {
        return std::nullopt;
    }
    const double way = square(b.centre() - a.centre());
    // Far from both ends, or only from one.
    const double share = &cells.of_a == &cells.of_b ? 8 : 2;
    const double margin =
        std::max(kUsualMargin * radius_, way / (share * std::min(a.distance, b.distance)));
    if (others_are_far(a, cells.of_a, margin) &&
        (way == 0 || others_are_far(b, cells.of_b, margin))) {
        return near_between(a, b, cells, sufficient, depth);
    }
    if (way == 0 || depth == kDeepest) {
        return std::nullopt;
    }
    const std::optional<MiddleContact> foot = contact_of_middle(a, b);
    return foot ? parts_between(a, *foot, b, nullptr, sufficient, depth) : std::nullopt;
}

// Where all else is known to be far from the way between contacts in `cells`, of which this is a
// part: of places near both ends only.
std::optional<double> MoveClearanceBound::near_between(
    const CcPoint& a, const CcPoint& b, const Cells& cells, double sufficient, int depth) const
{
    const std::optional<QuadraticForm> rise = near_rise(a, cell_of(a), b, cell_of(b));
    if (!rise) {
        return std::nullopt;
    }
    const double way = square(b.centre() - a.centre());
    const double nearer = std::min(a.distance, b.distance);
    const double lost = 0.25 * std::max(0.0, way - (*rise)(b.u - a.u, b.v - a.v));
    const double least = std::sqrt(std::max(0.0, nearer * nearer - lost)) - radius_;
    if (least >= sufficient) {
        return least;
    }
    if (way == 0 || depth == kDeepest) {
        return std::nullopt;
    }
    const std::optional<MiddleContact> foot = contact_of_middle(a, b);
    if (!foot) {
        return std::nullopt;
    }
    const BezierCell& cell = cell_of(foot->contact);
    const bool of_these = &cell == &cells.of_a || &cell == &cells.of_b;
    return parts_between(a, *foot, b, of_these ? &cells : nullptr, sufficient, depth);
}

// cells  null: places far from the ends have to be looked at, too
std::optional<double> MoveClearanceBound::parts_between(const CcPoint& a,
                                                        const MiddleContact& foot,
                                                        const CcPoint& b,
                                                        const Cells* cells,
                                                        double sufficient,
                                                        int depth) const
{
    const auto part = [&](const CcPoint& from, const CcPoint& to) {
        return cells != nullptr ? near_between(from, to, *cells, sufficient + foot.off, depth + 1)
                                : between(from, to, sufficient + foot.off, depth + 1);
    };
    const std::optional<double> first = part(a, foot.contact);
    if (!first) {
        return std::nullopt;
    }
    const std::optional<double> second = part(foot.contact, b);
    return second ? std::optional{std::min(*first, *second) - foot.off} : std::nullopt;
}

std::optional<QuadraticForm> MoveClearanceBound::near_rise(const CcPoint& a,
                                                           const BezierCell& cell_a,
                                                           const CcPoint& b,
                                                           const BezierCell& cell_b) const
{
    const BezierCell::Surroundings& near_a = *cell_a.surroundings();
    const BezierCell::Surroundings& near_b = *cell_b.surroundings();
    if (a.surface != b.surface || !std::isfinite(near_a.more) || !std::isfinite(near_b.more)) {
        return std::nullopt;
    }
    QuadraticForm rise = rise_of(near_a, a.distance);
    if (&near_a != &near_b || a.distance != b.distance) {
        rise = below_both(rise, rise_of(near_b, b.distance), near_a.metric);
    }
    const double lowest = std::min(a.centre().z, b.centre().z);
    const auto clear = [&](const CcPoint& end, const BezierCell::Surroundings& near) {
        const double apart = std::sqrt(near.metric(b.u - a.u, b.v - a.v));
        return clears_shank(rise, near, end.point.z, lowest, apart);
    };
    const bool proved = rise.never_negative() && clear(a, near_a) && clear(b, near_b);
    return proved ? std::optional{rise} : std::nullopt;
}

// The contact whose normal passes the middle between two centres.
std::optional<MoveClearanceBound::MiddleContact> MoveClearanceBound::contact_of_middle(
    const CcPoint& a, const CcPoint& b) const
{
    const Vec3d middle = (a.centre() + b.centre()) * 0.5;
    MiddleContact foot{{a.surface, 0.5 * (a.u + b.u), 0.5 * (a.v + b.v), {}, {}, 0}, kInfinite};
    CcPoint& at = foot.contact;
    for (int step = 0; step < kFootSteps; ++step) {
        const SurfacePoint p = model_.evaluate(at.surface, at.u, at.v);
        const Vec3d r = middle - p.point;
        at.point = p.point;
        at.normal = upward_normal(p);
        at.distance = dot(r, at.normal);
        foot.off = norm(r - at.normal * at.distance);
        if (foot.off < kFootSlack) {
            break;
        }
        const double uu = dot(p.du, p.du) - dot(r, p.duu);
        const double uv = dot(p.du, p.dv) - dot(r, p.duv);
        const double vv = dot(p.dv, p.dv) - dot(r, p.dvv);
        const double det = uu * vv - uv * uv;
        if (!(det > 0)) {
            return std::nullopt;
        }
        const double gu = dot(r, p.du);
        const double gv = dot(r, p.dv);
        at.u += (gu * vv - gv * uv) / det;
        at.v += (gv * uu - gu * uv) / det;
    }
    const PartModel::State::Grid& grid = state_.grids[static_cast<std::size_t>(at.surface)];
    const bool inside = at.u >= grid.creases_u.front() && at.u <= grid.creases_u.back() &&
                        at.v >= grid.creases_v.front() && at.v <= grid.creases_v.back();
    return foot.off < kFootSlack && inside && at.distance > 0 ? std::optional{foot} : std::nullopt;
}

// Whether all but the surroundings is farther than the contact, by `margin`, from the centre and
// from all that is straight above it.
bool MoveClearanceBound::others_are_far(const CcPoint& from,
                                        const BezierCell& cell,
                                        double margin) const
{
    if (from.margin >= margin) {
        return true;
    }
    const BezierCell::Surroundings& near = *cell.surroundings();
    const ToolCore ball{0, from.centre()};
    const double limit = from.distance + margin;
    // Distances change by no more than the centre moves.
    if (near.range < limit + norm(ball.end - near.centre)) {
        find_patches(from, cell, limit);
    }
    const bool far = std::all_of(
        near.patches.begin(), near.patches.end(),
        [&](const BezierCell* patch) { return cell_is_far(*patch, ball, from, near, limit); });
    if (far) {
        from.margin = margin;
    }
    return far;
}

void MoveClearanceBound::find_patches(const CcPoint& from,
                                      const BezierCell& cell,
                                      double limit) const
{
    const BezierCell::Surroundings& near = *cell.surroundings();
    near.centre = cell.middle().point + cell.axes()[0] * from.distance;
    near.range = limit + std::max(kRangeMore * radius_, 1.1 * norm(from.centre() - near.centre));
    near.patches.clear();
    const ToolCore ball{0, near.centre};
    std::array<int, 128> stack{0};
    std::size_t count = 1;
    while (count > 0) {
        const BoxTree::Node& node = state_.tree.nodes[static_cast<std::size_t>(stack[--count])];
        if (ball.distance_to_box(node.low, node.high) >= near.range) {
            continue;
        }
        if (node.child[0] >= 0) {
            stack[count++] = node.child[0];
            stack[count++] = node.child[1];
            continue;
        }
        const std::size_t item = static_cast<std::size_t>(-node.child[0] - 1);
        if (item < state_.cells.size()) {
            near.patches.push_back(state_.cells[item].get());
        }
    }
}

bool MoveClearanceBound::cell_is_far(const BezierCell& cell,
                                     const ToolCore& ball,
                                     const CcPoint& from,
                                     const BezierCell::Surroundings& near,
                                     double limit) const
{
    if (cell.surface() == from.surface && lies_in(cell, near)) {
        return true;
    }
    if (ball.distance_to_box(cell.low(), cell.high()) >= limit ||
        oriented_distance(ball, cell) >= limit || state_.outside_trims(cell)) {
        return true;
    }
    if (cell.spread().point < kLeastBox * radius_) {
        return false;
    }
    const auto [a, b] = cell.halves();
    return cell_is_far(*a, ball, from, near, limit) && cell_is_far(*b, ball, from, near, limit);
}

}  // namespace cusp::part_model
