// Triangles are halved across their longest side as long as one move covers each half.
#include "host_tools/surface_passes/facet_coverage.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/surface_offset/facet_distance.hpp"

namespace cusp::host {
namespace {

constexpr double kSmallestFacet = 1.0 / 64;  // cells, in steps between passes
constexpr double kLargestFacet = 2;          // the same
constexpr int kFacetRounds = 5;
constexpr int kFacetHalvings = 60;
constexpr std::size_t kMostGaps = 300000;

// Exactly on a side of a cell the neighbour's normal counts as much.
Vec3d place_beside(Vec3d corner, Vec3d middle) { return corner + (middle - corner) * 1e-3; }

}  // namespace

FacetCoverage::FacetCoverage(const std::vector<std::array<Vec3d, 3>>& triangles,
                             const CertifiedPasses& certified,
                             double scallop,
                             double path_off)
    : triangles_{triangles},
      certified_{certified},
      scallop_{scallop},
      path_off_{path_off},
      places_{no_surfaces_, certified, scallop, path_off}
{
}

bool FacetCoverage::hidden(Vec3d point) const
{
    const auto top = certified_.model().top_of_mesh(point.x, point.y);
    return top && top->point.z > point.z + kHidden;
}

FacetCoverage::Verdict FacetCoverage::judge(const Cell& cell) const
{
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        longest = std::max(longest, norm(cell.corners[(k + 1) % 3] - cell.corners[k]));
    }
    if (longest > kLargestFacet * step()) {
        return Verdict::kHalve;
    }
    const Vec3d middle = cell.middle();
    const bool upright = cell.normal.z >= kSteepNormal;
    places_.swept().near(centre_under(raised(middle, cell.normal, scallop_, upright), cell.normal,
                                      scallop_, certified_.tool().radius),
                         near_);
    bool touched = false;
    for (const std::uint32_t move : near_) {
        const auto count =
            std::count_if(cell.corners.begin(), cell.corners.end(), [&](Vec3d corner) {
                return places_.swept().removes(move, raised(corner, cell.normal, scallop_, upright),
                                               path_off_);
            });
        if (count == 3) {
            return Verdict::kCovered;
        }
        touched = touched || count > 0;
    }
    if (!touched && longest < step() && hidden(middle) &&
        std::all_of(cell.corners.begin(), cell.corners.end(),
                    [&](Vec3d corner) { return hidden(corner); })) {
        return Verdict::kCovered;
    }
    if (longest >= kBlockedCell * step()) {
        return longest < kSettledCell * step() && settled(cell) ? Verdict::kSettled
                                                                : Verdict::kHalve;
    }
    bool each = true;
    for (const Vec3d& corner : cell.corners) {
        if (!covered(corner, cell.normal, kPlaceShare)) {
            each = false;
            if (!certified_.stands_free(places_.touching_tip(corner, cell.normal))) {
                return low_enough(cell) ? Verdict::kCovered : Verdict::kBlocked;
            }
        }
    }
    // Halves with a bare corner would be no less bare.
    if (!each) {
        return Verdict::kUncovered;
    }
    return longest >= kSmallestFacet * step() ? Verdict::kHalve : Verdict::kCovered;
}

bool FacetCoverage::blocked(Vec3d corner, Vec3d normal) const
{
    return !covered(corner, normal, kPlaceShare) &&
           !certified_.stands_free(places_.touching_tip(corner, normal));
}

bool FacetCoverage::settled(const Cell& cell) const
{
    const Vec3d middle = cell.middle();
    return std::all_of(cell.corners.begin(), cell.corners.end(),
                       [&](Vec3d corner) { return blocked(corner, cell.normal); }) &&
           !hidden(middle) && places_.settled(middle, cell.normal);
}

// Whether what stands straight over the corners is no more than the scallop, square to the facet.
bool FacetCoverage::low_enough(const Cell& cell) const
{
    return std::all_of(cell.corners.begin(), cell.corners.end(), [&](Vec3d corner) {
        const double over = places_.swept().lowest(corner.x, corner.y).height - corner.z;
        return over * cell.normal.z <= kPlaceShare * scallop_;
    });
}

void FacetCoverage::look_into(const Cell& cell, int depth)
{
    if (overflowed_) {
        return;
    }
    const Verdict verdict = judge(cell);
    if (verdict == Verdict::kCovered) {
        return;
    }
    if (verdict != Verdict::kHalve || depth == 0) {
        if ((verdict == Verdict::kBlocked || verdict == Verdict::kSettled) && looking_over_) {
            blocked_area_ += 0.5 * norm(cross(cell.corners[1] - cell.corners[0],
                                              cell.corners[2] - cell.corners[0]));
        }
        // Mostly nothing is to be done where the tool can't touch, and rough ground has no end of
        // such cells.
        if (verdict == Verdict::kSettled || (verdict == Verdict::kBlocked && !may_be_bare(cell))) {
            return;
        }
        overflowed_ = gaps_.size() >= kMostGaps;
        if (!overflowed_) {
            gaps_.push_back(cell);
        }
        return;
    }
    const std::array<Vec3d, 3>& at = cell.corners;
    std::size_t side = 0;
    for (std::size_t k = 1; k < 3; ++k) {
        if (norm(at[(k + 1) % 3] - at[k]) > norm(at[(side + 1) % 3] - at[side])) {
            side = k;
        }
    }
    const Vec3d half = (at[side] + at[(side + 1) % 3]) * 0.5;
    const Vec3d across = at[(side + 2) % 3];
    look_into({{at[side], half, across}, cell.normal}, depth - 1);
    look_into({{half, at[(side + 1) % 3], across}, cell.normal}, depth - 1);
}

