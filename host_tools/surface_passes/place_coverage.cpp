// Moves near the place are tried one by one; best tips come from `LowestReach`.
#include "host_tools/surface_passes/place_coverage.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::host {
namespace {

constexpr double kReachStep = 0.25;    // in steps between passes
constexpr double kReachPitch = 0.125;  // radii, at least
// How high drops may be: mm, but no less and no more than shares of the scallop. A part of metres
// would be cut to millions of pieces otherwise.
constexpr double kDropAccuracy = 1e-4;
constexpr double kLeastDropShare = 0.001;
constexpr double kMostDropShare = 0.005;
constexpr double kAgrees = 3;        // of the accuracy of drops: what searches tell apart
constexpr double kTraceApart = 0.3;  // in steps between passes, of tips that one line may join
constexpr double kFarApart = 0.5;    // radii, of tips that one pass may join
constexpr double kShortest = 1e-3;   // mm

}  // namespace

Vec3d raised(Vec3d point, Vec3d normal, double scallop, bool upright)
{
    return upright ? point + Vec3d{0, 0, scallop / normal.z} : point + normal * scallop;
}

Vec3d centre_under(Vec3d top, Vec3d normal, double scallop, double radius)
{
    return top + normal * (radius - scallop);
}

PlaceCoverage::PlaceCoverage(const std::vector<Surface>& surfaces,
                             const CertifiedPasses& certified,
                             double scallop,
                             double path_off)
    : certified_{certified},
      radius_{certified.tool().radius},
      scallop_{scallop},
      path_off_{path_off},
      step_{std::sqrt(8 * radius_ * scallop)},
      swept_{radius_, 0.6 * step_},
      accuracy_{std::clamp(kDropAccuracy, kLeastDropShare * scallop, kMostDropShare * scallop)},
      reach_{surfaces, certified, std::max(kReachStep * step_, kReachPitch * radius_), accuracy_}
{
    if (surfaces.empty()) {
        lower_ball_.emplace(certified, std::max(kReachStep * step_, kReachPitch * radius_));
    }
}

Vec3d PlaceCoverage::touching_tip(Vec3d point, Vec3d normal) const
{
    return point + normal * (radius_ + certified_.band().lift) - Vec3d{0, 0, radius_};
}

bool PlaceCoverage::covered(Vec3d point, Vec3d normal, double share) const
{
    const double allowed = scallop_ * share;
    const Vec3d top = raised(point, normal, allowed, normal.z >= kSteepNormal);
    swept_.near(centre_under(top, normal, allowed, radius_), near_);
    return std::any_of(near_.begin(), near_.end(),
                       [&](std::uint32_t move) { return swept_.removes(move, top, path_off_); });
}

// What is told at once of whether a ball takes off more than a share of the scallop, by what
// searches tell apart.
LowerBall::Answer PlaceCoverage::told_at_once(Vec3d point,
                                              Vec3d normal,
                                              double share,
                                              const SweptBalls::Lowest& now) const
{
    const double worth = scallop_ * share / normal.z;
    if (now.height - point.z <= worth) {
        return LowerBall::Answer::kNone;
    }
    if (!lower_ball_ || !std::isfinite(now.height)) {
        return LowerBall::Answer::kUnknown;
    }
    return lower_ball_->over({point.x, point.y, now.height - worth - kAgrees * accuracy_},
                             now.centre);
}

PlaceCoverage::Better PlaceCoverage::searched(Vec3d point,
                                              Vec3d normal,
                                              double share,
                                              const SweptBalls::Lowest& now) const
{
    const double worth = scallop_ * share;
    const double cosine = normal.z;
    const std::optional<LowestReach::Answer> best = reach_.over(point, now.height - worth / cosine);
    if (!best || (now.height - best->height) * cosine <= worth) {
        return {};
    }
    if (certified_.kept_off_edges({best->tip}).front() == best->tip) {
        return {best->tip, (now.height - best->height) * cosine, false};
    }
    const std::optional<LowestReach::Answer> kept =
        reach_.kept_off_edges(point, *best, now.height - worth / cosine);
    if (!kept || (now.height - kept->height) * cosine <= worth) {
        return {std::nullopt, 0, true};
    }
    return {kept->tip, (now.height - kept->height) * cosine, false};
}

PlaceCoverage::Better PlaceCoverage::better_tip(Vec3d point, Vec3d normal, double share) const
{
    const SweptBalls::Lowest now = swept_.lowest(point.x, point.y);
    return told_at_once(point, normal, share, now) == LowerBall::Answer::kNone
               ? Better{}
               : searched(point, normal, share, now);
}

bool PlaceCoverage::nothing_better(Vec3d point, Vec3d normal) const
{
    return told_at_once(point, normal, 1, swept_.lowest(point.x, point.y)) ==
           LowerBall::Answer::kNone;
}

bool PlaceCoverage::settled(Vec3d point, Vec3d normal) const
{
    const SweptBalls::Lowest now = swept_.lowest(point.x, point.y);
    const LowerBall::Answer told = told_at_once(point, normal, kSettledShare, now);
    if (told != LowerBall::Answer::kUnknown) {
        return told == LowerBall::Answer::kNone;
    }
    const Better better = searched(point, normal, kSettledShare, now);
    return !better.tip && !better.kept_off;
}

PlaceCoverage::Left PlaceCoverage::left_at(Vec3d point, Vec3d normal, double worth) const
{
    const SweptBalls::Lowest now = swept_.lowest(point.x, point.y);
    if (!std::isfinite(now.height)) {
        return {radius_, 0};
    }
    if ((now.height - point.z) * normal.z <= worth) {
        return {};
    }
    const auto over = [&](double height) {
        const double from = std::max(point.z, height);
        return std::min(radius_, std::max(0.0, (now.height - from) * normal.z));
    };
    const double told_apart = now.height - worth / normal.z;
    const std::optional<LowestReach::Answer> best = reach_.over(point, told_apart);
    if (!best) {
        return {over(point.z), 0};
    }
    if (best->height > told_apart || certified_.kept_off_edges({best->tip}).front() == best->tip) {
        return {over(best->height), 0};
    }
    const std::optional<LowestReach::Answer> kept = reach_.kept_off_edges(point, *best, told_apart);
    return {kept ? over(kept->height) : 0, over(best->height)};
}

std::vector<Points> PlaceCoverage::runs_of(const Points& tips) const
{
    // A place that is at the limit may have its tip when asked once and none the next time: drops
    // are right to a micrometre only.
    if (tips.empty()) {
        return {};
    }
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

}  // namespace cusp::host
