// By the signed distance of each point from the loops.
#include "host_tools/judge/verify/uncut_stock.hpp"

#include <algorithm>

#include "host_tools/judge/verify/bands.hpp"

namespace cusp::verify {

UncutStock::UncutStock(const job::Job& job) : top_{job.stock_top}
{
    constexpr double kCap = 1.0;  // mm: the sign alone is looked at
    for (const job::Loop& loop : job.stock_outline) {
        edges_.emplace_back(loop, edges_.empty(), kCap);
    }
}

MachinedStock UncutStock::on(const HeightGrid& grid) const
{
    MachinedStock stock{grid, top_};
    if (edges_.empty()) {
        return stock;
    }
    for_each_band(grid.nx, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t k = begin * grid.ny; k < end * grid.ny; ++k) {
            const double x = grid.x(k / grid.ny, k % grid.ny);
            const double y = grid.y(k / grid.ny, k % grid.ny);
            if (std::any_of(edges_.begin(), edges_.end(),
                            [&](const WallDistance& edge) { return edge.at(x, y) < 0; })) {
                stock.clear(k);
            }
        }
    });
    return stock;
}

}  // namespace cusp::verify
