// Distances, clearances of straight moves, and the drop, all by the search for the nearest point.
#include "host_tools/geometry/part_model/part_model.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/geometry/part_model/facet_move.hpp"
#include "host_tools/geometry/part_model/facet_search.hpp"
#include "host_tools/geometry/part_model/move_clearance_bound.hpp"
#include "host_tools/geometry/part_model/nearest_search.hpp"
#include "host_tools/geometry/part_model/surface_cut.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace cusp::part_model {

using nurbs::BezierPatch;
using nurbs::crease_knots;
using nurbs::Surface;
using nurbs::SurfacePoint;
using toolpath::Tool;
using toolpath::ToolShape;

namespace {

constexpr int kMostDropSteps = 400;
constexpr int kMostClimbs = 6;
constexpr int kMostSlow = 3;  // steps in a row that leave more than kSlowShare of the interval
constexpr double kSlowShare = 0.75;
constexpr double kTouching = 1e-9;   // mm
constexpr double kDropSlack = 5e-7;  // mm above the least height
constexpr double kDiscDropSlack = 2e-5;
constexpr std::size_t kMostHalves = 100'000;  // 0.1 GB
constexpr std::size_t kWorthReturning = 50'000;

void add_cells(const Surface& surface, int number, PartModel::State& state)
{
    PartModel::State::Grid grid;
    grid.first = state.cells.size();
    for (const BezierPatch& patch : bezier_patches(surface)) {
        state.cells.push_back(std::make_unique<BezierCell>(patch, number, &state.halves));
        if (grid.u.empty() || patch.u_begin > grid.u.back()) {
            grid.u.push_back(patch.u_begin);
        }
        if (grid.u.size() == 1) {
            grid.v.push_back(patch.v_begin);
        }
    }
    grid.creases_u =
        crease_knots(surface.knots_u, surface.degree_u, static_cast<std::size_t>(surface.size_u));
    grid.creases_v =
        crease_knots(surface.knots_v, surface.degree_v, static_cast<std::size_t>(surface.size_v));
    state.grids.push_back(std::move(grid));
}

// Height of the tip at which the tool, dropped from above, is `fat` (mm) from the point; none where
// it passes the point.
std::optional<double> touch_height(const Tool& tool, double x, double y, Vec3d p, double fat = 0)
{
    const double away = elementary::hypot(p.x - x, p.y - y);
    if (away > tool.radius + fat) {
        return std::nullopt;
    }
    const double flat = tool.radius - tool.corner_radius;
    const double out = std::max(0.0, away - flat);
    const double corner = tool.corner_radius + fat;
    return p.z - tool.corner_radius + std::sqrt(std::max(0.0, corner * corner - out * out));
}

// Lower bound of the core's distance between two positions, `length` apart, with distances d0 and
// d1.
double least_between(double d0, double d1, double length)
{
    if (length <= 0) {
        return std::min(d0, d1);
    }
    // d(t)^2 - t^2 is concave: d(t)^2 >= d0^2 - 2 t at + t^2.
    const double at = 0.5 * (length - (d1 * d1 - d0 * d0) / length);
    if (at <= 0) {
        return d0;
    }
    if (at >= length) {
        return d1;
    }
    return std::sqrt(std::max(0.0, d0 * d0 - at * at));
}

class ChordBound {
public:
    ChordBound(const PartModel& model, const Tool& tool, double sufficient, double resolution)
        : model_{model}, tool_{tool}, sufficient_{sufficient}, resolution_{resolution}
    {
    }

    double clearance(Vec3d tip, double reach)
    {
        const double found =
            model_.distance_within(tool_, tip, {-kInfinite, sufficient_ + reach, resolution_});
        least_seen_ = std::min(least_seen_, found);
        return found;
    }

    double between(Vec3d a, double at_a, Vec3d b, double at_b)
    {
        const double length = norm(b - a);
        const double corner = tool_.corner_radius;
        const double bound = least_between(at_a + corner, at_b + corner, length) - corner;
        if (bound >= sufficient_ || bound >= least_seen_ - resolution_) {
            return bound;
        }
        const Vec3d middle = (a + b) * 0.5;
        const double there = clearance(middle, 0.5 * length);
        const double first = between(a, at_a, middle, there);
        return std::min(first, between(middle, there, b, at_b));
    }

private:
    const PartModel& model_;
    const Tool& tool_;
    double sufficient_;
    double resolution_;
    double least_seen_{kInfinite};
};

}  // namespace

