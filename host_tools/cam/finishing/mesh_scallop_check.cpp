// Triangles are halved across their longest side until one move covers each half.
#include "host_tools/cam/finishing/mesh_scallop_check.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host_tools/cam/finishing/finish_area.hpp"
#include "host_tools/cam/finishing/walls_over_nothing.hpp"
#include "host_tools/geometry/part_model/facet_distance.hpp"

namespace cusp::finishing {

using part_model::Facet;

namespace {

constexpr double kSmallestFacet = 1.0 / 64;    // cells, in steps between passes
constexpr double kSmallestBlocked = 1.0 / 16;  // the same, where the tool cannot touch
constexpr double kLargestFacet = 2;            // the same
constexpr int kFacetRounds = 5;
constexpr int kFacetHalvings = 60;
constexpr std::size_t kMostGaps = 300000;
constexpr std::size_t kShares = 64;           // of a search on several threads
constexpr std::size_t kEnoughFacets = 40000;  // effort of a copy, which then gives half of the rest
constexpr double kSharedFacet = 4;  // in steps: larger ones are divided before they are shared

// A point exactly on a side would have the normals of two facets.
Vec3d place_beside(Vec3d corner, Vec3d middle) { return corner + (middle - corner) * 1e-3; }

}  // namespace

MeshScallopCheck::MeshScallopCheck(const std::vector<Corners>& triangles,
                                   const GougeFreePathFitter& path_fitter,
                                   double scallop,
                                   double path_off)
    : triangles_{triangles},
      path_fitter_{path_fitter},
      scallop_{scallop},
      path_off_{path_off},
      places_{no_surfaces_, path_fitter, scallop, path_off},
      walls_{path_fitter, places_}
{
}

bool MeshScallopCheck::is_hidden(Vec3d point) const
{
    const auto top = path_fitter_.model().height_at(point.x, point.y);
    return top && top->point.z > point.z + kHidden;
}

MeshScallopCheck::Verdict MeshScallopCheck::judge(const Cell& cell) const
{
    ++judged_;
    const double longest = longest_side(cell.corners).length;
    if (path_fitter_.area().is_beyond(cell.middle(), longest, cell.normal, 0)) {
        return Verdict::kCovered;
    }
    if (longest > kLargestFacet * step()) {
        return Verdict::kHalve;
    }
    if (cell.normal.z < kUprightNormal) {
        return judge_steep(cell, longest);
    }
    const Vec3d middle = cell.middle();
    const bool along_z = cell.normal.z >= kSteepNormal;
    places_.swept().near(centre_under(raised(middle, cell.normal, scallop_, along_z), cell.normal,
                                      scallop_, path_fitter_.tool().radius),
                         near_);
    bool touched = false;
    for (const std::uint32_t move : near_) {
        const auto count =
            std::count_if(cell.corners.begin(), cell.corners.end(), [&](Vec3d corner) {
                return places_.swept().removes(move, raised(corner, cell.normal, scallop_, along_z),
                                               path_off_);
            });
        if (count == 3) {
            return Verdict::kCovered;
        }
        touched = touched || count > 0;
    }
    if (!touched && longest < step() && is_hidden(middle) &&
        std::all_of(cell.corners.begin(), cell.corners.end(),
                    [&](Vec3d corner) { return is_hidden(corner); })) {
        return Verdict::kCovered;
    }
    if (longest >= kBlockedCell * step()) {
        return longest < kSettledCell * step() && settled(cell, longest) ? Verdict::kSettled
                                                                         : Verdict::kHalve;
    }
    bool each = true;
    for (const Vec3d& corner : cell.corners) {
        if (!is_covered(corner, cell.normal, kPlaceShare)) {
            each = false;
            if (!path_fitter_.is_clear(places_.touching_tip(corner, cell.normal))) {
                return judge_blocked(cell, longest);
            }
        }
    }
    // Halving would not cover an uncovered corner.
    if (!each) {
        return Verdict::kUncovered;
    }
    return longest >= kSmallestFacet * step() ? Verdict::kHalve : Verdict::kCovered;
}

// True if the tool can touch no corner, and one move is as low as any may be.
bool MeshScallopCheck::settled(const Cell& cell, double longest) const
{
    return std::all_of(cell.corners.begin(), cell.corners.end(),
                       [&](Vec3d corner) {
                           return !is_covered(corner, cell.normal, kPlaceShare) &&
                                  !path_fitter_.is_clear(places_.touching_tip(corner, cell.normal));
                       }) &&
           !is_hidden(cell.middle()) &&
           places_.by_one_move(cell.corners, cell.normal, longest) ==
               ScallopAtPoint::OneMove::kGoesLowest;
}

// The verdict of a small cell that the tool can't touch everywhere. Between the cuts of several moves the
// stock is higher than at the corners: such cells are halved until that is little.
MeshScallopCheck::Verdict MeshScallopCheck::judge_blocked(const Cell& cell, double longest) const
{
    using OneMove = ScallopAtPoint::OneMove;
    const OneMove move = places_.by_one_move(cell.corners, cell.normal, longest);
    if (move == OneMove::kCuts || move == OneMove::kGoesLowest) {
        return move == OneMove::kCuts ? Verdict::kCovered : Verdict::kSettled;
    }
    const bool is_smallest = longest < kSmallestBlocked * step();
    if ((move == OneMove::kTooHigh || is_smallest) && may_be_uncovered(cell)) {
        return Verdict::kBlocked;
    }
    return is_smallest ? Verdict::kSettled : Verdict::kHalve;
}

void MeshScallopCheck::check_cell(const Cell& cell, int depth)
{
    if (overflowed_) {
        return;
    }
    const Verdict verdict = judge(cell);
    if (verdict == Verdict::kCovered) {
        return;
    }
    if (verdict != Verdict::kHalve || depth == 0) {
        if ((verdict == Verdict::kBlocked || verdict == Verdict::kSettled) && checking_) {
            blocked_area_ += area_of(cell.corners);
        }
        if (verdict == Verdict::kSettled) {
            return;
        }
        overflowed_ = uncovered_.size() >= kMostGaps;
        if (!overflowed_) {
            uncovered_.push_back(cell);
        }
        return;
    }
    for (const Corners& half : halves_of(cell.corners, longest_side(cell.corners).side)) {
        check_cell({half, cell.normal}, depth - 1);
    }
}

MeshScallopCheck::MeshScallopCheck(const MeshScallopCheck& other, ForThread /*tag*/)
    : triangles_{other.triangles_},
      path_fitter_{other.path_fitter_},
      scallop_{other.scallop_},
      path_off_{other.path_off_},
      places_{other.places_},
      walls_{path_fitter_, places_},
      checking_{other.checking_}
{
}

ReachableHeight::Drops MeshScallopCheck::work_at(OpenShare& share, const CopyWork& work) const
{
    MeshScallopCheck copy{*this, ForThread{}};
    copy.places_.begin_with(share.take_known());
    path_fitter_.model().forget_queries();
    std::size_t enough = kEnoughFacets;
    while (const std::optional<std::size_t> k = share.next()) {
        work(copy, *k);
        if (copy.effort() >= enough && share.left() > 1) {
            share.give_half({});
            enough = copy.effort() + kEnoughFacets;
        }
    }
    return copy.places_.take_drops();
}

void MeshScallopCheck::share_out(std::size_t count,
                                 const std::function<void(const MeshCheck&, std::size_t)>& work)
{
    work_of_copies(count, [&](const MeshScallopCheck& copy, std::size_t k) { work(copy, k); });
}

void MeshScallopCheck::work_of_copies(std::size_t count, const CopyWork& work)
{
    std::vector<Share> shares(std::min(count, kShares));
    for (std::size_t k = 0; k < shares.size(); ++k) {
        const std::size_t begin = count * k / shares.size();
        shares[k].resize(count * (k + 1) / shares.size() - begin);
        std::iota(shares[k].begin(), shares[k].end(), begin);
    }
    // Later calls look near the same places.
    places_.share(places_.take_drops());
    std::vector<ReachableHeight::Drops> drops =
        work_in_shares(shares, [&](OpenShare& share) { return work_at(share, work); });
    path_fitter_.model().forget_queries();
    for (ReachableHeight::Drops& some : drops) {
        places_.share(std::move(some));
    }
}

void MeshScallopCheck::check()
{
    checking_ = true;
    std::vector<Cell> cells;
    for (const auto& corners : triangles_) {
        const Facet facet{corners};
        if (!is_upright(facet.normal)) {
            for (const Corners& part : parts_of(corners, kSharedFacet * step())) {
                cells.push_back({part, facet.normal});
            }
        }
    }
    struct Finding {
        std::vector<Cell> uncovered;
        double blocked_area;
        bool overflowed;
    };
    std::vector<Finding> found(cells.size());
    work_of_copies(cells.size(), [&](MeshScallopCheck& copy, std::size_t k) {
        copy.blocked_area_ = 0;
        copy.check_cell(cells[k], kFacetHalvings);
        found[k] = {std::move(copy.uncovered_), copy.blocked_area_, copy.overflowed_};
        copy.uncovered_.clear();
    });
    for (const Finding& finding : found) {
        blocked_area_ += finding.blocked_area;
        overflowed_ = overflowed_ || finding.overflowed ||
                      uncovered_.size() + finding.uncovered.size() > kMostGaps;
        if (!overflowed_) {
            uncovered_.insert(uncovered_.end(), finding.uncovered.begin(), finding.uncovered.end());
        }
    }
    checking_ = false;
    const std::vector<WallFacet> facets = vertical_facets();
    over_nothing_ = walls_over_nothing(facets, path_fitter_);
    walls_.find(facets);
}

// A tip that would cut the stock over a point down to the scallop; none where the point is covered.
std::optional<Vec3d> MeshScallopCheck::missing_tip(const MeshPlace& at) const
{
    const bool steep = at.normal.z < kUprightNormal;
    const bool covered = steep ? places_.is_wall_cut(at.point, at.normal, kPlaceShare)
                               : is_covered(at.point, at.normal, kPlaceShare);
    if (covered || !path_fitter_.area().holds(at.point, at.normal) || is_hidden(at)) {
        return std::nullopt;
    }
    const Vec3d tip = places_.touching_tip(at.point, at.normal);
    if (path_fitter_.is_clear(tip)) {
        return tip;
    }
    return places_.lower_tip(at.point, at.normal, places_.blocked_share()).tip;
}

// A point of the cell where a pass is missing.
std::optional<MeshPlace> MeshScallopCheck::uncovered_point(const Cell& cell) const
{
    const MeshPlace middle{cell.middle(), cell.normal};
    if (missing_tip(middle)) {
        return middle;
    }
    for (const Vec3d& corner : cell.corners) {
        const MeshPlace place{place_beside(corner, middle.point), cell.normal};
        if (missing_tip(place)) {
            return place;
        }
    }
    return std::nullopt;
}

// A quick form of uncovered_point(): false only where that would find none.
bool MeshScallopCheck::may_be_uncovered(const Cell& cell) const
{
    const Vec3d middle = cell.middle();
    if (cell.normal.z < kUprightNormal) {
        return uncovered_point(cell).has_value();
    }
    const auto stays = [&](Vec3d at) {
        return is_covered(at, cell.normal, kPlaceShare) ||
               !path_fitter_.area().holds(at, cell.normal) || is_hidden(at);
    };
    const auto touched = [&](Vec3d at) {
        return path_fitter_.is_clear(places_.touching_tip(at, cell.normal));
    };
    const auto lower = [&](Vec3d at) {
        return !places_.has_no_lower_tip(at, cell.normal, places_.blocked_share());
    };
    if (!stays(middle) && (touched(middle) || lower(middle))) {
        return true;
    }
    return std::any_of(cell.corners.begin(), cell.corners.end(), [&](Vec3d corner) {
        const Vec3d at = place_beside(corner, middle);
        return !stays(at) && (touched(at) || lower(at));
    });
}

void MeshScallopCheck::add_missing_passes(const std::function<void(const Points&)>& cut)
{
    for (int round = 0; round < kFacetRounds && !uncovered_.empty(); ++round) {
        const std::vector<Cell> open = std::move(uncovered_);
        uncovered_.clear();
        for (const Cell& cell : cut_missing(open, cut)) {
            check_cell(cell, kFacetHalvings / 6);
        }
    }
    walls_.add_missing(cut);
    measure_left();
}

void MeshScallopCheck::measure_left()
{
    std::vector<double> left(uncovered_.size());
    work_of_copies(uncovered_.size(), [&](const MeshScallopCheck& copy, std::size_t k) {
        left[k] = copy.left_over(uncovered_[k]);
    });
    std::vector<Cell> kept;
    for (std::size_t k = 0; k < left.size(); ++k) {
        if (left[k] >= 0) {
            kept.push_back(uncovered_[k]);
            most_left_ = std::max(most_left_, left[k]);
        }
    }
    uncovered_ = std::move(kept);
    most_left_ = std::max(most_left_, walls_.measure_left());
}

MeshLeft MeshScallopCheck::left() const
{
    return {blocked_area_, std::nullopt, uncovered_.size() + walls_.size(),
            overflowed_,   most_left_,   over_nothing_};
}

// mm: the stock left where a pass is missing, above what the tool can reach; negative: none is.
double MeshScallopCheck::left_over(const Cell& cell) const
{
    const std::optional<MeshPlace> place = uncovered_point(cell);
    if (!place) {
        return -1;
    }
    return places_.uncut_at(place->point, place->normal, 0).reachable;
}

}  // namespace cusp::finishing
