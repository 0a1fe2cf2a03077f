// Missing passes: where the scallop is too high, a pass is traced along the surface's parameters.
#include <algorithm>
#include <cmath>

#include "host_tools/cam/finishing/finish_area.hpp"
#include "host_tools/cam/finishing/scallop_check.hpp"
#include "host_tools/cam/finishing/vertical_faces.hpp"
#include "host_tools/cam/finishing/walls_over_nothing.hpp"

namespace cusp::finishing {

using nurbs::Surface;
using nurbs::SurfacePoint;

namespace {

constexpr double kNearCell = 0.03;  // in stepovers: smallest cell that nearly keeps the scallop
constexpr double kLeastNear = 0.7;  // of the scallop: neighbours of less are not searched
constexpr int kRounds = 5;
constexpr std::size_t kShortTrace = 2;  // tips: a trace that leaves a sliver at once
constexpr int kMoreHalvings = 10;       // a round

}  // namespace

std::optional<Vec3d> ScallopCheck::missing_tip(int surface,
                                               double u,
                                               double v,
                                               bool where_blocked) const
{
    const Corner at = corner(surface, u, v);
    if (!path_fitter_.area().holds(at.point.point, at.normal) || !inside_trims(surface, u, v)) {
        return std::nullopt;
    }
    if (is_covered(at)) {
        if (where_blocked) {
            lower_tip(at);  // returns none, but records stock that is nearly the scallop
        }
        return std::nullopt;
    }
    if (is_clear(at)) {
        return places_.touching_tip(at.point.point, at.normal);
    }
    return where_blocked ? lower_tip(at) : std::nullopt;
}

std::optional<Vec3d> ScallopCheck::lower_tip(const Corner& at) const
{
    if (places_.is_upright(at.normal) || is_hidden(at)) {
        return std::nullopt;
    }
    const ScallopAtPoint::LowerTip better =
        places_.lower_tip(at.point.point, at.normal, near_share_);
    moved_clear_ = moved_clear_ || better.moved_clear;
    if (better.left > scallop_) {
        return better.tip;
    }
    nearly_uncovered_ = nearly_uncovered_ || better.tip;
    return std::nullopt;
}

// The missing tips along a straight line in the domain, both ways. The first is not searched for
// again: a search that begins elsewhere may end in another valley, and find nothing.
//
// way  in (u, v)
Points ScallopCheck::trace(int surface, const MissingPass& from, Vec2d way) const
{
    const Surface& s = surfaces_[static_cast<std::size_t>(surface)];
    const Vec2d low{s.u_begin(), s.v_begin()};
    const Vec2d high{s.u_end(), s.v_end()};
    const double longest =
        1.0 / 8 / std::max(std::abs(way.x) / (high.x - low.x), std::abs(way.y) / (high.y - low.y));
    Points out;
    for (const double sign : {-1.0, 1.0}) {
        Vec2d at{from.place.u, from.place.v};
        for (int k = 0; k < kMostTraced; ++k) {
            const std::optional<Vec3d> tip =
                k == 0 ? from.tip : missing_tip(surface, at.x, at.y, true);
            if (k == 0 && sign > 0) {
                // the first direction has added the start
            } else if (tip) {
                out.push_back(*tip);
            } else {
                break;
            }
            const SurfacePoint p = path_fitter_.model().evaluate(surface, at.x, at.y);
            const double speed = norm(p.du * way.x + p.dv * way.y);
            const double step =
                std::min(kTraceStep * places_.step() / std::max(1e-9, speed), longest);
            const Vec2d next{std::clamp(at.x + sign * step * way.x, low.x, high.x),
                             std::clamp(at.y + sign * step * way.y, low.y, high.y)};
            if (next.x == at.x && next.y == at.y) {
                break;
            }
            at = next;
        }
        if (sign < 0) {
            std::reverse(out.begin(), out.end());
        }
    }
    return out;
}

// The middle of the cell, then its corners. If all are trimmed away, a place beside the trims
// takes the middle's: a sliver between them may hold no corner of any cell.
std::array<ScallopCheck::Place, 5> ScallopCheck::places_of(const Cell& cell) const
{
    std::array<Place, 5> out{Place{0.5 * (cell.u0 + cell.u1), 0.5 * (cell.v0 + cell.v1)},
                             Place{cell.u0, cell.v0}, Place{cell.u1, cell.v0},
                             Place{cell.u0, cell.v1}, Place{cell.u1, cell.v1}};
    if (std::none_of(out.begin(), out.end(), [&](const Place& place) {
            return inside_trims(cell.surface, place.u, place.v);
        })) {
        if (const auto beside = path_fitter_.model().beside_trims(cell.surface, {cell.u0, cell.v0},
                                                                  {cell.u1, cell.v1})) {
            out.front() = {beside->place.x, beside->place.y};
        }
    }
    return out;
}

// The longest pass through the place along u, along v or along the trims beside it.
Points ScallopCheck::longest_trace(const Cell& cell, const MissingPass& from) const
{
    Points longest = trace(cell.surface, from, {1, 0});
    const auto try_along = [&](Vec2d way) {
        Points other = trace(cell.surface, from, way);
        if (length_of(other) > length_of(longest)) {
            longest = std::move(other);
        }
    };
    try_along({0, 1});
    if (longest.size() > kShortTrace) {
        return longest;
    }
    if (const auto beside = path_fitter_.model().beside_trims(cell.surface, {cell.u0, cell.v0},
                                                              {cell.u1, cell.v1})) {
        try_along(beside->along);
    }
    return longest;
}

// True if the visible corner of a cell with a hidden middle lies in an opening narrower than cells:
// the middle of the next cell beyond the corner is hidden too. Otherwise that cell is checked.
bool ScallopCheck::in_narrow_opening(int surface,
                                     const Place& middle,
                                     const Place& corner_place) const
{
    const Surface& s = surfaces_[static_cast<std::size_t>(surface)];
    const double u = 2 * corner_place.u - middle.u;
    const double v = 2 * corner_place.v - middle.v;
    return u <= s.u_begin() || u >= s.u_end() || v <= s.v_begin() || v >= s.v_end() ||
           is_hidden(corner(surface, u, v));
}

// A point of the cell where a pass is missing. Beside a ridge of the scallop's height the stock
// changes by two scallops a stepover, so the height between two points may exceed theirs by that.
std::optional<ScallopCheck::MissingPass> ScallopCheck::uncovered_point(const Cell& cell) const
{
    ++judged_;
    const Surface& s = surfaces_[static_cast<std::size_t>(cell.surface)];
    // No neighbouring cell checks a border.
    const auto on_border = [&](const Place& at) {
        return at.u == s.u_begin() || at.u == s.u_end() || at.v == s.v_begin() || at.v == s.v_end();
    };
    const auto [long_u, long_v] = sides_of(cell);
    const double size = std::max(long_u, long_v) / places_.step();
    near_share_ = std::max(kLeastNear, 1 - 2 * size);
    nearly_uncovered_ = false;
    const std::array<Place, 5> places = places_of(cell);
    bool middle_hidden = false;
    for (const Place& place : places) {
        const bool middle = &place == places.data();
        if ((middle || middle_hidden) && is_hidden(corner(cell.surface, place.u, place.v))) {
            middle_hidden = true;
            continue;
        }
        const bool ask = middle || nearly_uncovered_ || on_border(place) ||
                         (middle_hidden && in_narrow_opening(cell.surface, places.front(), place));
        if (const auto tip = missing_tip(cell.surface, place.u, place.v, ask)) {
            return MissingPass{place, *tip};
        }
    }
    if (!nearly_uncovered_ || size < kNearCell) {
        return std::nullopt;
    }
    for (const Cell& half : halves_of(cell, long_u >= long_v)) {
        if (const std::optional<MissingPass> found = uncovered_point(half)) {
            return found;
        }
    }
    return std::nullopt;
}

void ScallopCheck::add_missing_passes(const std::function<void(const Points&)>& cut,
                                      const std::function<void(double)>& progress)
{
    std::vector<Cell> beside_edges;
    for (int round = 0; round < kRounds && !uncovered_.empty(); ++round) {
        OpenCells open{std::move(uncovered_), {}};
        uncovered_.clear();
        // Passes cut meanwhile only lower the stock: what misses none now misses none later.
        open.findings = findings_of(open.cells, false);
        // A round takes about half as long as the one before.
        cut_missing(open, cut,
                    [&](double share) { progress(1 - std::ldexp(1 - 0.5 * share, -round)); });
        for (std::size_t k = 0; k < open.cells.size(); ++k) {
            if (!open.findings[k].missing && open.findings[k].moved_clear) {
                beside_edges.push_back(open.cells[k]);
            }
        }
        for (const Cell& cell : cells_changed(open)) {
            check_cell(cell, corners_of(cell), kMoreHalvings);
        }
    }
    const std::vector<WallFacet> facets =
        vertical_faces(surfaces_, path_fitter_, places_, scallop_);
    over_nothing_ = walls_over_nothing(facets, path_fitter_);
    walls_.find(facets);
    walls_.add_missing(cut);
    measure_left(beside_edges);
    measure_beside_edges(beside_edges);
    most_left_ = std::max(most_left_, walls_.measure_left());
}

double ScallopCheck::left_beside_walls()
{
    take_waiting();
    const std::vector<WallFacet> facets =
        vertical_faces(surfaces_, path_fitter_, places_, scallop_);
    over_nothing_ = walls_over_nothing(facets, path_fitter_);
    walls_.find(facets);
    return walls_.measure_left();
}

double ScallopCheck::scallop_over_reachable(const Corner& at, double resolution)
{
    const ScallopAtPoint::Uncut left = places_.uncut_at(at.point.point, at.normal, resolution);
    left_beside_edges_ = std::max(left_beside_edges_, left.beside_edges);
    return left.reachable;
}

// Measures cells where the only lower tips are those that would gouge an edge from the side.
void ScallopCheck::measure_beside_edges(const std::vector<Cell>& cells)
{
    for (const Cell& cell : cells) {
        for (const Place& place : places_of(cell)) {
            const Corner at = corner(cell.surface, place.u, place.v);
            if (!places_.is_upright(at.normal) &&
                path_fitter_.area().holds(at.point.point, at.normal) && !is_hidden(at)) {
                scallop_over_reachable(at, std::max(scallop_, left_beside_edges_));
            }
        }
    }
}

}  // namespace cusp::finishing
