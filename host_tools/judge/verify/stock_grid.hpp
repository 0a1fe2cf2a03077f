// Resolution of a job's stock: the grid of its heights and the positions of its tools.
#pragma once

#include <optional>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/height_grid.hpp"
#include "host_tools/judge/verify/part_heights.hpp"

namespace cusp::verify {

// The box over the parts, what 2.5-D operations cut, and the stock's extent; over the stock alone in a job
// with an open pocket, or where it has an outline.
//
// parts  the box of all floors
PartBox stock_box(const job::Job& job, PartBox parts);

// Over the stock's box.
//
// parts  the box of all floors
// pitch  mm; without it 0.173, at most a sixteenth of the least radius of a tool. It is more where
//        the grid would have over `most` points
HeightGrid stock_grid(const job::Job& job,
                      PartBox parts,
                      std::optional<double> pitch,
                      double most = 4e6);

// mm between positions of a tool: 0.1, and at most a twentieth of the least radius.
double position_spacing(const job::Job& job);

}  // namespace cusp::verify
