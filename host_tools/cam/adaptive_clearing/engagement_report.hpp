// The engagement of an operation's adaptive paths, for statistics and warnings.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/cam/adaptive_clearing/adaptive_clearing.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::adaptive_clearing {

class EngagementReport {
public:
    // max_engagement  degrees, as asked
    explicit EngagementReport(double max_engagement) : max_engagement_{max_engagement} {}

    // A path that is cut at so many heights; z names the place of warnings where paths differ.
    void add(const AdaptivePath& path, std::size_t heights, std::optional<double> z = {});

    double bound() const { return bound_; }  // degrees, outside what is over

    // Adds max_engagement_deg, engagement_bound_deg, over_engagement_mm, over_engagement_places
    // and sliver_points, and warnings with places.
    void write(toolpath::OperationStats& stats) const;

private:
    struct Place {
        OverEngagement over;
        std::optional<double> z;
    };
    struct Sliver {
        Vec2d at;
        std::optional<double> z;
    };
    double max_engagement_;
    double bound_{};
    double over_length_{};
    std::vector<Place> over_;
    std::vector<Sliver> slivers_;
};

}  // namespace cusp::adaptive_clearing
