// Stock as heights on a raster, cut place by place: an oracle for programs of one tool.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::test {

class HeightRaster {
public:
    HeightRaster(const offset::Box2d& box, double top, double pitch)
        : box_{box},
          pitch_{pitch},
          columns_{1 + static_cast<int>((box.x1 - box.x0) / pitch)},
          rows_{1 + static_cast<int>((box.y1 - box.y0) / pitch)},
          heights_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_),
                   static_cast<float>(top))
    {
    }

    // Removes what a flat end with its tip there covers. Returns the height of the highest column
    // that it takes off, mm, but for those within `margin` (mm) of its circumference.
    double cut(Vec3d tip, double radius, double margin)
    {
        float deepest = 0.0F;
        const auto z = static_cast<float>(tip.z);
        const double y = (tip.y - box_.y0) / pitch_;
        const double r = radius / pitch_;
        const double inner = (radius - margin) / pitch_;
        const int j1 = std::min(rows_ - 1, static_cast<int>(std::floor(y + r)));
        for (int j = std::max(0, static_cast<int>(std::ceil(y - r))); j <= j1; ++j) {
            const double x = (tip.x - box_.x0) / pitch_;
            const double half = std::sqrt(std::max(0.0, r * r - (j - y) * (j - y)));
            const double judged = std::sqrt(std::max(0.0, inner * inner - (j - y) * (j - y)));
            const int i1 = std::min(columns_ - 1, static_cast<int>(std::floor(x + half)));
            for (int i = std::max(0, static_cast<int>(std::ceil(x - half))); i <= i1; ++i) {
                float& height = heights_[index(i, j)];
                deepest = std::abs(i - x) < judged ? std::max(deepest, height - z) : deepest;
                height = std::min(height, z);
            }
        }
        return static_cast<double>(deepest);
    }

    struct Pose {
        Vec2d at;
        Vec2d heading;
    };

    double ahead() const { return 2.0 * pitch_; }

    // Degrees of the front half of a circle, just outside of it, where stock is higher than z and
    // is met on the way to `next`, ahead() farther: slivers along a wall just cut do not count.
    double engagement(double radius, const Pose& now, const Pose& next, double z) const
    {
        int count = 0;
        for (int k = -90; k <= 90; ++k) {
            const double angle = k * 0.017453292519943295;
            const auto at = [&](const Pose& pose, double out) {
                const Vec2d left{-pose.heading.y, pose.heading.x};
                return pose.at + (pose.heading * std::cos(angle) + left * std::sin(angle)) * out;
            };
            const bool ahead_of_it = stock_at(at(now, radius + 0.75 * pitch_)) > z;
            count += ahead_of_it && stock_at(at(next, radius)) > z ? 1 : 0;
        }
        return count * 180.0 / 181.0;
    }

private:
    double stock_at(Vec2d p) const
    {
        const auto i = static_cast<int>(std::lround((p.x - box_.x0) / pitch_));
        const auto j = static_cast<int>(std::lround((p.y - box_.y0) / pitch_));
        const bool within = i >= 0 && j >= 0 && i < columns_ && j < rows_;
        return within ? static_cast<double>(heights_[index(i, j)]) : kUnbounded;
    }
    std::size_t index(int i, int j) const
    {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(i);
    }

    offset::Box2d box_;
    double pitch_;
    int columns_;
    int rows_;
    std::vector<float> heights_;
};

}  // namespace cusp::test
