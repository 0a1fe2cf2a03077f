// Nearest boxes first, then Newton's method on cells where the squared distance is proved convex.
#include "host_tools/geometry/part_model/nearest_search.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::part_model {

using nurbs::SurfacePoint;

namespace {

constexpr int kNewtonSteps = 12;
constexpr double kDistanceSlack = 2e-7;  // mm: how much too low a bound may be
constexpr double kDiscSlack = 1e-5;      // for flat and bull tools: distances not strictly convex
constexpr double kBeside = 0.01;         // mm over the nearest that still starts the next search
constexpr double kLeastCell = 1e-7;      // mm
constexpr int kManyCells = 256;          // of one search: edges are looked at before more of them

struct Symmetric {
    double ss;
    double st;
    double tt;
};

double least_eigenvalue(Symmetric m)
{
    const double half = 0.5 * (m.ss - m.tt);
    return 0.5 * (m.ss + m.tt) - std::sqrt(half * half + m.st * m.st);
}

// The second derivative of half the squared distance from the core, by the point: diagonal in
// (radial, tangential, vertical).
struct Stiffness {
    double radial;
    double tangential;
    double vertical;
    Vec3d outward;  // unit, horizontal; radial direction

    double product(Vec3d a, Vec3d b) const
    {
        const double along =
            (a.x * outward.x + a.y * outward.y) * (b.x * outward.x + b.y * outward.y);
        return tangential * (a.x * b.x + a.y * b.y) + (radial - tangential) * along +
               vertical * a.z * b.z;
    }
};

Stiffness stiffness_at(const ToolCore& core, Vec3d p)
{
    const double vertical = p.z < core.end.z ? 1 : 0;
    if (core.radius == 0) {
        return {1, 1, vertical, {1, 0, 0}};
    }
    const Vec3d out{p.x - core.end.x, p.y - core.end.y, 0};
    const double away = norm(out);
    if (away <= core.radius) {
        return {0, 0, vertical, {1, 0, 0}};
    }
    return {1, 1 - core.radius / away, vertical, out / away};
}

// From the core's axis to the cell's box, in plan.
double distance_from_axis(const ToolCore& core, const BezierCell& cell)
{
    const Vec3d low = cell.low();
    const Vec3d high = cell.high();
    return elementary::hypot(std::max({low.x - core.end.x, core.end.x - high.x, 0.0}),
                             std::max({low.y - core.end.y, core.end.y - high.y, 0.0}));
}

// A lower bound of the stiffness everywhere in the cell.
Stiffness least_stiffness(const ToolCore& core, const BezierCell& cell)
{
    const double vertical = cell.high().z < core.end.z ? 1 : 0;
    if (core.radius == 0) {
        return {1, 1, vertical, {1, 0, 0}};
    }
    // Beside the disc it is least in the tangential direction, and less the nearer the point is.
    const double away = distance_from_axis(core, cell);
    const double plane = away > core.radius ? 1 - core.radius / away : 0;
    return {plane, plane, vertical, {1, 0, 0}};
}

// Least eigenvalue of the second derivative of half the squared distance over the whole cell.
double least_curvature(const ToolCore& core, const BezierCell& cell)
{
    const SurfacePoint& m = cell.middle();
    const BezierCell::Spread& e = cell.spread();
    const Stiffness k = least_stiffness(core, cell);
    const Vec3d r = core.reach(m.point);
    const Symmetric middle{k.product(m.du, m.du) + dot(r, m.duu),
                           k.product(m.du, m.dv) + dot(r, m.duv),
                           k.product(m.dv, m.dv) + dot(r, m.dvv)};
    const double du = norm(m.du);
    const double dv = norm(m.dv);
    const double reach = norm(r) + e.point;
    const double stiff = std::max(k.radial, k.vertical);
    const double ss = stiff * (2 * du * e.ds + e.ds * e.ds) + e.point * norm(m.duu) + reach * e.dss;
    const double st =
        stiff * (du * e.dt + dv * e.ds + e.ds * e.dt) + e.point * norm(m.duv) + reach * e.dst;
    const double tt = stiff * (2 * dv * e.dt + e.dt * e.dt) + e.point * norm(m.dvv) + reach * e.dtt;
    return least_eigenvalue(middle) - std::max(ss, tt) - st;
}

// True if no point of the cell, edges that cut it aside, is the nearest of the surface: everywhere
// the direction to the core leans to the same side along u or v.
bool leans(const ToolCore& core, const BezierCell& cell)
{
    const SurfacePoint& m = cell.middle();
    const BezierCell::Spread& e = cell.spread();
    const Vec3d r = core.reach(m.point);
    const double reach = norm(r);
    const bool along_u =
        std::abs(dot(r, m.du)) > e.point * (norm(m.du) + e.ds) + reach * e.ds && !cell.ends_in_u();
    const bool along_v =
        std::abs(dot(r, m.dv)) > e.point * (norm(m.dv) + e.dt) + reach * e.dt && !cell.ends_in_v();
    return along_u || along_v;
}

// Newton's method on the unit square for half the squared distance.
struct CellMinimum {
    double s{0.5};
    double t{0.5};
    double value{};  // half the square of the distance there
    double below{};  // how much less it can be in the cell if it is convex there
    Vec3d point;
};

struct Step {
    double ds;
    double dt;
};

// The step to the minimum of the quadratic model over the unit square: inside, then along a side.
Step newton_step(Symmetric h, double gs, double gt, double s, double t)
{
    const double trace = std::abs(h.ss) + std::abs(h.tt) + 1e-300;
    const double least = least_eigenvalue(h);
    if (least < 1e-9 * trace) {
        const double lift = 1e-6 * trace - std::min(0.0, least);
        h.ss += lift;
        h.tt += lift;
    }
    const bool block_s = (s <= 0 && gs > 0) || (s >= 1 && gs < 0);
    const bool block_t = (t <= 0 && gt > 0) || (t >= 1 && gt < 0);
    if (block_s && block_t) {
        return {0, 0};
    }
    if (block_s) {
        return {0, -gt / h.tt};
    }
    if (block_t) {
        return {-gs / h.ss, 0};
    }
    const double det = h.ss * h.tt - h.st * h.st;
    Step step{(gt * h.st - gs * h.tt) / det, (gs * h.st - gt * h.ss) / det};
    const double s_end = std::clamp(s + step.ds, 0.0, 1.0);
    const double t_end = std::clamp(t + step.dt, 0.0, 1.0);
    if (s_end != s + step.ds && t_end == t + step.dt) {
        step = {s_end - s, -(gt + h.st * (s_end - s)) / h.tt};
    } else if (t_end != t + step.dt && s_end == s + step.ds) {
        step = {-(gs + h.st * (t_end - t)) / h.ss, t_end - t};
    }
    return step;
}

CellMinimum minimize(const ToolCore& core, const BezierCell& cell, double s, double t)
{
    CellMinimum best;
    best.value = kInfinite;
    SurfacePoint p = s == 0.5 && t == 0.5 ? cell.middle() : cell.at(s, t);
    Step tried{0, 0};
    for (int turn = 0; turn < kNewtonSteps; ++turn) {
        const Vec3d r = core.reach(p.point);
        const double value = 0.5 * dot(r, r);
        if (value > best.value) {
            if (turn + 1 == kNewtonSteps) {
                break;
            }
            // Too far: half the step from the best place.
            tried = {0.5 * tried.ds, 0.5 * tried.dt};
            s = std::clamp(best.s + tried.ds, 0.0, 1.0);
            t = std::clamp(best.t + tried.dt, 0.0, 1.0);
            p = cell.at(s, t);
            continue;
        }
        const double gs = dot(r, p.du);
        const double gt = dot(r, p.dv);
        const double below = std::max(gs * s, gs * (s - 1)) + std::max(gt * t, gt * (t - 1));
        best = {s, t, value, below, p.point};
        const double max_error = kDistanceSlack * std::sqrt(2 * value);
        if (below <= 1e-3 * max_error || value == 0) {
            break;
        }
        const Stiffness k = stiffness_at(core, p.point);
        const Symmetric h{k.product(p.du, p.du) + dot(r, p.duu),
                          k.product(p.du, p.dv) + dot(r, p.duv),
                          k.product(p.dv, p.dv) + dot(r, p.dvv)};
        tried = newton_step(h, gs, gt, s, t);
        const double s_next = std::clamp(s + tried.ds, 0.0, 1.0);
        const double t_next = std::clamp(t + tried.dt, 0.0, 1.0);
        tried = {s_next - s, t_next - t};
        if (tried.ds == 0 && tried.dt == 0) {
            break;
        }
        s = s_next;
        t = t_next;
        p = cell.at(s, t);
    }
    return best;
}

// The middle of the cell, without a step.
CellMinimum at_middle(const ToolCore& core, const BezierCell& cell)
{
    const SurfacePoint& p = cell.middle();
    const Vec3d r = core.reach(p.point);
    const double below = 0.5 * (std::abs(dot(r, p.du)) + std::abs(dot(r, p.dv)));
    return {0.5, 0.5, 0.5 * dot(r, r), below, p.point};
}

// The square of the distance from s to the farther end of [0, 1].
double farthest_square(double s)
{
    const double way = std::max(s, 1 - s);
    return way * way;
}

class Search {
public:
    Search(const PartModel::State& state, const ToolCore& core, const NearestOptions& options)
        : state_{state},
          history_{state.history()},
          core_{core},
          max_error_{std::max(options.max_error, core.radius > 0 ? kDiscSlack : kDistanceSlack)},
          near_enough_{options.near_enough},
          found_{options.limit},
          bound_{options.limit}
    {
    }

