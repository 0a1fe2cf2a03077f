// Rest machining: keeps of a planned path only the stretches that still meet stock after earlier
// programs.
//
//     SweptStock stock{job.stock_top};
//     take_away(earlier_path, stock);                       // or stock.add() for each move
//     keep_rest(stock, job, {{"a.ngc"}, rest_tolerance(operation)}, planned);
//     planned.stats.rest->removed_mm;                       // of feed moves; the rest is kept_mm
//
// Independent of strategies: a stretch whose tool, reduced by the tolerance all round, provably
// meets no stock is left out. A kept stretch begins and ends in air, a quarter of the tool's
// diameter before and after stock.
#pragma once

#include "host_tools/cam/rest_machining/swept_stock.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::rest_machining {

// Thinner stock is not cut again, mm.
struct RestTolerance {
    double surface;  // square to the surface; at least 0.001
    double wall;     // across the vertical side of a flat end; at least `surface`
};

// Surface: the operation's rest_tolerance; without one the smaller of its tolerances and of a
// twentieth of its scallop, at least 0.001. Wall: of a 2.5-D operation no less than its plan_tolerance.
RestTolerance rest_tolerance(const job::Operation& operation);

// Removes from the stock what the path's feed moves sweep. Arcs and curves count as chords within
// 0.0002 mm, swept by a tool that is smaller by as much.
void take_away(const toolpath::Toolpath& path, SweptStock& stock);

struct RestRequest {
    std::vector<std::string> programs;  // that left the stock, for comments and figures
    RestTolerance tolerance;
};

// Removes the stretches that cut no stock from the operation, and sets stats.rest. An operation that
// meets no stock at all ends up without moves. In a changed operation `retracts` is counted again and
// `scallop_bound_mm` grows by the tolerance.
void keep_rest(const SweptStock& stock,
               const job::Job& job,
               const RestRequest& request,
               toolpath::PlannedOperation& operation);

}  // namespace cusp::rest_machining
