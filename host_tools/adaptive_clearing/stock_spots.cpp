// Boxes are compared with those that are kept, in order.
#include "host_tools/adaptive_clearing/stock_spots.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::adaptive_clearing {

using offset::Box2d;

Box2d grown_box(Box2d box, double by)
{
    return {box.x0 - by, box.y0 - by, box.x1 + by, box.y1 + by};
}

namespace {

Box2d around(const Box2d& a, const Box2d& b)
{
    return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

}  // namespace

double distance_to(const Box2d& box, Vec2d p)
{
    return std::hypot(std::max({box.x0 - p.x, 0.0, p.x - box.x1}),
                      std::max({box.y0 - p.y, 0.0, p.y - box.y1}));
}

std::vector<Box2d> joined(const std::vector<Box2d>& boxes)
{
    constexpr double kMore = 1.3;  // times the larger one's circumference
    const auto half = [](const Box2d& b) {
        return b.x1 - b.x0 + b.y1 - b.y0;
    };
    std::vector<Box2d> result;
    for (const Box2d& box : boxes) {
        const auto same = std::find_if(result.begin(), result.end(), [&](const Box2d& other) {
            return half(around(box, other)) < kMore * std::max(half(box), half(other));
        });
        if (same == result.end()) {
            result.push_back(box);
        } else {
            *same = around(box, *same);
        }
    }
    return result;
}

}  // namespace cusp::adaptive_clearing