    NearestResult run()
    {
        if (history_.last_cell != nullptr) {
            first_ = history_.last_cell;
            look_at_cell(*first_, history_.last_s, history_.last_t);
        }
        if (!state_.facets.empty()) {
            look_at_facet(history_.last_facet);
        }
        std::array<Waiting, 128> stack;
        std::size_t count = 0;
        if (!state_.tree.nodes.empty()) {
            stack[count++] = {box_distance(0), 0};
        }
        while (count > 0 && found_ > near_enough_) {
            const Waiting next = stack[--count];
            if (next.distance >= found_) {
                continue;
            }
            const BoxTree::Node& node = state_.tree.nodes[static_cast<std::size_t>(next.node)];
            if (node.child[0] < 0) {
                look_at_items(node);
                continue;
            }
            Waiting near{box_distance(node.child[0]), node.child[0]};
            Waiting far{box_distance(node.child[1]), node.child[1]};
            if (far.distance < near.distance) {
                std::swap(near, far);
            }
            if (far.distance < found_) {
                stack[count++] = far;
            }
            if (near.distance < found_) {
                stack[count++] = near;
            }
        }
        return {std::min(bound_, found_), place_};
    }

private:
    struct Waiting {
        double distance;
        int node;
    };

    double box_distance(int node) const
    {
        const BoxTree::Node& n = state_.tree.nodes[static_cast<std::size_t>(node)];
        return core_.distance_to_box(n.low, n.high);
    }

