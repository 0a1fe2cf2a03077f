// At a corner the segment tells to which the place lies more square.
#include "host_tools/judge/verify/line_side.hpp"

#include <algorithm>

namespace cusp::verify {

std::optional<double> LineSide::left(double x, double y) const
{
    constexpr double kSame = 1e-9;      // mm
    constexpr double kRounding = 1e-6;  // mm, along the line beyond its ends
    const Vec2d p{x, y};
    double nearest = kUnbounded;
    double beside = 0;
    bool beyond = false;
    const bool is_closed = norm(points_.front() - points_.back()) < kSame;
    for (std::size_t k = 0; k + 1 < points_.size(); ++k) {
        const Vec2d way = points_[k + 1] - points_[k];
        const double length = norm(way);
        if (length < kSame) {
            continue;
        }
        const Vec2d along = way * (1 / length);
        const double foot = dot(p - points_[k], along);
        const double away = norm(p - (points_[k] + along * std::clamp(foot, 0.0, length)));
        const double left = cross(along, p - points_[k]);
        if (away > nearest + kSame ||
            (away > nearest - kSame && std::fabs(left) <= std::fabs(beside))) {
            continue;
        }
        nearest = std::min(nearest, away);
        beside = left;
        beyond = !is_closed && ((k == 0 && foot < -kRounding) ||
                                (k + 2 == points_.size() && foot > length + kRounding));
    }
    return beyond ? std::nullopt : std::optional{beside < 0 ? -nearest : nearest};
}

}  // namespace cusp::verify