PartModel::PartModel(const std::vector<Surface>& surfaces, double edge_error)
    : state_{std::make_unique<State>()}
{
    State& state = *state_;
    state.edge_error = edge_error;
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        add_cells(surfaces[k], static_cast<int>(k), state);
        state.regions.emplace_back(surfaces[k], edge_error);
    }
    std::vector<std::array<Vec3d, 2>> boxes;
    std::vector<std::uint32_t> numbers;
    const auto add_box = [&](Vec3d a, Vec3d b, std::size_t number) {
        boxes.push_back({Vec3d{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)},
                         Vec3d{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}});
        numbers.push_back(static_cast<std::uint32_t>(number));
    };
    for (std::size_t k = 0; k < state.cells.size(); ++k) {
        add_box(state.cells[k]->low(), state.cells[k]->high(), k);
    }
    for (std::size_t k = 0; k < surfaces.size(); ++k) {
        state.first_edges.push_back(state.edges.size());
        for (const std::vector<Vec3d>& loop : state.regions[k].edges(surfaces[k])) {
            const std::size_t first = state.cells.size() + state.edges.size();
            for (std::size_t at = 0; at + 1 < loop.size(); ++at) {
                add_box(loop[at], loop[at + 1], first + at);
            }
            state.edges.insert(state.edges.end(), loop.begin(), loop.end());
        }
    }
    state.edges.shrink_to_fit();
    state.tree = make_box_tree(boxes, numbers);
    if (!state.tree.nodes.empty()) {
        state.low = state.tree.nodes.front().low;
        state.high = state.tree.nodes.front().high;
    }
}

PartModel::PartModel(const std::vector<std::array<Vec3d, 3>>& triangles)
    : state_{std::make_unique<State>()}
{
    std::vector<std::uint32_t> order;
    state_->tree = make_facet_tree(triangles, order);
    state_->facets.reserve(order.size());
    for (const std::uint32_t number : order) {
        state_->facets.emplace_back(triangles[number]);
    }
    if (!state_->tree.nodes.empty()) {
        state_->low = state_->tree.nodes.front().low;
        state_->high = state_->tree.nodes.front().high;
    }
}

PartModel::~PartModel() = default;
PartModel::PartModel(PartModel&&) noexcept = default;
PartModel& PartModel::operator=(PartModel&&) noexcept = default;

bool PartModel::is_mesh() const { return !state_->facets.empty(); }

std::optional<PartModel::DroppedBall> PartModel::drop_ball(double x, double y, double radius) const
{
    Tool ball;
    ball.radius = ball.corner_radius = radius;
    const std::optional<MeshContact> found = drop_on_facets(*state_, ToolProfile{ball}, x, y);
    if (!found) {
        return std::nullopt;
    }
    const Facet& facet = state_->facets[found->facet];
    return DroppedBall{{x, y, found->at.centre}, found->at.point, facet.normal, &facet};
}

std::optional<PartModel::DroppedTool> PartModel::drop_tool(const Tool& tool,
                                                           double x,
                                                           double y) const
{
    const std::optional<MeshContact> found = drop_on_facets(*state_, ToolProfile{tool}, x, y);
    if (!found) {
        return std::nullopt;
    }
    return DroppedTool{{x, y, found->at.centre - tool.corner_radius},
                       found->at.point,
                       state_->facets[found->facet].normal,
                       found->lean};
}

PartModel::Blocked PartModel::blocked(const Tool& tool,
                                      const std::array<Vec3d, 3>& tips,
                                      double least) const
{
    const double near = least + tool.corner_radius;
    const auto by_last = [&] {
        const Facet& facet = state_->facets[state_->history().last_facet];
        Vec3d place;
        return std::all_of(tips.begin(), tips.end(), [&](Vec3d tip) {
            return facet_distance(core_of(tool, tip), facet, place, near) < near;
        });
    };
    if (by_last()) {
        return Blocked::kByOneFacet;
    }
    const Vec3d middle = (tips[0] + tips[1] + tips[2]) / 3.0;
    if (nearest(*state_, core_of(tool, middle), {near}).place.surface < 0) {
        return Blocked::kFree;
    }
    return by_last() ? Blocked::kByOneFacet : Blocked::kHere;
}

std::optional<PartModel::TopPoint> PartModel::height_at(double x, double y) const
{
    const std::optional<FacetUnder> found = highest_facet(*state_, x, y);
    if (!found) {
        return std::nullopt;
    }
    return TopPoint{{x, y, found->height}, state_->facets[found->facet].normal};
}

Vec3d PartModel::box_low() const { return state_->low; }
Vec3d PartModel::box_high() const { return state_->high; }

double PartModel::highest() const
{
    // A tool as wide as the model rests on its highest point.
    Tool wide;
    wide.shape = ToolShape::kFlat;
    wide.radius = norm(state_->high - state_->low);
    const Vec3d middle = 0.5 * (state_->low + state_->high);
    return drop_height(wide, middle.x, middle.y).value_or(state_->low.z);
}