    void take(double distance, const NearestPoint& place)
    {
        if (distance < found_) {
            found_ = distance;
            place_ = place;
        }
    }

    void look_at_items(const BoxTree::Node& leaf)
    {
        const std::size_t first = static_cast<std::size_t>(-leaf.child[0] - 1);
        if (state_.facets.empty()) {
            look_at_item(first);
            return;
        }
        for (std::size_t k = 0; k < static_cast<std::size_t>(leaf.child[1]); ++k) {
            look_at_facet(first + k);
        }
    }

    void look_at_item(std::size_t item)
    {
        if (item < state_.cells.size()) {
            if (state_.cells[item].get() != first_) {
                look_at_cell(*state_.cells[item], 0.5, 0.5);
            }
            return;
        }
        const std::size_t edge = item - state_.cells.size();
        Vec3d point;
        const double distance = std::max(
            0.0, edge_distance(core_, {state_.edges[edge], state_.edges[edge + 1]}, point) -
                     state_.edge_error);
        bound_ = std::min(bound_, distance);
        if (distance < found_) {
            take(distance, {point, 0, 0, state_.surface_of_edge(edge)});
        }
    }

    // All edges nearer than what is found.
    void look_at_edges()
    {
        std::vector<int> stack{0};
        while (!stack.empty() && found_ > near_enough_) {
            const int at = stack.back();
            stack.pop_back();
            const BoxTree::Node& node = state_.tree.nodes[static_cast<std::size_t>(at)];
            if (box_distance(at) >= found_) {
                continue;
            }
            if (node.child[0] >= 0) {
                stack.insert(stack.end(), {node.child[0], node.child[1]});
                continue;
            }
            const std::size_t item = static_cast<std::size_t>(-node.child[0] - 1);
            if (item >= state_.cells.size()) {
                look_at_item(item);
            }
        }
    }

