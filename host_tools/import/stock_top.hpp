// The default of the stock's top: the highest point of the job's parts.
#pragma once

#include <optional>

#include "host_tools/job/job.hpp"

namespace cusp::import {

// z of the highest point of the surfaces that operations without a boundary cut, mm. No value where
// all have a boundary: a pocket's walls are higher than its floor.
std::optional<double> part_top(const job::Job& job);

// z of the stock's top in a job without stock.top, mm: the highest point of all floors, at least 0,
// rounded up to 1e-4.
double default_stock_top(const job::Job& job);

}  // namespace cusp::import
