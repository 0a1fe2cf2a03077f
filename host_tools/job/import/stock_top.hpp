// Defaults of the stock from the job's parts: their highest point, their box.
#pragma once

#include <optional>

#include "host_tools/job/import/part_extent.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::import {

// z of the highest point of the surfaces that operations without a boundary cut, mm. No value where
// all have a boundary: a pocket's walls are higher than its floor.
std::optional<double> part_top(const job::Job& job);

// z of the stock's top in a job without stock.top, mm: the highest point of all floors, at least 0,
// rounded up to 1e-4.
double default_stock_top(const job::Job& job);

// The box round all floors, mm; no value: all operations are 2.5-D.
std::optional<PartExtent> floors_extent(const job::Job& job);

// The box in x and y round what operations are drawn by, or else their floors; z means nothing. No
// value: there is neither.
std::optional<PartExtent> plan_extent(const job::Job& job);

}  // namespace cusp::import
