// A pocket as its planners see it: what is asked, the tolerances of each step, the region in plan.
//
//     const Pocket pocket{job, operation};  // reads the operation once: its planners take the pocket
//     check_work(pocket);
#pragma once

#include <string>

#include "host_tools/geometry/drop_cutter/drop_cutter.hpp"
#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::contour_pocket {

// The share of the operation's tolerances for each step, mm.
struct ToleranceSplit {
    bool one_sided{};
    double fit{};               // of free-form curves by arcs
    double plan_tolerance{};    // of moves beside the plan path, to either side
    double height_tolerance{};  // of moves above the floor
    double scallop_height{};    // between passes
    double wall_clearance{};    // least distance of the outermost pass from the walls
    double accuracy{};          // of floor heights
};

// Errors: InputError for a value that is missing or out of range.
ToleranceSplit split_tolerances(const job::Job& job, const job::Operation& operation);

// The pocket in plan; free-form curves are fitted within `tolerance` (mm). Errors: InputError for
// crossing loops.
offset::Region2d make_region(const job::Operation& operation, double tolerance);

// Errors: those of split_tolerances() and make_region().
struct Pocket {
    const job::Job& job;
    const job::Operation& operation;
    ToleranceSplit tolerances = split_tolerances(job, operation);
    offset::Region2d region = make_region(operation, tolerances.fit);  // in plan
};

// The plan tolerance of an operation that roughs is shared between both steps.
struct RoughAndFinish {
    Pocket rough;
    Pocket finish;
};

// Without an allowance both follow the walls as near as the tolerance allows, roughing nearer: else
// finishing would cut slivers off them at full height.
RoughAndFinish split_between_rough_and_finish(const Pocket& pocket);

// Errors: InputError if the pocket is too deep, or needs too many passes, for the tool's size.
void check_work(const Pocket& pocket);

// Number of layers, at least one, of at most `max_depth` each over the whole depth (mm). Errors:
// InputError if there are too many.
int layer_count(const Pocket& pocket, double whole_depth, double max_depth);

// Errors: InputError if a point of the boundary or of an island has no floor. With several surfaces
// or trims inner points are checked too, every quarter of the tool's radius (coarser in pockets of
// more than 250 such cells a side).
void check_coverage(const job::Operation& operation,
                    const offset::Region2d& region,
                    const drop_cutter::DropCutter& floor);

[[noreturn]] void refuse_uncovered(const job::Operation& operation, Vec2d place);

// Warns of entries that had no room for a slope.
void report_plunges(int plunges, toolpath::OperationStats& stats);

// The operation's name at the start of messages.
std::string operation_text(const job::Job& job, const job::Operation& operation);

// That its tool has no place in the pocket.
std::string no_room_text(const job::Operation& operation);

// A number as written in messages and comments.
std::string number_text(double value);

}  // namespace cusp::contour_pocket
