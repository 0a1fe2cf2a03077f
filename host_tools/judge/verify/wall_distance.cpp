// Buckets of segments: squares for the distance, strips for the side.
#include "host_tools/judge/verify/wall_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host_tools/job/job/loop_shape.hpp"

namespace cusp::verify {

using job::Loop;
using job::loop_polyline;

namespace {

constexpr std::size_t kLevels = 2000;

double distance_to(Vec2d p, Vec2d a, Vec2d b)
{
    const Vec2d along = b - a;
    const double squared = dot(along, along);
    const double foot = squared > 0 ? std::clamp(dot(p - a, along) / squared, 0.0, 1.0) : 0.0;
    return norm(p - (a + foot * along));
}

}  // namespace

WallDistance::WallDistance(const Loop& loop, bool outer, double cap) : outer_{outer}, cap_{cap}
{
    const std::vector<Vec2d> line = loop_polyline(loop, kWallChord);
    Vec2d low{kInfinite, kInfinite};
    Vec2d high{-kInfinite, -kInfinite};
    for (const Vec2d p : line) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
    x0_ = low.x - cap_;
    y0_ = low.y - cap_;
    nx_ = static_cast<std::size_t>((high.x - low.x) / cap_) + 3;
    ny_ = static_cast<std::size_t>((high.y - low.y) / cap_) + 3;
    buckets_.resize(nx_ * ny_);
    levels_.resize(kLevels);
    level_height_ = (high.y - low.y) / static_cast<double>(kLevels) + 1e-12;
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
        segments_.push_back({line[k], line[k + 1]});
        const auto column = [&](double x) {
            return static_cast<std::size_t>((x - x0_) / cap_);
        };
        const auto row = [&](double y) {
            return static_cast<std::size_t>((y - y0_) / cap_);
        };
        const Segment& s = segments_.back();
        for (std::size_t i = column(std::min(s.a.x, s.b.x)); i <= column(std::max(s.a.x, s.b.x));
             ++i) {
            for (std::size_t j = row(std::min(s.a.y, s.b.y)); j <= row(std::max(s.a.y, s.b.y));
                 ++j) {
                buckets_[i * ny_ + j].push_back(k);
            }
        }
        const auto level = [&](double y) {
            return std::min(kLevels - 1,
                            static_cast<std::size_t>((y - (y0_ + cap_)) / level_height_));
        };
        for (std::size_t n = level(std::min(s.a.y, s.b.y)); n <= level(std::max(s.a.y, s.b.y));
             ++n) {
            levels_[n].push_back(k);
        }
    }
}

bool WallDistance::encloses(double x, double y) const
{
    const double height = (y - (y0_ + cap_)) / level_height_;
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

double WallDistance::at(double x, double y) const
{
    double nearest = cap_;
    const double column = (x - x0_) / cap_;
    const double row = (y - y0_) / cap_;
    if (column > -1 && row > -1 && column < static_cast<double>(nx_) + 1 &&
        row < static_cast<double>(ny_) + 1) {
        const auto around = [](double at, std::size_t limit) {
            const double low = std::max(0.0, std::floor(at) - 1);
            const double high = std::min(static_cast<double>(limit), std::floor(at) + 2);
            return std::pair{static_cast<std::size_t>(low),
                             static_cast<std::size_t>(std::max(0.0, high))};
        };
        const auto [i0, i1] = around(column, nx_);
        const auto [j0, j1] = around(row, ny_);
        for (std::size_t i = i0; i < i1; ++i) {
            for (std::size_t j = j0; j < j1; ++j) {
                for (const std::size_t k : bucket(i, j)) {
                    nearest =
                        std::min(nearest, distance_to({x, y}, segments_[k].a, segments_[k].b));
                }
            }
        }
    }
    return encloses(x, y) == outer_ ? nearest : -nearest;
}

}  // namespace cusp::verify
