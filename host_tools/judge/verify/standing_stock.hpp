// The stock before a program is cut, as points of the grid know it.
#pragma once

#include <vector>

#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/judge/verify/height_grid.hpp"

namespace cusp::verify {

class StandingStock {
public:
    // heights  of the grid's points; kNoValue or -kUnbounded where there is no stock
    StandingStock(HeightGrid grid, std::vector<double> heights)
        : grid_{grid}, heights_{std::move(heights)}
    {
    }

    // z at a point of the grid; kNoValue or -kUnbounded where there is no stock.
    double height(std::size_t k) const { return heights_[k]; }

    // True where all points of the grid within a pitch of a place are higher than z: there is no doubt. On the
    // stock's own edge it is never true.
    bool is_over(Vec2d place, double z) const
    {
        return is_on_grid(place) &&
               !any_near(place, grid_.pitch, [&](std::size_t k) { return !(heights_[k] > z); });
    }

    // True where some point of the grid beside a place is higher than z.
    bool may_be_over(Vec2d place, double z) const
    {
        return is_on_grid(place) &&
               any_near(place, 0, [&](std::size_t k) { return heights_[k] > z; });
    }

    // True if is(k) holds for some point of the grid within `reach` mm in x and in y, and the ones around these.
    template <class Is>
    bool any_near(Vec2d place, double reach, const Is& is) const
    {
        for (std::size_t i = grid_.first_column(place.x - reach);
             i < grid_.end_column(place.x + reach); ++i) {
            for (std::size_t j = grid_.first_row(place.y - reach);
                 j < grid_.end_row(place.y + reach); ++j) {
                if (is(grid_.index(i, j))) {
                    return true;
                }
            }
        }
        return false;
    }

private:
    bool is_on_grid(Vec2d place) const
    {
        const double x_end = grid_.x0 + static_cast<double>(grid_.nx - 1) * grid_.pitch;
        const double y_end = grid_.y0 + static_cast<double>(grid_.ny - 1) * grid_.pitch;
        return place.x >= grid_.x0 && place.x <= x_end && place.y >= grid_.y0 && place.y <= y_end;
    }

    HeightGrid grid_;
    std::vector<double> heights_;
};

}  // namespace cusp::verify