    void look_at_facet(std::size_t facet)
    {
        Vec3d point;
        const double distance = facet_distance(core_, state_.facets[facet], point, found_);
        if (distance < found_) {
            history_.last_facet = facet;
        }
        take(distance, {point, 0, 0, static_cast<int>(state_.regions.size())});
    }

    // Depth first; depth is bounded by kLeastCell (each halving shrinks the cell).
    // If the nearest point of an untrimmed surface lies beyond a long trim, all cells along that are
    // halved, as deep as they may be, in search of a point inside: the trim itself is nearer by then.
    void look_at_cell(const BezierCell& cell, double s, double t)
    {
        if (++looked_at_ == kManyCells) {
            look_at_edges();
        }
        if (looked_at_ >= kManyCells && found_ <= near_enough_) {
            return;
        }
        if (oriented_distance(core_, cell) >= found_ ||
            core_.distance_to_box(cell.low(), cell.high()) >= found_ ||
            state_.outside_trims(cell)) {
            return;
        }
        const double bend = std::max(0.0, -least_curvature(core_, cell));
        // With too much of it the minimum would not settle the cell: the middle is enough.
        const bool settles =
            bend <= max_error_ * norm(core_.reach(cell.middle().point)) || &cell == first_;
        const CellMinimum least = settles ? minimize(core_, cell, s, t) : at_middle(core_, cell);
        const double distance = std::sqrt(2 * least.value);
        // The distance is at least this over the cell, a unit square.
        const double sag = bend * 0.5 * (farthest_square(least.s) + farthest_square(least.t));
        const double at_least = std::sqrt(2 * std::max(0.0, least.value - least.below - sag));
        const bool settled = distance - at_least <= max_error_;
        const double u = cell.u(least.s);
        const double v = cell.v(least.t);
        const bool counts = (settled || distance < found_) &&
                            (cell.trim() != BezierCell::Trim::kCut ||
                             state_.regions[static_cast<std::size_t>(cell.surface())].inside(u, v));
        if (counts) {
            take(distance, {least.point, u, v, cell.surface()});
        }
        if (found_ <= near_enough_) {
            bound_ = std::min(bound_, found_);
            return;
        }
        if (settled) {
            if (counts) {
                bound_ = std::min(bound_, at_least);
                if (distance < found_ + kBeside) {
                    history_.last_cell = &cell;
                    history_.last_s = least.s;
                    history_.last_t = least.t;
                }
            }
            return;
        }
        // Edges are items of their own.
        if (at_least >= found_ || (cell.trim() == BezierCell::Trim::kCut && leans(core_, cell))) {
            return;
        }
        if (cell.spread().point < kLeastCell) {
            bound_ = std::min(bound_, std::max(0.0, distance - 2 * kLeastCell));
            return;
        }
        const auto [a, b] = cell.halves();
        const bool a_first = core_.distance_to_box(a->low(), a->high()) <=
                             core_.distance_to_box(b->low(), b->high());
        look_at_cell(a_first ? *a : *b, 0.5, 0.5);
        look_at_cell(a_first ? *b : *a, 0.5, 0.5);
    }

    const PartModel::State& state_;
    PartModel::State::History& history_;
    const ToolCore& core_;
    double max_error_;
    double near_enough_;
    double found_;
    double bound_;
    NearestPoint place_;
    const BezierCell* first_{nullptr};
    int looked_at_{0};  // cells
};

}  // namespace

NearestResult nearest(const PartModel::State& state,
                      const ToolCore& core,
                      const NearestOptions& options)
{
    // Cells know points and discs: over surfaces a cone counts as the cylinder round it.
    const bool is_cone = core.widening > 0 && state.facets.empty();
    const ToolCore used = is_cone ? ToolCore{core.widest, core.end} : core;
    return Search{state, used, options}.run();
}

bool is_core_distance_at_least(const PartModel::State& state, const ToolCore& core, double least)
{
    return nearest(state, core, {least, 0, std::nextafter(least, 0.0)}).distance >= least;
}

}  // namespace cusp::part_model
