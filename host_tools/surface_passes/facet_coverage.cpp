// Triangles are halved across their longest side as long as one move covers each half.
#include "host_tools/surface_passes/facet_coverage.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/surface_offset/facet_distance.hpp"

namespace cusp::host {
namespace {

constexpr double kSmallest = 1.0 / 64;  // cells, in steps between passes
constexpr double kLargest = 2;          // the same
constexpr double kBlockedCell = 0.25;   // the same, where the tool can't touch
constexpr double kSmallShare = 0.98;    // of the scallop, at places that stand for a smallest cell
constexpr double kReachPitch = 0.125;   // radii, at least
constexpr double kTraceStep = 0.125;    // in steps between passes
constexpr double kTraceApart = 0.3;     // the same, of tips that one line may join
constexpr double kFarApart = 0.5;       // radii, of tips that one pass may join
constexpr int kMostTraced = 4000;       // places of one pass
constexpr int kRounds = 5;
constexpr int kDeepest = 60;
constexpr std::size_t kMostGaps = 300000;
constexpr double kUpright = 0.05;   // z of the normal
constexpr double kSteep = 0.2;      // the same
constexpr double kHidden = 1e-3;    // mm
constexpr double kShortest = 1e-3;  // mm

Vec3d raised(Vec3d point, Vec3d normal, double scallop)
{
    return normal.z >= kSteep ? point + Vec3d{0, 0, scallop / normal.z} : point + normal * scallop;
}

}  // namespace

FacetCoverage::FacetCoverage(const std::vector<std::array<Vec3d, 3>>& triangles,
                             const CertifiedPasses& certified,
                             double scallop,
                             double path_off)
    : triangles_{triangles},
      certified_{certified},
      radius_{certified.tool().radius},
      scallop_{scallop},
      path_off_{path_off},
      step_{std::sqrt(8 * radius_ * scallop)},
      swept_{radius_, 0.6 * step_},
      reach_{no_surfaces_, certified, std::max(kBlockedCell * step_, kReachPitch * radius_)}
{
}

bool FacetCoverage::covered(Vec3d place, Vec3d normal, double share) const
{
    const Vec3d top = raised(place, normal, scallop_ * share);
    swept_.near(place + normal * radius_, near_);
    return std::any_of(near_.begin(), near_.end(),
                       [&](std::uint32_t move) { return swept_.removes(move, top, path_off_); });
}

bool FacetCoverage::hidden(Vec3d point) const
{
    const auto top = certified_.model().top_of_mesh(point.x, point.y);
    return top && top->point.z > point.z + kHidden;
}

Vec3d FacetCoverage::touching_tip(const Place& at) const
{
    return at.point + at.normal * (radius_ + certified_.band().lift) - Vec3d{0, 0, radius_};
}

FacetCoverage::Verdict FacetCoverage::judge(const Cell& cell) const
{
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        longest = std::max(longest, norm(cell.corners[(k + 1) % 3] - cell.corners[k]));
    }
    if (longest > kLargest * step_) {
        return Verdict::kHalve;
    }
    const Vec3d middle = cell.middle();
    swept_.near(middle + cell.normal * radius_, near_);
    bool touched = false;
    for (const std::uint32_t move : near_) {
        const auto count =
            std::count_if(cell.corners.begin(), cell.corners.end(), [&](Vec3d corner) {
                return swept_.removes(move, raised(corner, cell.normal, scallop_), path_off_);
            });
        if (count == 3) {
            return Verdict::kCovered;
        }
        touched = touched || count > 0;
    }
    if (!touched && longest < step_ && hidden(middle) &&
        std::all_of(cell.corners.begin(), cell.corners.end(),
                    [&](Vec3d corner) { return hidden(corner); })) {
        return Verdict::kCovered;
    }
    if (longest >= kBlockedCell * step_) {
        return Verdict::kHalve;
    }
    bool each = true;
    for (const Vec3d& corner : cell.corners) {
        if (!covered(corner, cell.normal, kSmallShare)) {
            each = false;
            if (!certified_.stands_free(touching_tip({corner, cell.normal}))) {
                return low_enough(cell) ? Verdict::kCovered : Verdict::kBlocked;
            }
        }
    }
    if (longest >= kSmallest * step_) {
        return Verdict::kHalve;
    }
    return each ? Verdict::kCovered : Verdict::kUncovered;
}

