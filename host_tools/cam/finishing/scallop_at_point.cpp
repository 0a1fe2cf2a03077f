// Tests the moves near a point one by one; the best tips come from `ReachableHeight`.
#include "host_tools/cam/finishing/scallop_at_point.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::finishing {

using nurbs::Surface;

namespace {

constexpr double kReachStep = 0.25;    // in stepovers
constexpr double kReachPitch = 0.125;  // radii, at least
// Error of drops, upwards: mm, within shares of the scallop. A part of metres would be cut into
// millions of pieces otherwise.
constexpr double kDropAccuracy = 1e-4;
constexpr double kLeastDropShare = 0.001;
constexpr double kMostDropShare = 0.005;
constexpr double kAgrees = 3;        // of the accuracy of drops: resolution of searches
constexpr double kLevelWall = 1e-9;  // z of a normal: a wall has no height
constexpr int kLeftHalvings = 20;
constexpr double kLeastBlockedShare = 0.25;

}  // namespace

Vec3d raised(Vec3d point, Vec3d normal, double scallop, bool along_z)
{
    return along_z ? point + Vec3d{0, 0, scallop / normal.z} : point + normal * scallop;
}

Vec3d centre_under(Vec3d top, Vec3d normal, double scallop, double radius)
{
    return top + normal * (radius - scallop);
}

ScallopAtPoint::ScallopAtPoint(const std::vector<Surface>& surfaces,
                               const GougeFreePathFitter& path_fitter,
                               double scallop,
                               double path_off)
    : surfaces_{surfaces},
      path_fitter_{path_fitter},
      radius_{path_fitter.tool().radius},
      scallop_{scallop},
      path_off_{path_off},
      step_{std::sqrt(8 * radius_ * scallop)},
      swept_{std::make_shared<SweptVolume>(radius_, 0.6 * step_)},
      accuracy_{std::clamp(kDropAccuracy, kLeastDropShare * scallop, kMostDropShare * scallop)},
      reach_{surfaces, path_fitter, std::max(kReachStep * step_, kReachPitch * radius_), accuracy_}
{
    if (surfaces.empty()) {
        lower_position_.emplace(path_fitter, reach_.pitch());
    }
}

ScallopAtPoint::ScallopAtPoint(const ScallopAtPoint& other)
    : surfaces_{other.surfaces_},
      path_fitter_{other.path_fitter_},
      radius_{other.radius_},
      scallop_{other.scallop_},
      path_off_{other.path_off_},
      step_{other.step_},
      swept_{other.swept_},
      accuracy_{other.accuracy_},
      reach_{other.reach_}
{
    if (other.lower_position_) {
        lower_position_.emplace(path_fitter_, reach_.pitch());
    }
}

Vec3d ScallopAtPoint::touching_tip(Vec3d point, Vec3d normal) const
{
    return point + normal * (radius_ + path_fitter_.band().offset) - Vec3d{0, 0, radius_};
}

bool ScallopAtPoint::is_covered(Vec3d point, Vec3d normal, double share) const
{
    const double allowed = scallop_ * share;
    const Vec3d top = raised(point, normal, allowed, normal.z >= kSteepNormal);
    swept_->near(centre_under(top, normal, allowed, radius_), near_);
    return std::any_of(near_.begin(), near_.end(),
                       [&](std::uint32_t move) { return swept_->removes(move, top, path_off_); });
}

bool ScallopAtPoint::is_wall_cut(Vec3d point, Vec3d normal, double share, double off) const
{
    const double allowed = share * scallop_;
    const Vec3d top = raised(point, normal, allowed, false);
    swept_->near_or_below(centre_under(top, normal, allowed, radius_), near_);
    return std::any_of(near_.begin(), near_.end(), [&](std::uint32_t move) {
        return swept_->removes(move, top, path_off_ + off);
    });
}

bool ScallopAtPoint::one_move_cuts_wall(const std::vector<WallPoint>& points, double off) const
{
    Vec3d middle;
    for (const WallPoint& at : points) {
        middle = middle + at.point / static_cast<double>(points.size());
    }
    swept_->near_or_below(middle + points.front().normal * radius_, near_);
    return std::any_of(near_.begin(), near_.end(), [&](std::uint32_t move) {
        return std::all_of(points.begin(), points.end(), [&](const WallPoint& at) {
            return swept_->removes(move, raised(at.point, at.normal, scallop_, false),
                                   path_off_ + off);
        });
    });
}

double ScallopAtPoint::left_beside_wall(Vec3d point, Vec3d normal, double off) const
{
    double low = 0;
    double high = radius_;
    for (int k = 0; k < kLeftHalvings; ++k) {
        const double middle = 0.5 * (low + high);
        (is_wall_cut(point, normal, middle / scallop_, off) ? high : low) = middle;
    }
    return high;
}

double ScallopAtPoint::upright_normal() const
{
    const double height = path_fitter_.model().box_high().z - path_fitter_.model().box_low().z;
    return std::clamp(kPlaceShare * scallop_ / std::max(height, kLevelWall), kLevelWall,
                      kUprightNormal);
}

// mm: the stock over a point from `height` up to `now`, along the normal; at most the radius.
double ScallopAtPoint::left_from(Vec3d point, Vec3d normal, double height, double now) const
{
    const double from = std::max(point.z, height);
    if (normal.z >= kUprightNormal) {
        return std::min(radius_, std::max(0.0, (now - from) * normal.z));
    }
    return left_beside_wall({point.x, point.y, from}, normal);
}

