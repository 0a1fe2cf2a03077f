// Pockets that reach the stock's edge: the ground beside the stock belongs to where the tool may be.
//
//     if (const auto open = open_sides(job, operation, pocket, wall_clearance)) {
//         open->region;    // of the tool's body: the pocket in the stock, and air in front of it
//         open->starts;    // of the tool's centre: passes come in from there
//     }
#pragma once

#include <optional>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::contour_pocket {

struct OpenSides {
    offset::Region2d region;    // where the tool's body may be
    offset::Region2d in_stock;  // what of the pocket lies in the stock
    offset::Region2d air;       // what of the region lies beside it
    offset::Region2d starts;    // of the tool's centre: there it meets neither stock nor walls
};

// wall_clearance  mm: least distance of the tool's centre from walls
//
// None where the pocket is closed, or lies beside the stock as a whole. The air reaches 3.7 wall
// clearances around each stretch of the stock's edge that the pocket has; elsewhere beside the
// stock the tool does not go.
std::optional<OpenSides> open_sides(const job::Job& job,
                                    const job::Operation& operation,
                                    const offset::Region2d& pocket,
                                    double wall_clearance);

// True if all of the pocket lies beside the stock.
bool lies_beside_stock(const job::Job& job, const offset::Region2d& pocket);

}  // namespace cusp::contour_pocket
