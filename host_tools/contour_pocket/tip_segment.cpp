// The lowest that a straight move cuts over a place, for each shape of end.
#include "host_tools/contour_pocket/tip_segment.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::host {

namespace {

struct Range {
    double low, high;
};

// Where on a straight piece of length `whole` the tool's axis is within `reach` of a place, its
// foot at `along`.
Range within(double along, double reach, double whole)
{
    return {std::max(0.0, along - reach), std::min(whole, along + reach)};
}

// A convex function's least value over the range.
template <class Function>
double least_of(const Function& f, Range range)
{
    constexpr int kRounds = 24;
    constexpr double kGolden = 0.6180339887498949;
    double a = range.low;
    double b = range.high;
    double c = b - kGolden * (b - a);
    double d = a + kGolden * (b - a);
    double fc = f(c);
    double fd = f(d);
    for (int i = 0; i < kRounds; ++i) {
        if (fc < fd) {
            b = d;
            d = c;
            fd = fc;
            c = b - kGolden * (b - a);
            fc = f(c);
        } else {
            a = c;
            c = d;
            fc = fd;
            d = a + kGolden * (b - a);
            fd = f(d);
        }
    }
    return std::min({f(a), f(b), fc, fd});
}

}  // namespace

double cut_over(const Tool& tool, const TipSegment& segment, Vec2d at)
{
    const Vec2d a{segment.start.x, segment.start.y};
    const Vec2d move = in_plan(segment.end) - a;
    const double whole = std::sqrt(dot(move, move));
    if (whole < 1e-9) {
        return std::min(segment.start.z, segment.end.z) + profile_height(tool, distance(a, at));
    }
    const Vec2d way = move * (1.0 / whole);
    const double slope = (segment.end.z - segment.start.z) / whole;
    const double along = dot(at - a, way);
    const double away = std::abs(cross(way, at - a));
    const double square = tool.radius * tool.radius - away * away;
    const Range range = within(along, std::sqrt(std::max(square, 0.0)), whole);
    if (square <= 0.0 || range.low > range.high) {
        return kNowhere;
    }
    const auto height = [&](double s) {
        const double apart = std::sqrt(away * away + (s - along) * (s - along));
        return segment.start.z + slope * s + profile_height(tool, std::min(apart, tool.radius));
    };
    if (tool.corner_radius == 0.0) {
        return segment.start.z + slope * (slope > 0.0 ? range.low : range.high);
    }
    if (tool.corner_radius >= tool.radius) {
        const double lowest = along - slope * std::sqrt(square / (1.0 + slope * slope));
        return height(std::clamp(lowest, range.low, range.high));
    }
    return least_of(height, range);
}

}  // namespace cusp::host