// Fast test whether some ball removes more than a share of the scallop, within the resolution of
// searches.
LowerPositionProof::Verdict ScallopAtPoint::quick_verdict(Vec3d point,
                                                          Vec3d normal,
                                                          double share,
                                                          const SweptVolume::Lowest& now) const
{
    const double resolution = scallop_ * share / normal.z;
    if (now.height - point.z <= resolution) {
        return LowerPositionProof::Verdict::kNone;
    }
    if (!lower_position_ || !std::isfinite(now.height)) {
        return LowerPositionProof::Verdict::kUnknown;
    }
    return lower_position_->verdict_over(
        {point.x, point.y, now.height - resolution - kAgrees * accuracy_}, now.centre);
}

ScallopAtPoint::LowerTip ScallopAtPoint::searched(Vec3d point,
                                                  Vec3d normal,
                                                  double share,
                                                  const SweptVolume::Lowest& now) const
{
    const double resolution = scallop_ * share;
    const double exact_below = now.height - resolution / normal.z;
    const auto removed_by = [&](const std::optional<ReachableHeight::Position>& position) {
        if (!position || position->height >= exact_below) {
            return 0.0;
        }
        return normal.z < kUprightNormal ? left_from(point, normal, position->height, now.height)
                                         : (now.height - position->height) * normal.z;
    };
    const std::optional<ReachableHeight::Position> best = reach_.lowest_over(point, exact_below);
    const double most = removed_by(best);
    if (most <= resolution) {
        return {};
    }
    if (path_fitter_.moved_clear_of_edges({best->tip}).front() == best->tip) {
        return {best->tip, most, false};
    }
    const std::optional<ReachableHeight::Position> kept =
        reach_.lowest_clear_of_edges(point, *best, exact_below);
    const double less = removed_by(kept);
    if (less <= resolution) {
        return {std::nullopt, 0, true};
    }
    return {kept->tip, less, false};
}

ScallopAtPoint::LowerTip ScallopAtPoint::lower_tip(Vec3d point, Vec3d normal, double share) const
{
    if (normal.z < kUprightNormal && (is_upright(normal) || is_wall_cut(point, normal, share))) {
        return {};
    }
    const SweptVolume::Lowest now = swept_->lowest(point.x, point.y);
    return quick_verdict(point, normal, share, now) == LowerPositionProof::Verdict::kNone
               ? LowerTip{}
               : searched(point, normal, share, now);
}

bool ScallopAtPoint::has_no_lower_tip(Vec3d point, Vec3d normal, double share) const
{
    return quick_verdict(point, normal, share, swept_->lowest(point.x, point.y)) ==
           LowerPositionProof::Verdict::kNone;
}

double ScallopAtPoint::blocked_share() const
{
    return std::max(kLeastBlockedShare, kPlaceShare - path_fitter_.band().offset / scallop_);
}

ScallopAtPoint::OneMove ScallopAtPoint::by_one_move(const Corners& corners,
                                                    Vec3d normal,
                                                    double longest) const
{
    using Verdict = LowerPositionProof::Verdict;
    const Vec3d middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    const SweptVolume::Lowest lowest = swept_->lowest(middle.x, middle.y);
    // Between the corners a ball may be lower than at them by what its roundness takes.
    const double share =
        blocked_share() - longest * longest / (8 * radius_ * scallop_) - path_off_ / scallop_;
    if (share <= 0 || !std::isfinite(lowest.height)) {
        return OneMove::kUnknown;
    }
    bool cuts = true;
    for (const Vec3d& corner : corners) {
        const SweptVolume::Lowest cut = swept_->cut_by(lowest.move, corner.x, corner.y);
        if (!std::isfinite(cut.height)) {
            return OneMove::kUnknown;
        }
        if (quick_verdict(corner, normal, share, cut) != Verdict::kNone) {
            const SweptVolume::Lowest own = swept_->lowest(corner.x, corner.y);
            return quick_verdict(corner, normal, blocked_share(), own) == Verdict::kNone
                       ? OneMove::kUnknown
                       : OneMove::kTooHigh;
        }
        cuts = cuts && (cut.height - corner.z) * normal.z <= kPlaceShare * scallop_;
    }
    return cuts ? OneMove::kCuts : OneMove::kGoesLowest;
}

bool ScallopAtPoint::settled(Vec3d point, Vec3d normal) const
{
    const SweptVolume::Lowest now = swept_->lowest(point.x, point.y);
    const LowerPositionProof::Verdict quick = quick_verdict(point, normal, kSettledShare, now);
    if (quick != LowerPositionProof::Verdict::kUnknown) {
        return quick == LowerPositionProof::Verdict::kNone;
    }
    const LowerTip better = searched(point, normal, kSettledShare, now);
    return !better.tip && !better.moved_clear;
}

ScallopAtPoint::Uncut ScallopAtPoint::uncut_at(Vec3d point, Vec3d normal, double resolution) const
{
    if (is_upright(normal)) {
        return {};
    }
    const SweptVolume::Lowest now = swept_->lowest(point.x, point.y);
    if (normal.z >= kUprightNormal && !std::isfinite(now.height)) {
        return {radius_, 0};
    }
    if ((now.height - point.z) * normal.z <= resolution) {
        return {};
    }
    const auto over = [&](double height) {
        return left_from(point, normal, height, now.height);
    };
    const double exact_below = now.height - resolution / normal.z;
    const std::optional<ReachableHeight::Position> best = reach_.lowest_over(point, exact_below);
    if (!best) {
        return {over(point.z), 0};
    }
    if (best->height > exact_below ||
        path_fitter_.moved_clear_of_edges({best->tip}).front() == best->tip) {
        return {over(best->height), 0};
    }
    const std::optional<ReachableHeight::Position> kept =
        reach_.lowest_clear_of_edges(point, *best, exact_below);
    return {kept ? over(kept->height) : 0, over(best->height)};
}

}  // namespace cusp::finishing
