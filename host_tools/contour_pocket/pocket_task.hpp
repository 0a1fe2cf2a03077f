// A pocket's operation, checked: its tolerances split, its region in plan, its floor.
#pragma once

#include <string>

#include "host_tools/drop_cutter/drop_cutter.hpp"
#include "host_tools/job/job.hpp"
#include "host_tools/offset/contour.hpp"

namespace cusp::contour_pocket {

// The part of the operation's tolerances that each step has, mm.
struct ToleranceSplit {
    bool one_sided{};
    double fit{};               // of free curves by arcs
    double plan_tolerance{};    // of moves beside the plan path, either way
    double height_tolerance{};  // of moves over the floor
    double scallop_height{};    // height between passes
    double wall_clearance{};    // distance of the outermost pass from the walls
    double accuracy{};          // of floor heights
};

// Throws InputError where a value is missing or out of range.
ToleranceSplit split_tolerances(const job::Job& job, const job::Operation& operation);

// Of an operation that roughs: the two split the tolerance in plan.
struct RoughAndFinish {
    ToleranceSplit rough;
    ToleranceSplit finish;
};

// Without an allowance both follow the walls as near as the tolerance allows. Roughing has the part
// nearer to the walls: else finishing would cut slivers off them at their full height.
RoughAndFinish split_between_rough_and_finish(const job::Operation& operation,
                                              const ToleranceSplit& tolerances);

// The pocket seen from above; free curves within `tolerance` (mm). Throws InputError where loops
// cross.
offset::Region2d make_region(const job::Operation& operation, double tolerance);

// Throws InputError where the pocket is deeper or needs more passes than makes sense for the tool.
void check_work(const job::Job& job,
                const job::Operation& operation,
                const offset::Region2d& region,
                const ToleranceSplit& tolerances);

// How many layers no deeper than `of` a depth makes, mm, at least one. Throws InputError where they
// are too many.
int layer_count(const job::Job& job, const job::Operation& operation, double deep, double of);

// Throws InputError where a place of the boundary or of an island has no floor; where there are
// several surfaces or trims, a place inside, too: sampled every quarter of the tool's radius
// (coarser in pockets of more than 250 such places a side).
void check_coverage(const job::Operation& operation,
                    const offset::Region2d& region,
                    const drop_cutter::DropCutter& floor);

[[noreturn]] void refuse_uncovered(const job::Operation& operation, Vec2d place);

// Warns of entries that had no room for a slope.
void report_plunges(int plunges, toolpath::OperationStats& stats);

// The operation as messages name it, up to the word that says what is wrong.
std::string operation_text(const job::Job& job, const job::Operation& operation);

// A number as messages and comments show it.
std::string number_text(double value);

}  // namespace cusp::contour_pocket
