// Planned paths, before they are written: what of their feed moves is in air.
//
//     const std::vector<double> shares = air_shares(job, paths);  // of the first path's time at feed: shares[0]
#pragma once

#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::verify {

// The share of each path's time at feed, 0 to 1, in links and in moves that meet no stock which stood
// before the path: over it, beside it, in what earlier paths and earlier programs have cut. Where a path comes again to a
// place of its own it counts as cutting.
//
// Accuracy: the stock is a map of at most 400 000 heights; positions are 0.4 mm apart, or a fifth of the least radius.
std::vector<double> air_shares(const job::Job& job,
                               const std::vector<const toolpath::Toolpath*>& paths);

}  // namespace cusp::verify