bool PartModel::inside_trims(int surface, double u, double v) const
{
    return state_->regions[static_cast<std::size_t>(surface)].inside(u, v);
}

bool PartModel::outside_trims(int surface, Vec2d low, Vec2d high) const
{
    const TrimRegion& region = state_->regions[static_cast<std::size_t>(surface)];
    return region.trimmed() &&
           region.part(low.x, high.x, low.y, high.y) == TrimRegion::Part::kOutside;
}

std::optional<TrimRegion::Beside> PartModel::beside_trims(int surface, Vec2d low, Vec2d high) const
{
    return state_->regions[static_cast<std::size_t>(surface)].beside(low, high);
}

double PartModel::edge_error() const { return state_->edges.empty() ? 0 : state_->edge_error; }

SurfacePoint PartModel::evaluate(int surface, double u, double v) const
{
    const BezierCell& cell = state_->cell_at(surface, u, v);
    return cell.by_domain(cell.at(cell.s_of(u), cell.t_of(v)));
}

SurfacePoint PartModel::tangents(int surface, double u, double v) const
{
    const BezierCell& cell = state_->cell_at(surface, u, v);
    SurfacePoint p = cell.tangents_at(cell.s_of(u), cell.t_of(v));
    p.du = p.du / (cell.u_end() - cell.u_begin());
    p.dv = p.dv / (cell.v_end() - cell.v_begin());
    return p;
}

SurfaceCut PartModel::cut_at(int surface, double u) const { return {*this, *state_, surface, u}; }

ToolDistance PartModel::distance(const Tool& tool, Vec3d tip, double limit) const
{
    const NearestResult found =
        nearest(*state_, core_of(tool, tip), {std::max(0.0, limit + tool.corner_radius)});
    return {found.distance - tool.corner_radius, found.place};
}

void PartModel::forget_cells() const
{
    [[maybe_unused]] const bool many =
        state_->halves > kWorthReturning || state_->released.exchange(false);
    state_->forget_cells();
#ifdef __GLIBC__
    // The allocator would keep it: of 840 MB of a plan 380 were in use.
    if (many) {
        malloc_trim(0);
    }
#endif
}

void PartModel::forget_queries() const { state_->history() = {}; }

void PartModel::forget_many_cells() const
{
    if (state_->sharers == 0 && state_->halves > kMostHalves) {
        forget_cells();
    }
}

std::size_t PartModel::kept_cells() const { return state_->halves; }

PartModel::SharedQueries::SharedQueries(const PartModel& model) : model_{model}
{
    model_.forget_many_cells();
    ++model_.state_->sharers;
}

// True if and when parts release cells depends on the threads. After the loop this does not hold:
// all halves are kept, or none if they are too many.
PartModel::SharedQueries::~SharedQueries()
{
    --model_.state_->sharers;
    if (model_.state_->sharers == 0 && model_.state_->released) {
        model_.forget_cells();
    }
    model_.forget_many_cells();
}

PartModel::SharedQueries::Part::Part(const PartModel& model) : model_{model} { begin(); }

PartModel::SharedQueries::Part::~Part() { model_.state_->parts.unlock_shared(); }

// A thread that waits to release cells gets its turn only where all others unlock.
void PartModel::SharedQueries::Part::next() const
{
    model_.state_->parts.unlock_shared();
    begin();
}

void PartModel::SharedQueries::Part::begin() const
{
    State& state = *model_.state_;
    state.parts.lock_shared();
    if (state.halves > kMostHalves) {
        state.parts.unlock_shared();
        state.parts.lock();
        if (state.halves > kMostHalves) {
            // The next parts need the memory again: to return it would take as long as to release it.
            state.forget_cells();
            state.released = true;
        }
        state.parts.unlock();
        state.parts.lock_shared();
    }
    model_.forget_queries();
}

double PartModel::distance_within(const Tool& tool, Vec3d tip, const DistanceOptions& options) const
{
    const NearestResult found = nearest(*state_, core_of(tool, tip),
                                        {std::max(0.0, options.max_distance + tool.corner_radius),
                                         options.max_error, options.least + tool.corner_radius});
    return found.distance - tool.corner_radius;
}

bool PartModel::is_distance_at_least(const Tool& tool, Vec3d tip, double least) const
{
    return least + tool.corner_radius <= 0 ||
           is_core_distance_at_least(*state_, core_of(tool, tip), least + tool.corner_radius);
}

