// What a pocket asks for, checked: tolerances shared out, the region in plan, the floor.
#pragma once

#include <string>

#include "host_tools/clearing/tip_floor.hpp"
#include "host_tools/import/job.hpp"
#include "host_tools/offset/contour.hpp"

namespace cusp::host {

// What the tolerances of the operation leave to each step, mm.
struct Budget {
    bool outside{};
    double fit{};       // of free curves by arcs
    double aside{};     // of moves beside the plan path, either way
    double above{};     // of moves over the floor
    double cusp{};      // height between passes
    double first{};     // distance of the outermost pass from the walls
    double accuracy{};  // of floor heights
};

// Throws InputError where a value is missing or out of range.
Budget make_budget(const Job& job, const Operation& operation);

// Of an operation that roughs: the two share out how far moves may be beside the plan path.
struct RoughAndFinish {
    Budget rough;
    Budget finish;
};

// Without an allowance both follow the walls as far as the tolerance lets them. The roughing takes
// the near part of that: else the finish would take slivers off the walls at their full height.
RoughAndFinish share_out(const Operation& operation, const Budget& budget);

// The pocket seen from above; free curves within `tolerance` (mm). Throws InputError where loops
// cross.
Region2d make_region(const Operation& operation, double tolerance);

// Throws InputError where the pocket is deeper or needs more passes than makes sense for the tool.
void check_work(const Job& job,
                const Operation& operation,
                const Region2d& region,
                const Budget& budget);

// How many layers no deeper than `of` a depth makes, mm, at least one. Throws InputError where they
// are too many.
int layer_count(const Job& job, const Operation& operation, double deep, double of);

// Throws InputError where a place of the boundary or of an island has no floor; where there are
// several surfaces or trims, a place inside, too: looked at every quarter of the tool's radius
// (coarser in pockets of more than 250 such places a side).
void check_coverage(const Operation& operation, const Region2d& region, const TipFloor& floor);

[[noreturn]] void refuse_uncovered(const Operation& operation, Vec2d place);

// Warns of entries that had no room for a slope.
void report_plunges(int plunges, OperationStats& stats);

// The operation as messages name it, up to the word that says what is wrong.
std::string operation_text(const Job& job, const Operation& operation);

// A number as messages and comments show it.
std::string number_text(double value);

}  // namespace cusp::host
