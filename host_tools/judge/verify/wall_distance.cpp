// Boxes round segments for the distance, strips of them for the side.
#include "host_tools/judge/verify/wall_distance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "host_tools/job/job/loop_shape.hpp"

namespace cusp::verify {

using job::Loop;
using job::loop_polyline;

namespace {

constexpr std::size_t kLevels = 2000;
constexpr std::size_t kInBox = 8;   // segments or boxes
constexpr double kRounding = 1e-9;  // mm: by which boxes are wider than their segments

double squared_from_box(Vec2d p, Vec2d low, Vec2d high)
{
    const double dx = std::max({low.x - p.x, p.x - high.x, 0.0});
    const double dy = std::max({low.y - p.y, p.y - high.y, 0.0});
    return dx * dx + dy * dy;
}

double squared_from_segment(Vec2d p, Vec2d a, Vec2d b)
{
    const Vec2d along = b - a;
    const double squared = dot(along, along);
    const double foot = squared > 0 ? std::clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0.0;
    const Vec2d away = p - (a + foot * along);
    return dot(away, away);
}

}  // namespace

WallDistance::WallDistance(const Loop& loop, bool outer, double cap) : outer_{outer}, cap_{cap}
{
    const std::vector<Vec2d> line = loop_polyline(loop, kWallChord);
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
        segments_.push_back({line[k], line[k + 1]});
    }
    add_boxes();
    y0_ = boxes_.back().front().low.y;
    level_height_ = (boxes_.back().front().high.y - y0_) / static_cast<double>(kLevels) + 1e-12;
    levels_.resize(kLevels);
    const auto level = [&](double y) {
        return std::min(kLevels - 1, static_cast<std::size_t>((y - y0_) / level_height_));
    };
    for (std::size_t k = 0; k < segments_.size(); ++k) {
        const auto [low, high] = std::minmax(segments_[k].a.y, segments_[k].b.y);
        for (std::size_t n = level(low); n <= level(high); ++n) {
            levels_[n].push_back(k);
        }
    }
}

void WallDistance::add_boxes()
{
    std::vector<Box> inner;
    for (const Segment& s : segments_) {
        const auto [x_low, x_high] = std::minmax(s.a.x, s.b.x);
        const auto [y_low, y_high] = std::minmax(s.a.y, s.b.y);
        inner.push_back(
            {{x_low - kRounding, y_low - kRounding}, {x_high + kRounding, y_high + kRounding}});
    }
    do {
        std::vector<Box> outer;
        for (std::size_t k = 0; k < inner.size(); ++k) {
            if (k % kInBox == 0) {
                outer.push_back(inner[k]);
            }
            Box& own = outer.back();
            own.low = {std::min(own.low.x, inner[k].low.x), std::min(own.low.y, inner[k].low.y)};
            own.high = {std::max(own.high.x, inner[k].high.x),
                        std::max(own.high.y, inner[k].high.y)};
        }
        inner = outer;
        boxes_.push_back(std::move(outer));
    } while (inner.size() > 1);
}

bool WallDistance::encloses(double x, double y) const
{
    const double height = (y - y0_) / level_height_;
    if (!(height >= 0) || height >= static_cast<double>(kLevels)) {
        return false;
    }
    bool inside = false;
    for (const std::size_t k : levels_[static_cast<std::size_t>(height)]) {
        const Segment& s = segments_[k];
        if ((s.a.y <= y) != (s.b.y <= y) &&
            x < (s.b.x - s.a.x) * (y - s.a.y) / (s.b.y - s.a.y) + s.a.x) {
            inside = !inside;
        }
    }
    return inside;
}

// Reduces `square` to the squared distance of the nearest segment in a box.
void WallDistance::approach(Vec2d p, std::size_t level, std::size_t box, double& square) const
{
    const std::size_t first = box * kInBox;
    if (level == 0) {
        const std::size_t end = std::min(segments_.size(), first + kInBox);
        for (std::size_t k = first; k < end; ++k) {
            square = std::min(square, squared_from_segment(p, segments_[k].a, segments_[k].b));
        }
        return;
    }
    const std::vector<Box>& inner = boxes_[level - 1];
    const std::size_t count = std::min(inner.size() - first, kInBox);
    std::array<double, kInBox> away{};
    for (std::size_t k = 0; k < count; ++k) {
        away[k] = squared_from_box(p, inner[first + k].low, inner[first + k].high);
    }
    const auto nearest = static_cast<std::size_t>(
        std::min_element(away.begin(), away.begin() + count) - away.begin());
    for (std::size_t turn = 0; turn < count; ++turn) {
        const std::size_t k = (nearest + turn) % count;
        if (away[k] < square) {
            approach(p, level - 1, first + k, square);
        }
    }
}

double WallDistance::at(double x, double y) const
{
    double square = (cap_ + kRounding) * (cap_ + kRounding);
    const Box& all = boxes_.back().front();
    if (squared_from_box({x, y}, all.low, all.high) < square) {
        approach({x, y}, boxes_.size() - 1, 0, square);
    }
    const double nearest = std::min(cap_, std::sqrt(square));
    return encloses(x, y) == outer_ ? nearest : -nearest;
}

}  // namespace cusp::verify
