// Near points by the surroundings of a contact's cell, far points by boxes.
#include "host_tools/geometry/part_model/move_clearance_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host_tools/geometry/part_model/cell_surroundings.hpp"

namespace cusp::part_model {

using nurbs::SurfacePoint;

namespace {

constexpr double kLargestCell = 0.6;    // radii
constexpr double kSmallestCell = 0.4;   // radii
constexpr double kSpare = 0.03;         // of the metric: reserve of the form of one end for both
constexpr int kDeepest = 4;             // halvings of a move
constexpr int kMiddleSteps = 4;         // of Newton's method
constexpr double kMiddleSlack = 1e-5;   // mm off the normal
constexpr double kLeastBox = 1 / 12.0;  // radii: smaller boxes are not divided
constexpr double kUsualMargin = 0.01;   // radii
constexpr double kRangeMore = 0.4;      // radii, for other contacts of the same cell

double square(Vec3d a) { return dot(a, a); }

// The form q: a lower bound of (y - c)^2 - d^2, by the difference of y and the contact in the
// domain.
QuadraticForm rise_of(const BezierCell::Surroundings& near, double distance)
{
    const double share = near.nearness - distance * near.extra_bend;
    return {share * near.metric.a - distance * near.bend.a,
            share * near.metric.b - distance * near.bend.b,
            share * near.metric.c - distance * near.bend.c};
}

// The largest ratio of a form to a positive one.
double largest_ratio(const QuadraticForm& p, const QuadraticForm& metric)
{
    const double det = metric.determinant();
    const double mean = (metric.a * p.c - 2 * metric.b * p.b + metric.c * p.a) / (2 * det);
    return mean + std::sqrt(std::max(0.0, mean * mean - p.determinant() / det));
}

QuadraticForm minus(const QuadraticForm& p, const QuadraticForm& q, double times)
{
    return {p.a - times * q.a, p.b - times * q.b, p.c - times * q.c};
}

// A form nowhere above either: the first, less the metric times the most by which it exceeds the
// second.
QuadraticForm below_both(const QuadraticForm& p,
                         const QuadraticForm& q,
                         const QuadraticForm& metric)
{
    return minus(p, metric, std::max(0.0, largest_ratio(minus(p, q, 1), metric)));
}

// True if the shank clears the part of the surroundings that is higher than the centres.
//
// contact  mm: z of the end whose surroundings these are
// centre   mm: z of the lower centre
// apart    mm: distance of the ends in the metric
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
    // Lower bounds of the length of w for the lowest and the highest of these points.
    const double low = (centre - contact) / near.climb - 0.5 * apart;
    const double high = (near.top - contact) / near.climb - 0.5 * apart;
    const double spare = -largest_ratio(minus({}, rise, 1), near.metric);
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

// True if the bounds prove enough.
bool holds(const BezierCell::Surroundings& near, const CcPoint& at)
{
    if (!std::isfinite(near.extra_bend)) {
        return false;
    }
    const QuadraticForm rise = minus(rise_of(near, at.distance), near.metric, kSpare);
    return rise.never_negative() && clears_shank(rise, near, at.point.z, at.centre().z, 0);
}

}  // namespace

std::optional<double> MoveClearanceBound::move_clearance(const CcPoint& a,
                                                         const CcPoint& b,
                                                         double sufficient) const
{
    KnownContact from = state_.known(a);
    KnownContact to = state_.known(b);
    const std::optional<double> found = between(from, to, sufficient, 0);
    state_.remember(from);
    state_.remember(to);
    return found;
}

const BezierCell& MoveClearanceBound::cell_of(KnownContact& contact) const
{
    if (contact.cell != nullptr) {
        return *contact.cell;
    }
    const CcPoint& at = contact.at;
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
    contact.cell = cell;
    return *cell;
}

std::optional<double> MoveClearanceBound::between(KnownContact& a,
                                                  KnownContact& b,
                                                  double sufficient,
                                                  int depth) const
{
    const Cells cells{cell_of(a), cell_of(b)};
    if (!near_rise(a.at, cells.of_a, b.at, cells.of_b)) {
        return std::nullopt;
    }
    const double way = square(b.at.centre() - a.at.centre());
    // Points far from both ends, or only from one.
    const double share = &cells.of_a == &cells.of_b ? 8 : 2;
    const double margin =
        std::max(kUsualMargin * radius_, way / (share * std::min(a.at.distance, b.at.distance)));
    if (others_are_far(a, cells.of_a, margin) &&
        (way == 0 || others_are_far(b, cells.of_b, margin))) {
        return near_between(a, b, cells, sufficient, depth);
    }
    if (way == 0 || depth == kDeepest) {
        return std::nullopt;
    }
    std::optional<MiddleContact> middle = contact_of_middle(a.at, b.at);
    return middle ? parts_between(a, *middle, b, nullptr, sufficient, depth) : std::nullopt;
}

// The bound by near points alone. Precondition: far points are known to be far from the move
// between contacts in `cells`, of which this is a part.
std::optional<double> MoveClearanceBound::near_between(
    KnownContact& a, KnownContact& b, const Cells& cells, double sufficient, int depth) const
{
    const std::optional<QuadraticForm> rise = near_rise(a.at, cell_of(a), b.at, cell_of(b));
    if (!rise) {
        return std::nullopt;
    }
    const double way = square(b.at.centre() - a.at.centre());
    const double nearer = std::min(a.at.distance, b.at.distance);
    const double lost = 0.25 * std::max(0.0, way - (*rise)(b.at.u - a.at.u, b.at.v - a.at.v));
    const double least = std::sqrt(std::max(0.0, nearer * nearer - lost)) - radius_;
    if (least >= sufficient) {
        return least;
    }
    if (way == 0 || depth == kDeepest) {
        return std::nullopt;
    }
    std::optional<MiddleContact> middle = contact_of_middle(a.at, b.at);
    if (!middle) {
        return std::nullopt;
    }
    const BezierCell& cell = cell_of(middle->contact);
    const bool of_these = &cell == &cells.of_a || &cell == &cells.of_b;
    return parts_between(a, *middle, b, of_these ? &cells : nullptr, sufficient, depth);
}

// cells  null: far points have to be checked as well
std::optional<double> MoveClearanceBound::parts_between(KnownContact& a,
                                                        MiddleContact& middle,
                                                        KnownContact& b,
                                                        const Cells* cells,
                                                        double sufficient,
                                                        int depth) const
{
    const auto part = [&](KnownContact& from, KnownContact& to) {
        return cells != nullptr
                   ? near_between(from, to, *cells, sufficient + middle.from_middle, depth + 1)
                   : between(from, to, sufficient + middle.from_middle, depth + 1);
    };
    const std::optional<double> first = part(a, middle.contact);
    if (!first) {
        return std::nullopt;
    }
    const std::optional<double> second = part(middle.contact, b);
    return second ? std::optional{std::min(*first, *second) - middle.from_middle} : std::nullopt;
}

std::optional<QuadraticForm> MoveClearanceBound::near_rise(const CcPoint& a,
                                                           const BezierCell& cell_a,
                                                           const CcPoint& b,
                                                           const BezierCell& cell_b) const
{
    const BezierCell::Surroundings& near_a = *cell_a.surroundings();
    const BezierCell::Surroundings& near_b = *cell_b.surroundings();
    if (a.surface != b.surface || !std::isfinite(near_a.extra_bend) ||
        !std::isfinite(near_b.extra_bend)) {
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
    MiddleContact found{{{a.surface, 0.5 * (a.u + b.u), 0.5 * (a.v + b.v), {}, {}, 0}}, kInfinite};
    CcPoint& at = found.contact.at;
    for (int step = 0; step < kMiddleSteps; ++step) {
        const SurfacePoint p = model_.evaluate(at.surface, at.u, at.v);
        const Vec3d r = middle - p.point;
        at.point = p.point;
        at.normal = upward_normal(p);
        at.distance = dot(r, at.normal);
        found.from_middle = norm(r - at.normal * at.distance);
        if (found.from_middle < kMiddleSlack) {
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
    return found.from_middle < kMiddleSlack && inside && at.distance > 0 ? std::optional{found}
                                                                         : std::nullopt;
}

// True if everything but the surroundings is farther from the ball's core than the contact, by at
// least `margin`.
bool MoveClearanceBound::others_are_far(KnownContact& from,
                                        const BezierCell& cell,
                                        double margin) const
{
    if (from.margin >= margin) {
        return true;
    }
    const BezierCell::Surroundings& near = *cell.surroundings();
    const ToolCore ball{0, from.at.centre()};
    const double limit = from.at.distance + margin;
    const BezierCell::NearPatches* around = cell.near_patches();
    // Distances change by no more than the centre moves.
    if (around == nullptr || around->range < limit + norm(ball.end - around->centre)) {
        around = &find_patches(from.at, cell, limit);
    }
    const bool far = std::all_of(
        around->patches.begin(), around->patches.end(),
        [&](const BezierCell* patch) { return cell_is_far(*patch, ball, from.at, near, limit); });
    if (far) {
        from.margin = margin;
    }
    return far;
}

const BezierCell::NearPatches& MoveClearanceBound::find_patches(const CcPoint& from,
                                                                const BezierCell& cell,
                                                                double limit) const
{
    auto near = std::make_unique<BezierCell::NearPatches>();
    near->centre = cell.middle().point + cell.axes()[0] * from.distance;
    near->range = limit + std::max(kRangeMore * radius_, 1.1 * norm(from.centre() - near->centre));
    // The new range includes the old one: otherwise two distances in turn would each replace the
    // list of the other.
    if (const BezierCell::NearPatches* known = cell.near_patches()) {
        near->range = std::max(near->range, known->range + norm(near->centre - known->centre));
    }
    const ToolCore ball{0, near->centre};
    std::array<int, 128> stack{0};
    std::size_t count = 1;
    while (count > 0) {
        const BoxTree::Node& node = state_.tree.nodes[static_cast<std::size_t>(stack[--count])];
        if (ball.distance_to_box(node.low, node.high) >= near->range) {
            continue;
        }
        if (node.child[0] >= 0) {
            stack[count++] = node.child[0];
            stack[count++] = node.child[1];
            continue;
        }
        const std::size_t item = static_cast<std::size_t>(-node.child[0] - 1);
        if (item < state_.cells.size()) {
            near->patches.push_back(state_.cells[item].get());
        }
    }
    return cell.set_near_patches(std::move(near));
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
