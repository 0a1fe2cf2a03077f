// Rows of boxes make both queries local; the distance of two convex polygons is that of a corner.
#include "host_tools/cam/hull_rough/clear_zone.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::hull_rough {
namespace {

double distance(Vec2d p, const Rectangle& box)
{
    const double dx = std::max({box.x_min - p.x, p.x - box.x_max, 0.0});
    const double dy = std::max({box.y_min - p.y, p.y - box.y_max, 0.0});
    return elementary::hypot(dx, dy);
}

// Separating axes of a segment and a rectangle: x, y and the segment's normal.
bool crosses(Vec2d a, Vec2d b, const Rectangle& box)
{
    if (std::max(a.x, b.x) < box.x_min || std::min(a.x, b.x) > box.x_max ||
        std::max(a.y, b.y) < box.y_min || std::min(a.y, b.y) > box.y_max) {
        return false;
    }
    const Vec2d along = b - a;
    const std::array<double, 4> sides{cross(along, Vec2d{box.x_min, box.y_min} - a),
                                      cross(along, Vec2d{box.x_max, box.y_min} - a),
                                      cross(along, Vec2d{box.x_min, box.y_max} - a),
                                      cross(along, Vec2d{box.x_max, box.y_max} - a)};
    const auto [low, high] = std::minmax_element(sides.begin(), sides.end());
    return *low <= 0 && *high >= 0;
}

}  // namespace

double distance(Vec2d a, Vec2d b, const Rectangle& box)
{
    if (crosses(a, b, box)) {
        return 0;
    }
    double least = std::min(distance(a, box), distance(b, box));
    for (const Vec2d corner : {Vec2d{box.x_min, box.y_min}, Vec2d{box.x_max, box.y_min},
                               Vec2d{box.x_min, box.y_max}, Vec2d{box.x_max, box.y_max}}) {
        least = std::min(least, distance_to_segment(corner, a, b));
    }
    return least;
}

ClearZone::ClearZone(const std::vector<Rectangle>& boxes, const Rectangle& field, double radius)
    : field_{field}, radius_{radius}
{
    rows_.resize(static_cast<std::size_t>((field.y_max - field.y_min) / (2 * radius)) + 1);
    for (const Rectangle& box : boxes) {
        for (std::size_t row = row_at(box.y_min - radius); row <= row_at(box.y_max + radius);
             ++row) {
            rows_[row].push_back(box);
        }
    }
}

std::size_t ClearZone::row_at(double y) const
{
    const double row = std::floor((y - field_.y_min) / (2 * radius_));
    return static_cast<std::size_t>(std::clamp(row, 0.0, static_cast<double>(rows_.size()) - 1));
}

bool ClearZone::inside_field(Vec2d p) const
{
    return p.x >= field_.x_min && p.x <= field_.x_max && p.y >= field_.y_min && p.y <= field_.y_max;
}

std::vector<Interval> ClearZone::on_line(double y) const
{
    std::vector<Interval> blocked;
    for (const Rectangle& box : rows_[row_at(y)]) {
        const double dy = std::max({box.y_min - y, y - box.y_max, 0.0});
        if (dy < radius_) {
            const double reach = std::sqrt(radius_ * radius_ - dy * dy);
            blocked.push_back({box.x_min - reach, box.x_max + reach});
        }
    }
    std::sort(blocked.begin(), blocked.end(),
              [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
    std::vector<Interval> out;
    double x = field_.x_min;
    for (const Interval& b : blocked) {
        if (b.begin >= x) {
            out.push_back({x, std::min(b.begin, field_.x_max)});
        }
        x = std::max(x, b.end);
        if (x > field_.x_max) {
            return out;
        }
    }
    out.push_back({x, field_.x_max});
    return out;
}

bool ClearZone::distance_holds(Vec2d a, Vec2d b, double least) const
{
    // Slightly less than the radius, since intervals of on_line() end exactly at that.
    constexpr double kRounding = 1e-9;
    if (!inside_field(a) || !inside_field(b)) {
        return false;
    }
    const std::size_t last = row_at(std::max(a.y, b.y) + least);
    for (std::size_t row = row_at(std::min(a.y, b.y) - least); row <= last; ++row) {
        for (const Rectangle& box : rows_[row]) {
            const bool near =
                std::max(a.x, b.x) > box.x_min - least && std::min(a.x, b.x) < box.x_max + least;
            if (near && distance(a, b, box) < least - kRounding) {
                return false;
            }
        }
    }
    return true;
}

bool ClearZone::room(Vec2d point, double extra) const
{
    return inside_field(point) && distance_holds(point, point, radius_ + extra);
}

}  // namespace cusp::hull_rough
