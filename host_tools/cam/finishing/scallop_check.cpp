// Cells are halved across the passes until one move covers each half.
#include "host_tools/cam/finishing/scallop_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host_tools/cam/finishing/finish_area.hpp"
#include "host_tools/geometry/nurbs/knot_insertion.hpp"

namespace cusp::finishing {

using nurbs::knots_between;
using nurbs::Surface;
using nurbs::SurfacePoint;

namespace {

// Sizes of cells, in stepovers.
constexpr double kSmallest = 1.0 / 96;
constexpr double kLargest = 4;
constexpr double kBorderCell = 0.03;  // smallest across a border that the ball overhangs
constexpr double kSteepCell = 0.04;   // smallest where the stock left has a steep step
constexpr double kGapCell = 0.125;    // smallest below a gap between surfaces
// Share of the scallop: a step between corners so high is steep.
constexpr double kSteepShare = 4.0;
constexpr double kBorderSlack = 1e-6;  // of a surface's domain

double largest(const std::array<double, 4>& of) { return *std::max_element(of.begin(), of.end()); }

}  // namespace

ScallopCheck::ScallopCheck(const std::vector<Surface>& surfaces,
                           const GougeFreePathFitter& path_fitter,
                           double scallop,
                           double path_off,
                           std::size_t most_gaps)
    : surfaces_{surfaces},
      path_fitter_{path_fitter},
      radius_{path_fitter.tool().radius},
      scallop_{scallop},
      path_off_{path_off},
      max_uncovered_{most_gaps},
      places_{surfaces, path_fitter, scallop, path_off},
      walls_{path_fitter, places_}
{
}

void ScallopCheck::add(const Points& tips)
{
    if (has_checked_) {
        places_.add(tips);
    } else {
        waiting_.push_back(tips);
    }
}

ScallopCheck::Corner ScallopCheck::corner(int surface, double u, double v) const
{
    Corner out{surface, u, v, path_fitter_.model().evaluate(surface, u, v), {}};
    out.normal = path_fitter_.model().facing_up(surface, u, v, out.point);
    return out;
}

// True if a point belongs to the surface. Trims along a border may miss it by rounding.
bool ScallopCheck::inside_trims(int surface, double u, double v) const
{
    const Surface& s = surfaces_[static_cast<std::size_t>(surface)];
    const double slack_u = kBorderSlack * (s.u_end() - s.u_begin());
    const double slack_v = kBorderSlack * (s.v_end() - s.v_begin());
    return path_fitter_.model().inside_trims(
        surface, std::clamp(u, s.u_begin() + slack_u, s.u_end() - slack_u),
        std::clamp(v, s.v_begin() + slack_v, s.v_end() - slack_v));
}

// True if a ball can touch the point.
bool ScallopCheck::is_clear(const Corner& at) const
{
    return dot(at.normal, at.normal) > 0 &&
           path_fitter_.is_clear(places_.touching_tip(at.point.point, at.normal));
}

std::array<ScallopCheck::Corner, 4> ScallopCheck::corners_of(const Cell& cell) const
{
    return {corner(cell.surface, cell.u0, cell.v0), corner(cell.surface, cell.u1, cell.v0),
            corner(cell.surface, cell.u0, cell.v1), corner(cell.surface, cell.u1, cell.v1)};
}

ScallopCheck::Corner ScallopCheck::middle_of(const Cell& cell) const
{
    return corner(cell.surface, 0.5 * (cell.u0 + cell.u1), 0.5 * (cell.v0 + cell.v1));
}

std::array<ScallopCheck::Cell, 2> ScallopCheck::halves_of(const Cell& cell, bool along_u)
{
    std::array<Cell, 2> out{cell, cell};
    if (along_u) {
        out[0].u1 = out[1].u0 = 0.5 * (cell.u0 + cell.u1);
    } else {
        out[0].v1 = out[1].v0 = 0.5 * (cell.v0 + cell.v1);
    }
    return out;
}

// mm: distances of the first corner from its two neighbours.
std::array<double, 2> ScallopCheck::sides_of(const Cell& cell) const
{
    const auto at = [&](double u, double v) {
        return path_fitter_.model().evaluate(cell.surface, u, v).point;
    };
    const Vec3d first = at(cell.u0, cell.v0);
    return {norm(at(cell.u1, cell.v0) - first), norm(at(cell.u0, cell.v1) - first)};
}

ScallopCheck::CellShape ScallopCheck::shape_of(const Cell& cell, const std::array<Corner, 4>& at)
{
    const double width_u = cell.u1 - cell.u0;
    const double width_v = cell.v1 - cell.v0;
    std::array<double, 4> along_u{};
    std::array<double, 4> along_v{};
    std::array<double, 4> bow{};
    CellShape shape{0, 0, 0, 0, 1};
    for (std::size_t k = 0; k < 4; ++k) {
        const SurfacePoint& p = at[k].point;
        along_u[k] = norm(p.du) * width_u;
        along_v[k] = norm(p.dv) * width_v;
        bow[k] = 0.25 * (norm(p.duu) * width_u * width_u + norm(p.dvv) * width_v * width_v);
        shape.turn = std::max(shape.turn, norm(at[k].normal - at[0].normal));
        shape.least_z = std::min(shape.least_z, at[k].normal.z);
    }
    shape.bow = largest(bow);
    shape.long_u = std::max(largest(along_u), norm(at[1].point.point - at[0].point.point));
    shape.long_v = std::max(largest(along_v), norm(at[2].point.point - at[0].point.point));
    return shape;
}

// Over 60 lines: a list of cases, each of which may decide.
ScallopCheck::Verdict ScallopCheck::judge(const Cell& cell, const std::array<Corner, 4>& at) const
{
    ++judged_;
    const CellShape shape = shape_of(cell, at);
    const double long_u = shape.long_u;
    const double long_v = shape.long_v;
    const double size = std::max(long_u, long_v);
    const Verdict longer = long_u >= long_v ? Verdict::kHalveU : Verdict::kHalveV;
    if (size > kSmallest * places_.step() &&
        (size > kLargest * places_.step() || shape.turn > 0.5)) {
        return longer;
    }
    const bool along_z = shape.least_z >= kSteepNormal;
    const double bend = along_z ? shape.turn / shape.least_z : shape.turn;
    const double shrink = path_off_ + shape.bow + 0.5 * scallop_ * bend * bend;
    const Corner middle = middle_of(cell);
    if (path_fitter_.area().is_beyond(middle.point.point, size, middle.normal, 2 * shape.turn)) {
        return Verdict::kCovered;
    }
    const Vec3d middle_top = raised(middle.point.point, middle.normal, scallop_,
                                    along_z && middle.normal.z >= kSteepNormal);
    places_.swept().near(centre_under(middle_top, middle.normal, scallop_, radius_), near_);
    std::array<Vec3d, 4> tops{};
    for (std::size_t k = 0; k < 4; ++k) {
        tops[k] = raised(at[k].point.point, at[k].normal, scallop_, along_z);
    }
    // together[bits]: some move covers exactly these corners.
    std::array<bool, 16> together{};
    for (const std::uint32_t move : near_) {
        unsigned covers = 0;
        for (unsigned k = 0; k < 4; ++k) {
            if (places_.swept().removes(move, tops[k], shrink)) {
                covers |= 1U << k;
            }
        }
        if (covers == 15) {
            return Verdict::kCovered;
        }
        together[covers] = true;
    }
    const auto some = [&](unsigned corners) {
        for (unsigned k = corners; k < 16; ++k) {
            if ((k & corners) == corners && together[k]) {
                return true;
            }
        }
        return false;
    };
    if (size < kBlockedCell * places_.step()) {
        if (blocked_somewhere(at)) {
            return thinned(cell, at, long_u, long_v);
        }
        if (is_uncovered(at)) {
            return Verdict::kUncovered;
        }
    } else if (size < kSettledCell * places_.step() && settled(cell, at, middle)) {
        return Verdict::kCovered;
    }
    if (size < kSmallest * places_.step()) {
        const bool each =
            std::all_of(at.begin(), at.end(), [&](const Corner& c) { return is_covered(c); });
        return each ? Verdict::kCovered : Verdict::kUncovered;
    }
    const double least = 0.5 * kSmallest * places_.step();
    if (long_u > least && long_v > least) {
        if (some(3) && some(12)) {
            return Verdict::kHalveV;
        }
        if (some(5) && some(10)) {
            return Verdict::kHalveU;
        }
    }
    if (near_.empty() && size < places_.step() &&
        ((lies_under_others(cell, at) && !silhouette_above(at)) || lies_under_itself(at, middle))) {
        return Verdict::kCovered;
    }
    return longer;
}

// Refines cells with blocked corners where one point does not represent the next: at borders, where
// the ball gets lower the nearer a point is, and beside cliffs.
ScallopCheck::Verdict ScallopCheck::thinned(const Cell& cell,
                                            const std::array<Corner, 4>& at,
                                            double long_u,
                                            double long_v) const
{
    const Verdict longer = long_u >= long_v ? Verdict::kHalveU : Verdict::kHalveV;
    if (lies_under_others(cell, at)) {
        if (!silhouette_above(at)) {
            return Verdict::kCovered;
        }
        if (std::max(long_u, long_v) > kGapCell * places_.step()) {
            return longer;
        }
        // Neighbouring cells check the other corners.
        if (is_hidden(middle_of(cell)) && is_hidden(at.front())) {
            return Verdict::kCovered;
        }
    }
    const Surface& s = surfaces_[static_cast<std::size_t>(cell.surface)];
    const double thin = kBorderCell * places_.step();
    if (long_u > thin && (cell.u0 == s.u_begin() || cell.u1 == s.u_end())) {
        return Verdict::kHalveU;
    }
    if (long_v > thin && (cell.v0 == s.v_begin() || cell.v1 == s.v_end())) {
        return Verdict::kHalveV;
    }
    return is_steep(at) ? longer : Verdict::kUncovered;
}

// True if the cell is wider than kSteepCell, and either a trim separates its corners or the stock
// over them differs steeply.
bool ScallopCheck::is_steep(const std::array<Corner, 4>& at) const
{
    const double wide = kSteepCell * places_.step();
    if (norm(at[1].point.point - at[0].point.point) < wide &&
        norm(at[2].point.point - at[0].point.point) < wide) {
        return false;
    }
    double least = kInfinite;
    double most = -least;
    int outside = 0;
    for (const Corner& c : at) {
        if (!inside_trims(c.surface, c.u, c.v)) {
            ++outside;
            continue;
        }
        const Vec3d p = c.point.point;
        const double height = places_.swept().lowest(p.x, p.y).height;
        if (std::isfinite(height)) {
            least = std::min(least, (height - p.z) * c.normal.z);
            most = std::max(most, (height - p.z) * c.normal.z);
        }
    }
    return (outside > 0 && outside < 4) || most - least > kSteepShare * scallop_;
}

// True if some corner is uncovered and the tool cannot touch it.
bool ScallopCheck::blocked_somewhere(const std::array<Corner, 4>& at) const
{
    return std::any_of(at.begin(), at.end(), [&](const Corner& c) { return blocked(c); });
}

// True if all corners are uncovered and the tool can touch them: a pass is cut there before the
// cell is halved.
bool ScallopCheck::is_uncovered(const std::array<Corner, 4>& at) const
{
    return std::all_of(at.begin(), at.end(), [&](const Corner& c) {
        return inside_trims(c.surface, c.u, c.v) && !is_covered(c) && is_clear(c);
    });
}

// True if the tool can touch no corner of the cell and could remove next to nothing at its middle.
// Never at borders and beside cliffs, where one point does not represent the next.
bool ScallopCheck::settled(const Cell& cell,
                           const std::array<Corner, 4>& at,
                           const Corner& middle) const
{
    const Surface& s = surfaces_[static_cast<std::size_t>(cell.surface)];
    const auto inside = [&](const Corner& c) {
        return c.normal.z >= kUprightNormal && inside_trims(c.surface, c.u, c.v);
    };
    return cell.u0 > s.u_begin() && cell.u1 < s.u_end() && cell.v0 > s.v_begin() &&
           cell.v1 < s.v_end() && inside(middle) &&
           std::all_of(at.begin(), at.end(),
                       [&](const Corner& c) { return inside(c) && blocked(c); }) &&
           !is_steep(at) && !is_hidden(middle) &&
           places_.settled(middle.point.point, middle.normal);
}

// True if the point is trimmed away or hidden under a surface.
bool ScallopCheck::is_hidden(const Corner& at) const
{
    return !inside_trims(at.surface, at.u, at.v) ||
           visibility().is_hidden(at.point.point, at.normal);
}

// True if the cell lies under other surfaces, gaps between these aside. False where its middle is
// trimmed away.
bool ScallopCheck::lies_under_others(const Cell& cell, const std::array<Corner, 4>& at) const
{
    const VisibilityFromAbove& places = visibility();
    const bool corners = std::all_of(at.begin(), at.end(), [&](const Corner& c) {
        return places.under_others(c.point.point) || !inside_trims(c.surface, c.u, c.v);
    });
    if (!corners) {
        return false;
    }
    const Corner middle = middle_of(cell);
    return places.under_others(middle.point.point) &&
           inside_trims(cell.surface, middle.u, middle.v);
}

// True if the cell's own surface, untrimmed, lies over it, as just below the equator of a sphere.
bool ScallopCheck::lies_under_itself(const std::array<Corner, 4>& at, const Corner& middle) const
{
    const auto under = [&](const Corner& c) {
        return visibility().under_itself(c.point.point, c.surface);
    };
    return surfaces_[static_cast<std::size_t>(middle.surface)].trims.empty() && under(middle) &&
           std::all_of(at.begin(), at.end(), under);
}

// True if a part of the cell may be visible through a gap that misses its corners.
bool ScallopCheck::silhouette_above(const std::array<Corner, 4>& at) const
{
    return visibility().silhouette_above(
        {at[0].point.point, at[1].point.point, at[2].point.point, at[3].point.point});
}

const VisibilityFromAbove& ScallopCheck::visibility() const
{
    std::call_once(visibility_->made, [&] {
        visibility_->value.emplace(surfaces_, path_fitter_, kBlockedCell * places_.step());
    });
    return *visibility_->value;
}

void ScallopCheck::check_cell(const Cell& cell, const std::array<Corner, 4>& at, int depth)
{
    if (overflowed_ ||
        path_fitter_.model().outside_trims(cell.surface, {cell.u0, cell.v0}, {cell.u1, cell.v1})) {
        return;
    }
    if (queries_ != nullptr && depth > kDeepestCheck - kOwnParts) {
        queries_->next();
    }
    const Verdict verdict = judge(cell, at);
    if (verdict == Verdict::kCovered) {
        return;
    }
    if (verdict == Verdict::kUncovered || depth == 0) {
        if (uncovered_.size() < max_uncovered_) {
            uncovered_.push_back(cell);
        } else {
            overflowed_ = true;
        }
        return;
    }
    const auto [a, b] = halves_of(cell, verdict == Verdict::kHalveU);
    if (verdict == Verdict::kHalveU) {
        const Corner low = corner(cell.surface, a.u1, cell.v0);
        const Corner high = corner(cell.surface, a.u1, cell.v1);
        check_cell(a, {at[0], low, at[2], high}, depth - 1);
        check_cell(b, {low, at[1], high, at[3]}, depth - 1);
    } else {
        const Corner low = corner(cell.surface, cell.u0, a.v1);
        const Corner high = corner(cell.surface, cell.u1, a.v1);
        check_cell(a, {at[0], at[1], low, high}, depth - 1);
        check_cell(b, {low, high, at[2], at[3]}, depth - 1);
    }
}

void ScallopCheck::check(int surface)
{
    const Surface& s = surfaces_[static_cast<std::size_t>(surface)];
    check(surface, {s.u_begin(), s.v_begin()}, {s.u_end(), s.v_end()});
}

void ScallopCheck::check(int surface, Vec2d low, Vec2d high)
{
    take_waiting();
    for (const Cell& cell : cells_of(surface, low, high)) {
        path_fitter_.model().forget_many_cells();
        check_cell(cell, corners_of(cell), kDeepestCheck);
    }
}

void ScallopCheck::take_waiting()
{
    for (const Points& tips : waiting_) {
        places_.add(tips);
    }
    waiting_.clear();
    has_checked_ = true;
}

// Between knots.
std::vector<ScallopCheck::Cell> ScallopCheck::cells_of(int surface, Vec2d low, Vec2d high) const
{
    const Surface& s = surfaces_[static_cast<std::size_t>(surface)];
    const std::vector<double> us =
        knots_between(s.knots_u, std::max(low.x, s.u_begin()), std::min(high.x, s.u_end()));
    const std::vector<double> vs =
        knots_between(s.knots_v, std::max(low.y, s.v_begin()), std::min(high.y, s.v_end()));
    std::vector<Cell> out;
    for (std::size_t i = 1; i < us.size(); ++i) {
        for (std::size_t j = 1; j < vs.size(); ++j) {
            out.push_back({surface, us[i - 1], us[i], vs[j - 1], vs[j]});
        }
    }
    return out;
}

ScallopCheck::Unproved ScallopCheck::unproved()
{
    Unproved out;
    std::vector<Cell> touched;
    std::vector<Cell> blocked;
    for (const Cell& cell : uncovered_) {
        const std::array<Corner, 4> at = corners_of(cell);
        const Place place = places_of(cell).front();
        if (std::all_of(at.begin(), at.end(), [&](const Corner& c) { return is_hidden(c); }) &&
            is_hidden(corner(cell.surface, place.u, place.v))) {
            continue;
        }
        if (blocked_somewhere(at)) {
            blocked.push_back(cell);
            continue;
        }
        touched.push_back(cell);
        out.parts.push_back({cell.surface, {cell.u0, cell.v0}, {cell.u1, cell.v1}});
    }
    out.left = most_left_in(touched);
    out.blocked_left = most_left_in(blocked);
    return out;
}

// Highest points first: most others are then rejected without a search.
double ScallopCheck::most_left_in(const std::vector<Cell>& cells)
{
    struct High {
        Corner at;
        double over;  // mm, over the surface
    };
    std::vector<High> all;
    for (const Cell& cell : cells) {
        for (const Place& place : places_of(cell)) {
            const Corner at = corner(cell.surface, place.u, place.v);
            const Vec3d p = at.point.point;
            const double over = (places_.swept().lowest(p.x, p.y).height - p.z) * at.normal.z;
            if (over > scallop_ && path_fitter_.area().holds(p, at.normal) && !is_hidden(at)) {
                all.push_back({at, over});
            }
        }
    }
    std::sort(all.begin(), all.end(), [](const High& a, const High& b) { return a.over > b.over; });
    double most = 0;
    for (const High& high : all) {
        if (high.over <= most) {
            break;
        }
        most = std::max(most, scallop_over_reachable(high.at, std::max(scallop_, most)));
    }
    return most;
}

}  // namespace cusp::finishing
