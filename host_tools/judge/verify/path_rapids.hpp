// Planned paths, before they are written: rapid moves against the stock that is left by then.
//
//     for (const RapidInStock& rapid : rapids_in_stock(job, paths)) { rapid.depth; }  // it would break a tool
#pragma once

#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/cut_stock.hpp"

namespace cusp::verify {

struct RapidInStock {
    std::size_t path;
    std::size_t move;  // of the path
    double depth;      // mm along the axis
    Vec3d tip;         // where it is that deep
    double end_depth;  // mm: stock over the tool at the end of the move
};

// The rapid moves that cut deeper than kRapidCutAllowed, in order. The paths are cut one after the other from the
// job's stock and what earlier programs leave of it. A move that is found counts as one that comes to its end from
// above, at feed: later ones are judged after that. It costs nothing where no rapid move is below the stock's top.
//
// paths  none is null; each starts with a rapid move over the stock
std::vector<RapidInStock> rapids_in_stock(const job::Job& job,
                                          const std::vector<const toolpath::Toolpath*>& paths);

}  // namespace cusp::verify
