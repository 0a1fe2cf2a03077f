// Boxes are compared with those that are kept, in order.
#include "host_tools/cam/adaptive_clearing/stock_spots.hpp"

#include <algorithm>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::adaptive_clearing {

using offset::Box2d;
using offset::box_of;
using offset::Contour;
using offset::Edge;
using offset::Region2d;

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
    return elementary::hypot(std::max({box.x0 - p.x, 0.0, p.x - box.x1}),
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

std::vector<Box2d> spots_along(const std::vector<const Region2d*>& regions, const WallSpace& space)
{
    constexpr double kAround = 0.5;  // radii
    std::vector<Box2d> spots;
    for (const Region2d* region : regions) {
        for (const Contour& contour : region->contours) {
            for (const std::vector<Edge>& path : uncut_stretches(contour, space).paths) {
                spots.push_back(
                    grown_box(box_of(Region2d{{path}}), kAround * space.swept.radius()));
            }
        }
    }
    return joined(spots);
}

double turns_by(const Region2d& region, const Box2d& spot)
{
    constexpr double kSame = 1e-6;  // mm
    double most = 0.0;
    for (const Contour& contour : region.contours) {
        // The contour may begin within an arc.
        double turn = 0.0;
        const Edge* before = &contour.back();
        for (int round = 0; round < 2; ++round) {
            for (const Edge& edge : contour) {
                const bool goes_on = before->turn > 0 && norm(before->centre - edge.centre) < kSame;
                turn = edge.turn <= 0 ? 0.0 : (goes_on ? turn : 0.0) + sweep(edge);
                if (turn > most && meet(box_of(edge), spot)) {
                    most = turn;
                }
                before = &edge;
            }
        }
    }
    return std::min(most, 2 * kPi);
}

Box2d take_nearest(std::vector<Box2d>& spots, Vec2d place)
{
    const auto next =
        std::min_element(spots.begin(), spots.end(), [&](const Box2d& a, const Box2d& b) {
            return distance_to(a, place) < distance_to(b, place);
        });
    const Box2d spot = *next;
    spots.erase(next);
    return spot;
}

}  // namespace cusp::adaptive_clearing
