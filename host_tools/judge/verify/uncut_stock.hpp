// The stock before any cut.
//
//     const UncutStock uncut{job};
//     MachinedStock stock = uncut.on(grid);     // all of the grid, or what lies in its outline
#pragma once

#include <vector>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/machined_stock.hpp"
#include "host_tools/judge/verify/wall_distance.hpp"

namespace cusp::verify {

class UncutStock {
public:
    explicit UncutStock(const job::Job& job);

    // Up to the job's stock top; where the stock has an outline, its points alone (within 1e-4 mm).
    MachinedStock on(const HeightGrid& grid) const;

private:
    double top_;
    std::vector<WallDistance> edges_;  // the outline, then its holes
};

}  // namespace cusp::verify
