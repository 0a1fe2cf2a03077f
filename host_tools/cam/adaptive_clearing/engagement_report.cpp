// Lengths are summed over all heights; places are named once.
#include "host_tools/cam/adaptive_clearing/engagement_report.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"

#include "fmt/format.h"

namespace cusp::adaptive_clearing {

using toolpath::OperationStats;

namespace {

constexpr double kDegrees = kPi / 180.0;
constexpr std::size_t kNamedPlaces = 5;
constexpr double kCornerEnd = 0.1;  // mm of way: less is the end of a corner

std::string place_text(Vec2d at, std::optional<double> z)
{
    const double x = std::round(at.x * 1e3) * 1e-3;
    const double y = std::round(at.y * 1e3) * 1e-3;
    return z ? fmt::format("({:g}, {:g}, {:g}) mm", x, y, *z)
             : fmt::format("({:g}, {:g}) mm", x, y);
}

std::string reason_text(const OverEngagement& over)
{
    return over.slot_width ? fmt::format("the slot is {:g} mm wide, too narrow for trochoids",
                                         std::round(*over.slot_width * 1e3) * 1e-3)
                           : "no pass into this corner or neck has less";
}

}  // namespace

void EngagementReport::add(const AdaptivePath& path, std::size_t heights, std::optional<double> z)
{
    bound_ = std::max(bound_, path.engagement_bound / kDegrees);
    for (const OverEngagement& over : path.over) {
        over_length_ += over.length * static_cast<double>(heights);
        over_.push_back({over, z});
    }
    for (const Vec2d at : path.left) {
        slivers_.push_back({at, z});
    }
}

void EngagementReport::write(OperationStats& stats) const
{
    stats.counts.emplace_back("max_engagement_deg", max_engagement_);
    stats.counts.emplace_back("engagement_bound_deg", bound_);
    stats.counts.emplace_back("over_engagement_mm", over_length_);
    stats.counts.emplace_back("over_engagement_places", static_cast<double>(over_.size()));
    stats.counts.emplace_back("sliver_points", static_cast<double>(slivers_.size()));
    if (!slivers_.empty()) {
        stats.warnings.push_back(fmt::format("a sliver stays at {}: no straight move reaches it",
                                             place_text(slivers_.front().at, slivers_.front().z)));
    }
    // The very ends of corners have one warning together.
    std::vector<Place> worst = over_;
    std::stable_sort(worst.begin(), worst.end(), [](const Place& a, const Place& b) {
        return a.z && b.z && a.over.engagement > b.over.engagement;
    });
    const auto corners = std::stable_partition(
        worst.begin(), worst.end(), [](const Place& p) { return p.over.length >= kCornerEnd; });
    const auto named = static_cast<std::size_t>(corners - worst.begin());
    for (std::size_t i = 0; i < std::min(kNamedPlaces, named); ++i) {
        const OverEngagement& over = worst[i].over;
        stats.warnings.push_back(
            fmt::format("the engagement is {:g} degrees at {}, over max_engagement on {:g} mm: {}",
                        std::round(over.engagement / kDegrees), place_text(over.at, worst[i].z),
                        std::round(over.length * 1e2) * 1e-2, reason_text(over)));
    }
    if (named > kNamedPlaces) {
        stats.warnings.push_back(
            fmt::format("{} more places over max_engagement", named - kNamedPlaces));
    }
    if (corners != worst.end()) {
        const auto most = std::max_element(
            corners, worst.end(),
            [](const Place& a, const Place& b) { return a.over.engagement < b.over.engagement; });
        stats.warnings.push_back(fmt::format(
            "the engagement is up to {:g} degrees, over max_engagement on less than {:g} mm, at "
            "the "
            "end of {} {}, such as at {}",
            std::round(most->over.engagement / kDegrees), kCornerEnd, worst.end() - corners,
            worst.end() - corners == 1 ? "corner" : "corners", place_text(most->over.at, most->z)));
    }
}

}  // namespace cusp::adaptive_clearing
