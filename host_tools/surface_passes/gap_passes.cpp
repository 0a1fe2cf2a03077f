// Passes where too much stands: where a place lacks one, it is traced along the surface's
// parameters.
#include <algorithm>
#include <cmath>

#include "host_tools/surface_passes/coverage.hpp"

namespace cusp::host {
namespace {

constexpr double kNearCell =
    0.03;  // cells in steps between passes, where nearly the scallop stands
constexpr double kLeastNear = 0.7;  // of the scallop: beside less it is not worth the search
constexpr int kRounds = 5;
constexpr int kMoreHalvings = 10;  // a round

}  // namespace

std::optional<Vec3d> Coverage::missing_tip(int surface,
                                           double u,
                                           double v,
                                           bool where_blocked) const
{
    const Corner at = corner(surface, u, v);
    if (!inside_trims(surface, u, v)) {
        return std::nullopt;
    }
    if (place_covered(at)) {
        if (where_blocked) {
            better_tip(at);  // that is none, but what stands may be nearly the scallop
        }
        return std::nullopt;
    }
    if (stands_free(at)) {
        return places_.touching_tip(at.point.point, at.normal);
    }
    return where_blocked ? better_tip(at) : std::nullopt;
}

std::optional<Vec3d> Coverage::better_tip(const Corner& at) const
{
    // On upright walls heights say nothing.
    if (at.normal.z < kUprightNormal || hidden(at)) {
        return std::nullopt;
    }
    const PlaceCoverage::Better better = places_.better_tip(at.point.point, at.normal, near_share_);
    kept_off_ = kept_off_ || better.kept_off;
    if (better.left > scallop_) {
        return better.tip;
    }
    nearly_bare_ = nearly_bare_ || better.tip;
    return std::nullopt;
}

Points Coverage::trace(int surface, Place place, bool along_u) const
{
    const Surface& s = surfaces_[static_cast<std::size_t>(surface)];
    const double begin = along_u ? s.u_begin() : s.v_begin();
    const double end = along_u ? s.u_end() : s.v_end();
    Points out;
    for (const double sign : {-1.0, 1.0}) {
        double at_u = place.u;
        double at_v = place.v;
        for (int k = 0; k < kMostTraced; ++k) {
            const std::optional<Vec3d> tip = missing_tip(surface, at_u, at_v, true);
            if (k == 0 && sign > 0) {
                // the start is there already
            } else if (tip) {
                out.push_back(*tip);
            } else {
                break;
            }
            const SurfacePoint p = certified_.model().evaluate(surface, at_u, at_v);
            const double speed = norm(along_u ? p.du : p.dv);
            double& at = along_u ? at_u : at_v;
            const double step =
                std::min(kTraceStep * places_.step() / std::max(1e-9, speed), (end - begin) / 8);
            const double next = std::clamp(at + sign * step, begin, end);
            if (next == at) {
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

// Its middle, then its corners.
std::array<Coverage::Place, 5> Coverage::places_of(const Cell& cell) const
{
    return {Place{0.5 * (cell.u0 + cell.u1), 0.5 * (cell.v0 + cell.v1)}, Place{cell.u0, cell.v0},
            Place{cell.u1, cell.v0}, Place{cell.u0, cell.v1}, Place{cell.u1, cell.v1}};
}

// Whether the middle of the next cell beyond a corner that is seen is hidden as that of this one
// is: else what is seen is looked at there.
bool Coverage::in_narrow_gap(int surface, const Place& middle, const Place& corner_place) const
{
    const Surface& s = surfaces_[static_cast<std::size_t>(surface)];
    const double u = 2 * corner_place.u - middle.u;
    const double v = 2 * corner_place.v - middle.v;
    return u <= s.u_begin() || u >= s.u_end() || v <= s.v_begin() || v >= s.v_end() ||
           hidden(corner(surface, u, v));
}

// A place of the cell that lacks a pass. Ridges between passes that leave the scallop rise by two
// scallops a step beside them: what is between two places may be so much more.
std::optional<Coverage::Place> Coverage::bare_place(const Cell& cell) const
{
    const Surface& s = surfaces_[static_cast<std::size_t>(cell.surface)];
    // Beyond a border no other cell says what is left.
    const auto on_border = [&](const Place& at) {
        return at.u == s.u_begin() || at.u == s.u_end() || at.v == s.v_begin() || at.v == s.v_end();
    };
    const auto [long_u, long_v] = sides_of(cell);
    const double size = std::max(long_u, long_v) / places_.step();
    near_share_ = std::max(kLeastNear, 1 - 2 * size);
    nearly_bare_ = false;
    const std::array<Place, 5> places = places_of(cell);
    bool middle_hidden = false;
    for (const Place& place : places) {
        const bool middle = &place == places.data();
        if ((middle || middle_hidden) && hidden(corner(cell.surface, place.u, place.v))) {
            middle_hidden = true;
            continue;
        }
        const bool ask = middle || nearly_bare_ || on_border(place) ||
                         (middle_hidden && in_narrow_gap(cell.surface, places.front(), place));
        if (missing_tip(cell.surface, place.u, place.v, ask)) {
            return place;
        }
    }
    if (!nearly_bare_ || size < kNearCell) {
        return std::nullopt;
    }
    for (const Cell& half : halves_of(cell, long_u >= long_v)) {
        if (const std::optional<Place> place = bare_place(half)) {
            return place;
        }
    }
    return std::nullopt;
}

void Coverage::close_gaps(const std::function<void(const Points&)>& cut,
                          const std::function<void(double)>& progress)
{
    std::vector<Cell> beside_edges;
    for (int round = 0; round < kRounds && !gaps_.empty(); ++round) {
        const std::vector<Cell> open = std::move(gaps_);
        gaps_.clear();
        std::vector<Cell> changed;
        std::size_t looked = 0;
        for (const Cell& cell : open) {
            // A round has half the work of the one before.
            const double rest =
                1 - 0.5 * static_cast<double>(looked++) / static_cast<double>(open.size());
            progress(1 - std::ldexp(rest, -round));
            kept_off_ = false;
            certified_.model().forget_many_cells();
            const std::optional<Place> place = bare_place(cell);
            if (!place) {
                if (kept_off_) {
                    beside_edges.push_back(cell);
                }
                // Passes cut since may have made what stands steep.
                const std::array<Corner, 4> at = corners_of(cell);
                if (stands_steep(at)) {
                    changed.push_back(cell);
                }
                continue;
            }
            changed.push_back(cell);
            Points one = trace(cell.surface, *place, true);
            Points other = trace(cell.surface, *place, false);
            if (one.empty() || length_of(other) > length_of(one)) {
                std::swap(one, other);
            }
            for (const Points& run : places_.runs_of(one)) {
                cut(run);
            }
        }
        for (const Cell& cell : changed) {
            look_into(cell, corners_of(cell), kMoreHalvings);
        }
    }
    const auto met = [&](const Cell& cell) {
        kept_off_ = false;
        const std::optional<Place> place = bare_place(cell);
        if (place) {
            most_left_ =
                std::max(most_left_, reachable_left(corner(cell.surface, place->u, place->v), 0));
        } else if (kept_off_) {
            beside_edges.push_back(cell);
        }
        return !place;
    };
    gaps_.erase(std::remove_if(gaps_.begin(), gaps_.end(), met), gaps_.end());
    measure_beside_edges(beside_edges);
}

double Coverage::reachable_left(const Corner& at, double worth)
{
    const PlaceCoverage::Left left = places_.left_at(at.point.point, at.normal, worth);
    left_beside_edges_ = std::max(left_beside_edges_, left.beside_edges);
    return left.reachable;
}

// Cells where nothing is left to do but by tips that passes are kept off.
void Coverage::measure_beside_edges(const std::vector<Cell>& cells)
{
    for (const Cell& cell : cells) {
        for (const Place& place : places_of(cell)) {
            const Corner at = corner(cell.surface, place.u, place.v);
            if (at.normal.z >= kUprightNormal && !hidden(at)) {
                reachable_left(at, std::max(scallop_, left_beside_edges_));
            }
        }
    }
}

}  // namespace cusp::host
