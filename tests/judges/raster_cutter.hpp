// A simple cutter on a raster: the stock that a path leaves, and the tool's engagement along
// it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::test {

class RasterCutter {
public:
    // Stock fills the region, except within `margin` (mm) of its contours.
    RasterCutter(const offset::Region2d& region, double radius, double pitch, double margin)
        : radius_{radius}, pitch_{pitch}
    {
        const offset::RegionOffset walls{region};
        const offset::Box2d box = offset::box_of(region);
        corner_ = {box.x0, box.y0};
        columns_ = static_cast<int>((box.x1 - box.x0) / pitch) + 1;
        rows_ = static_cast<int>((box.y1 - box.y0) / pitch) + 1;
        metal_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
        for (int j = 0; j < rows_; ++j) {
            double known = 0.0;  // mm to the right in which nothing changes
            bool inside = false;
            for (int i = 0; i < columns_; ++i, known -= pitch) {
                if (known <= 0.0) {
                    const double clearance = walls.clearance(centre(i, j));
                    inside = clearance > margin;
                    known = std::abs(clearance - margin);
                }
                metal_[index(i, j)] = inside ? 1 : 0;
            }
        }
    }

    void remove_disc(Vec2d at, double radius)
    {
        const double y = (at.y - corner_.y) / pitch_ - 0.5;
        const double r = radius / pitch_;
        const int j1 = std::min(rows_ - 1, static_cast<int>(std::floor(y + r)));
        for (int j = std::max(0, static_cast<int>(std::ceil(y - r))); j <= j1; ++j) {
            const double x = (at.x - corner_.x) / pitch_ - 0.5;
            const double half = std::sqrt(std::max(0.0, r * r - (j - y) * (j - y)));
            const int i0 = std::max(0, static_cast<int>(std::ceil(x - half)));
            const int i1 = std::min(columns_ - 1, static_cast<int>(std::floor(x + half)));
            if (i0 <= i1) {
                std::fill_n(metal_.begin() + static_cast<std::ptrdiff_t>(index(i0, j)), i1 - i0 + 1,
                            std::uint8_t{0});
            }
        }
    }

    void remove(const offset::Region2d& air)
    {
        const offset::EdgeTree edges{offset::edges_of(air)};
        for (int j = 0; j < rows_; ++j) {
            for (int i = 0; i < columns_; ++i) {
                if (metal_[index(i, j)] != 0 && edges.surrounds(centre(i, j))) {
                    metal_[index(i, j)] = 0;
                }
            }
        }
    }

    // True if the tool there, smaller by `depth` (mm), is in stock.
    bool meets_stock(Vec2d at, double depth) const
    {
        const double radius = radius_ - depth;
        const int n = static_cast<int>(radius / pitch_) + 1;
        for (int j = -n; j <= n; ++j) {
            for (int i = -n; i <= n; ++i) {
                const Vec2d d{i * pitch_, j * pitch_};
                if (dot(d, d) <= radius * radius && is_stock(at + d)) {
                    return true;
                }
            }
        }
        return false;
    }

    void cut(Vec2d at) { remove_disc(at, radius_); }

    double ahead() const { return 2.0 * pitch_; }

    // Degrees of the front half of the circle just outside of the tool that are in stock which the
    // tool meets within ahead() of travel: slivers along a wall just cut do not count.
    //
    // next, next_heading  the tool after that way
    double engagement(Vec2d at, Vec2d heading, Vec2d next, Vec2d next_heading) const
    {
        const double out = radius_ + 0.75 * pitch_;
        int count = 0;
        for (int k = -90; k <= 90; ++k) {
            const double angle = std::atan2(heading.y, heading.x) + k * 0.017453292519943295;
            const Vec2d u{std::cos(angle), std::sin(angle)};
            const Vec2d v = next_heading * dot(heading, u) +
                            Vec2d{-next_heading.y, next_heading.x} * cross(heading, u);
            count += is_stock(at + u * out) && is_stock(next + v * radius_) ? 1 : 0;
        }
        return count * 180.0 / 181.0;
    }

    // Calls visit(place) for each cell of stock.
    template <class Visit>
    void visit_stock(Visit visit) const
    {
        for (int j = 0; j < rows_; ++j) {
            for (int i = 0; i < columns_; ++i) {
                if (metal_[index(i, j)] != 0) {
                    visit(centre(i, j));
                }
            }
        }
    }

    double cell_area() const { return pitch_ * pitch_; }

private:
    bool is_stock(Vec2d p) const
    {
        const int i = static_cast<int>(std::floor((p.x - corner_.x) / pitch_));
        const int j = static_cast<int>(std::floor((p.y - corner_.y) / pitch_));
        return i >= 0 && j >= 0 && i < columns_ && j < rows_ && metal_[index(i, j)] != 0;
    }
    Vec2d centre(int i, int j) const { return corner_ + Vec2d{i + 0.5, j + 0.5} * pitch_; }
    std::size_t index(int i, int j) const
    {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(i);
    }

    double radius_;
    double pitch_;
    Vec2d corner_{};
    int columns_{};
    int rows_{};
    std::vector<std::uint8_t> metal_;
};

}  // namespace cusp::test