// Whether what stands straight over the corners is no more than the scallop, square to the facet.
bool FacetCoverage::low_enough(const Cell& cell) const
{
    return std::all_of(cell.corners.begin(), cell.corners.end(), [&](Vec3d corner) {
        const double over = swept_.lowest(corner.x, corner.y).height - corner.z;
        return over * cell.normal.z <= kSmallShare * scallop_;
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
        overflowed_ = gaps_.size() >= kMostGaps;
        if (!overflowed_) {
            gaps_.push_back(cell);
        }
        if (verdict == Verdict::kBlocked && looking_over_) {
            blocked_area_ += 0.5 * norm(cross(cell.corners[1] - cell.corners[0],
                                              cell.corners[2] - cell.corners[0]));
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
        if (facet.normal.z >= kUpright) {
            look_into({corners, facet.normal}, kDeepest);
        }
    }
    looking_over_ = false;
}

// The tip that is missing at a place; none where nothing is, or the tool can't touch and
// `where_blocked` is false.
std::optional<Vec3d> FacetCoverage::missing_tip(const Place& at, bool where_blocked) const
{
    if (at.normal.z < kUpright || covered(at.point, at.normal, kSmallShare) || hidden(at.point)) {
        return std::nullopt;
    }
    const Vec3d tip = touching_tip(at);
    if (certified_.stands_free(tip)) {
        return tip;
    }
    return where_blocked ? better_tip(at) : std::nullopt;
}

// Where the tool would stand lowest over the place, from where it does now.
std::optional<Vec3d> FacetCoverage::better_tip(const Place& at) const
{
    const Vec3d p = at.point;
    const double cosine = at.normal.z;
    const SweptBalls::Lowest now = swept_.lowest(p.x, p.y);
    if ((now.height - p.z) * cosine <= scallop_) {
        return std::nullopt;
    }
    const std::optional<LowestReach::Answer> best = reach_.over(p, now.height - scallop_ / cosine);
    if (!best || (now.height - best->height) * cosine <= scallop_) {
        return std::nullopt;
    }
    return best->tip;
}

// A place of the cell that lacks a pass.
std::optional<FacetCoverage::Place> FacetCoverage::bare_place(const Cell& cell) const
{
    const Place middle{cell.middle(), cell.normal};
    if (missing_tip(middle, true)) {
        return middle;
    }
    for (const Vec3d& corner : cell.corners) {
        // Exactly on a side the neighbour's normal counts as much.
        const Place place{corner + (middle.point - corner) * 1e-3, cell.normal};
        if (missing_tip(place, false)) {
            return place;
        }
    }
    return std::nullopt;
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
                at.point + way * (sign * kTraceStep * step_ / std::sqrt(1 + slant * slant));
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

// The best tips of neighbouring places may lie apart (two sides of a ridge): between those that do
// the tool follows the model, or it is lifted.
std::vector<Points> FacetCoverage::runs_of(const Points& tips) const
{
    std::vector<Points> out{{tips.front()}};
    for (std::size_t k = 1; k < tips.size(); ++k) {
        const double apart = norm(tips[k] - out.back().back());
        if (apart > kFarApart * radius_) {
            out.push_back({tips[k]});
            continue;
        }
        if (apart > kTraceApart * step_) {
            const Points between = certified_.sample_dropped(out.back().back(), tips[k]);
            out.back().insert(out.back().end(), between.begin() + 1, between.end() - 1);
        }
        out.back().push_back(tips[k]);
    }
    for (Points& run : out) {
        if (run.size() == 1) {
            run.push_back(run.front() + Vec3d{kShortest, 0, 0});
        }
    }
    return out;
}

void FacetCoverage::close_gaps(const std::function<void(const Points&)>& cut)
{
    for (int round = 0; round < kRounds && !gaps_.empty(); ++round) {
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
            for (const Points& run : runs_of(one)) {
                cut(run);
            }
        }
        for (const Cell& cell : changed) {
            look_into(cell, kDeepest / 6);
        }
    }
    const auto met = [&](const Cell& cell) {
        return !bare_place(cell).has_value();
    };
    gaps_.erase(std::remove_if(gaps_.begin(), gaps_.end(), met), gaps_.end());
    for (const Cell& cell : gaps_) {
        if (const std::optional<Place> place = bare_place(cell)) {
            most_left_ = std::max(most_left_, left_at(*place));
        }
    }
}

// What is left at a bare place, square to its facet, over the best that can be done.
double FacetCoverage::left_at(const Place& at) const
{
    const Vec3d p = at.point;
    const SweptBalls::Lowest now = swept_.lowest(p.x, p.y);
    if (!std::isfinite(now.height)) {
        return radius_;
    }
    const std::optional<LowestReach::Answer> best = reach_.over(p, now.height);
    const double from = best ? std::max(p.z, best->height) : p.z;
    return std::min(radius_, std::max(0.0, (now.height - from) * at.normal.z));
}

}  // namespace cusp::host