void FacetCoverage::look_over()
{
    looking_over_ = true;
    for (const auto& corners : triangles_) {
        const Facet facet{corners};
        if (facet.normal.z >= kUprightNormal) {
            look_into({corners, facet.normal}, kFacetHalvings);
        }
    }
    looking_over_ = false;
}

// The tip that is missing at a place; none where nothing is, or the tool can't touch and
// `where_blocked` is false.
std::optional<Vec3d> FacetCoverage::missing_tip(const Place& at, bool where_blocked) const
{
    if (at.normal.z < kUprightNormal || covered(at.point, at.normal, kPlaceShare) ||
        hidden(at.point)) {
        return std::nullopt;
    }
    const Vec3d tip = places_.touching_tip(at.point, at.normal);
    if (certified_.stands_free(tip)) {
        return tip;
    }
    return where_blocked ? places_.better_tip(at.point, at.normal).tip : std::nullopt;
}

// A place of the cell that lacks a pass.
std::optional<FacetCoverage::Place> FacetCoverage::bare_place(const Cell& cell) const
{
    const Place middle{cell.middle(), cell.normal};
    if (missing_tip(middle, true)) {
        return middle;
    }
    for (const Vec3d& corner : cell.corners) {
        const Place place{place_beside(corner, middle.point), cell.normal};
        if (missing_tip(place, false)) {
            return place;
        }
    }
    return std::nullopt;
}

// As `bare_place`, but told at once: true where it would have to be searched for.
bool FacetCoverage::may_be_bare(const Cell& cell) const
{
    const Vec3d middle = cell.middle();
    const auto stays = [&](Vec3d at) {
        return covered(at, cell.normal, kPlaceShare) || hidden(at);
    };
    const auto touched = [&](Vec3d at) {
        return certified_.stands_free(places_.touching_tip(at, cell.normal));
    };
    if (!stays(middle) && (touched(middle) || !places_.nothing_better(middle, cell.normal))) {
        return true;
    }
    return std::any_of(cell.corners.begin(), cell.corners.end(), [&](Vec3d corner) {
        const Vec3d at = place_beside(corner, middle);
        return !stays(at) && touched(at);
    });
}

// From place to place of the mesh as seen from above, both ways, as far as tips are missing.
Points FacetCoverage::trace(const Place& from, Vec3d way) const
{
    Points out;
    for (const double sign : {-1.0, 1.0}) {
        Place at = from;
        for (int k = 0; k < kMostTraced; ++k) {
            const std::optional<Vec3d> tip = missing_tip(at, true);
            if (!tip) {
                break;
            }
            if (k > 0 || sign < 0) {
                out.push_back(*tip);
            }
            const double slant = dot(at.normal, way) / at.normal.z;
            const Vec3d next =
                at.point + way * (sign * kTraceStep * step() / std::sqrt(1 + slant * slant));
            const auto top = certified_.model().top_of_mesh(next.x, next.y);
            if (!top) {
                break;
            }
            at = {top->point, top->normal};
        }
        if (sign < 0) {
            std::reverse(out.begin(), out.end());
        }
    }
    return out;
}

void FacetCoverage::close_gaps(const std::function<void(const Points&)>& cut)
{
    for (int round = 0; round < kFacetRounds && !gaps_.empty(); ++round) {
        const std::vector<Cell> open = std::move(gaps_);
        gaps_.clear();
        std::vector<Cell> changed;
        for (const Cell& cell : open) {
            const std::optional<Place> place = bare_place(cell);
            if (!place) {
                continue;
            }
            changed.push_back(cell);
            Points one = trace(*place, {1, 0, 0});
            Points other = trace(*place, {0, 1, 0});
            if (length_of(other) > length_of(one)) {
                std::swap(one, other);
            }
            for (const Points& run : places_.runs_of(one)) {
                cut(run);
            }
        }
        for (const Cell& cell : changed) {
            look_into(cell, kFacetHalvings / 6);
        }
    }
    const auto met = [&](const Cell& cell) {
        return !bare_place(cell).has_value();
    };
    gaps_.erase(std::remove_if(gaps_.begin(), gaps_.end(), met), gaps_.end());
    for (const Cell& cell : gaps_) {
        if (const std::optional<Place> place = bare_place(cell)) {
            most_left_ =
                std::max(most_left_, places_.left_at(place->point, place->normal, 0).reachable);
        }
    }
}

}  // namespace cusp::host