double PartModel::move_clearance(
    const Tool& tool, Vec3d a, Vec3d b, double sufficient, double resolution) const
{
    if (is_mesh()) {
        const double least = sufficient + tool.corner_radius;
        return least <= 0
                   ? sufficient
                   : least_facet_distance(*state_, core_of(tool, a), b - a, least, resolution) -
                         tool.corner_radius;
    }
    ChordBound chord{*this, tool, sufficient, resolution};
    const double reach = 0.5 * norm(b - a);
    const double at_a = chord.clearance(a, reach);
    const double at_b = chord.clearance(b, reach);
    return std::min(sufficient, chord.between(a, at_a, b, at_b));
}

std::optional<double> PartModel::move_clearance_between_contacts(const CcPoint& a,
                                                                 const CcPoint& b,
                                                                 double radius,
                                                                 double sufficient) const
{
    return MoveClearanceBound{*this, *state_, radius}.move_clearance(a, b, sufficient);
}

std::optional<double> PartModel::drop_height(const Tool& tool,
                                             double x,
                                             double y,
                                             std::optional<double> guess) const
{
    const std::optional<DroppedCutter> found = drop_cutter(tool, x, y, guess);
    return found ? std::optional{found->tip} : std::nullopt;
}

// Sphere tracing downwards, with a lower bound from the points touched. Over 60 lines: the steps of
// one iteration share its bounds.
std::optional<PartModel::DroppedCutter> PartModel::drop_cutter(const Tool& tool,
                                                               double x,
                                                               double y,
                                                               std::optional<double> guess) const
{
    if (is_mesh()) {
        const std::optional<MeshContact> found = drop_on_facets(*state_, ToolProfile{tool}, x, y);
        return found ? std::optional{DroppedCutter{found->at.centre - tool.corner_radius, {}}}
                     : std::nullopt;
    }
    const double floor = state_->low.z - tool.radius - 1;
    const double nothing = -kInfinite;
    // At `high` the tool is clear. At `low` it touches a known point, so the result is not below.
    double high = state_->high.z + 0.01;
    double low = nothing;
    double trial = guess ? std::min(*guess, high) : high;
    // The next query is usually near the last one, and so is its result. The distance of a flat
    // tool does not measure its depth, so a flat tool starts from above.
    const bool measures_depth = tool.corner_radius > 0;
    const State::History& history = state_->history();
    if (!guess && measures_depth && history.last_cell != nullptr) {
        const Vec3d last = history.last_cell->at(history.last_s, history.last_t).point;
        if (const auto touch = touch_height(tool, x, y, last)) {
            low = *touch;
            trial = low;
        }
    }
    const double max_error = tool.corner_radius < tool.radius ? kDiscDropSlack : kDropSlack;
    int deep = 0;
    int slow = 0;
    double room = kInfinite;
    NearestPoint place;
    for (int step = 0; step < kMostDropSteps && high - low > max_error; ++step) {
        const ToolDistance c = distance(tool, {x, y, trial}, kInfinite);
        if (c.nearest.surface < 0) {
            return std::nullopt;
        }
        place = c.nearest;
        const double was_low = low;
        // Distances may be too low, near trimmed edges above all. The point counts as thick as this
        // error: otherwise each step would touch it at `low` and be clear just above, forever.
        const double fat = norm(core_of(tool, {x, y, trial}).reach(c.nearest.point)) -
                           (c.distance + tool.corner_radius);
        if (const auto touch = touch_height(tool, x, y, c.nearest.point, std::max(0.0, fat))) {
            low = std::max(low, *touch);
        }
        if (c.distance >= -kTouching && trial <= high) {
            // The tool may drop by its distance from the model.
            high = trial - std::max(0.0, c.distance);
            if (c.distance <= max_error && tool.corner_radius > 0 && trial <= low + kTouching) {
                return DroppedCutter{trial, place};
            }
        }
        if (high < floor) {
            return std::nullopt;
        }
        const bool cut_a_little = tool.corner_radius > 0 && c.distance > -0.5 * tool.corner_radius;
        // Beside a vertical rim each step is as short as the distance from the rim: then the next
        // trial is half way down. A tool that is clear there can be lifted out, since its shank
        // covers everything above.
        const double bottom = std::max(low, floor - tool.radius);
        slow = high - bottom > kSlowShare * room ? slow + 1 : 0;
        room = high - bottom;
        if (measures_depth && slow >= kMostSlow) {
            trial = 0.5 * (bottom + high);
            continue;
        }
        // A deep gouge, but its point is known now: the next trial touches that.
        const bool climbs = measures_depth && low > was_low + max_error && ++deep <= kMostClimbs;
        trial =
            low > nothing && (cut_a_little || climbs) && trial != low && low < high ? low : high;
    }
    return DroppedCutter{high, place};
}

}  // namespace cusp::part_model
