// What the stock takes from the parts where a job does not give it: their highest place, their box.
#pragma once

#include <optional>

#include "host_tools/import/part_extent.hpp"
#include "host_tools/job/job.hpp"

namespace cusp::import {

// z of the highest place of the surfaces that operations without a boundary cut, mm. None where
// all have a boundary: a pocket's walls rise over its floor.
std::optional<double> part_top(const job::Job& job);

// z that the stock's top has where the job gives none, mm, rounded up to 1e-4: the highest place
// of all floors, at least 0.
double default_stock_top(const job::Job& job);

// The box round all floors, mm; of a pocket no more in x and y than its boundary.
PartExtent extent_of_job(const job::Job& job);

}  // namespace cusp::import
