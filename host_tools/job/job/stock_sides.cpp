// Outlines are looked at as polylines.
#include "host_tools/job/job/stock_sides.hpp"

#include <algorithm>

#include "host_tools/job/job/loop_shape.hpp"

namespace cusp::job {

StockSides stock_sides(const Job& job)
{
    StockSides sides;
    if (job.stock_x) {
        sides.x_low = (*job.stock_x)[0];
        sides.x_high = (*job.stock_x)[1];
    }
    if (job.stock_y) {
        sides.y_low = (*job.stock_y)[0];
        sides.y_high = (*job.stock_y)[1];
    }
    return sides;
}

bool is_open_pocket(const Job& job, const Operation& operation)
{
    constexpr double kChord = 1e-4;  // mm
    const bool pocket = operation.strategy->traits.pocket;
    if (!pocket || !operation.passes.max_engagement || !operation.outline.boundary) {
        return false;
    }
    const StockSides sides = stock_sides(job);
    const std::vector<Vec2d> outline = loop_polyline(*operation.outline.boundary, kChord);
    return std::any_of(outline.begin(), outline.end(), [&](Vec2d p) {
        return std::min({p.x - sides.x_low, sides.x_high - p.x, p.y - sides.y_low,
                         sides.y_high - p.y}) <= kOnEdge;
    });
}

}  // namespace cusp::job
