// Lengths are summed over all heights; places are named once.
#include "host_tools/adaptive_clearing/engagement_report.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"

#include "fmt/format.h"

namespace cusp::adaptive_clearing {

using toolpath::OperationStats;

namespace {

constexpr double kDegrees = kPi / 180.0;
constexpr std::size_t kNamedPlaces = 5;

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
    std::vector<Place> worst = over_;
    std::stable_sort(worst.begin(), worst.end(), [](const Place& a, const Place& b) {
        return a.z && b.z && a.over.engagement > b.over.engagement;
    });
    for (std::size_t i = 0; i < std::min(kNamedPlaces, worst.size()); ++i) {
        const OverEngagement& over = worst[i].over;
        stats.warnings.push_back(
            fmt::format("the engagement is {:g} degrees at {}, over max_engagement on {:g} mm: {}",
                        std::round(over.engagement / kDegrees), place_text(over.at, worst[i].z),
                        std::round(over.length * 1e2) * 1e-2, reason_text(over)));
    }
    if (over_.size() > kNamedPlaces) {
        stats.warnings.push_back(
            fmt::format("{} more places over max_engagement", over_.size() - kNamedPlaces));
    }
}

}  // namespace cusp::adaptive_clearing
