// How low an end could cut over places of a part, by brute force: dropped on samples, on a raster of tips.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/judges/profile_judge.hpp"

namespace cusp::test {

class ReachableByDrops {
public:
    // off  mm: as far as passes may keep off the part
    ReachableByDrops(const Triangles& mesh, const toolpath::Tool& tool, double off)
        : part_{mesh}, mesh_{mesh}, tool_{tool}
    {
        // thicker by half the distance of samples: no part of the mesh lies in the end between them
        const toolpath::Tool thick = thicker(tool, off + 0.5 * kSamplePitch);
        Vec2d high{-kFar, -kFar};
        for (const auto& t : mesh) {
            for (const Vec3d& p : t) {
                low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
                high = {std::max(high.x, p.x), std::max(high.y, p.y)};
            }
        }
        low_ = low_ - Vec2d{tool.radius, tool.radius};
        columns_ = 2 + static_cast<int>((high.x + tool.radius - low_.x) / kTipPitch);
        rows_ = 2 + static_cast<int>((high.y + tool.radius - low_.y) / kTipPitch);
        for (int i = 0; i < columns_; ++i) {
            for (int j = 0; j < rows_; ++j) {
                const Vec2d at = place_of(i, j);
                tips_.push_back(part_.drop(thick, at.x, at.y));
            }
        }
    }

    // z; kFar where the end can't be.
    double lowest_over(Vec3d place) const
    {
        double least = kFar;
        const auto node = [](double at, double low) {
            return static_cast<int>(std::floor((at - low) / kTipPitch));
        };
        const double r = tool_.radius;
        for (int i = node(place.x - r, low_.x); i <= node(place.x + r, low_.x) + 1; ++i) {
            for (int j = node(place.y - r, low_.y); j <= node(place.y + r, low_.y) + 1; ++j) {
                if (i < 0 || j < 0 || i >= columns_ || j >= rows_) {
                    continue;
                }
                const Vec2d at = place_of(i, j);
                const double away = std::hypot(at.x - place.x, at.y - place.y);
                const double tip =
                    tips_[static_cast<std::size_t>(i) * static_cast<std::size_t>(rows_) +
                          static_cast<std::size_t>(j)];
                if (away <= r && tip > -kFar) {
                    least = std::min(least, tip + toolpath::profile_height(tool_, away));
                }
            }
        }
        return least;
    }

    // z of the part over a place in plan.
    double top_over(Vec3d place) const
    {
        double top = -kFar;
        for (const auto& t : mesh_) {
            const auto side = [&](Vec3d a, Vec3d b) {
                return (b.x - a.x) * (place.y - a.y) - (b.y - a.y) * (place.x - a.x);
            };
            const double a = side(t[1], t[2]);
            const double b = side(t[2], t[0]);
            const double c = side(t[0], t[1]);
            const double area = a + b + c;
            if (std::abs(area) > 1e-12 && a / area >= 0 && b / area >= 0 && c / area >= 0) {
                top = std::max(top, (a * t[0].z + b * t[1].z + c * t[2].z) / area);
            }
        }
        return top;
    }

private:
    static constexpr double kTipPitch = 0.05;  // mm

    Vec2d place_of(int i, int j) const { return {low_.x + i * kTipPitch, low_.y + j * kTipPitch}; }

    SampledPart part_;
    const Triangles& mesh_;
    toolpath::Tool tool_;
    Vec2d low_{kFar, kFar};
    int columns_{};
    int rows_{};
    std::vector<double> tips_;
};

}  // namespace cusp::test
