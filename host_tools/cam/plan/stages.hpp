// The stages of a plan, in order.
#pragma once

#include "host_tools/cam/plan/planning.hpp"

namespace cusp::plan {

using Stage = void (*)(Planning&);

// Takes rates and accelerations of the job's machine for the times.
void take_machine(Planning& planning);
// Takes from the tolerances what the post's rounding adds, refuses words that the post lacks.
void fit_to_post(Planning& planning);
// Errors: InputError if the job's set-up has an offset for which the post has no field.
void check_offset(const job::Job& job);
// Reads the programs that were cut before.
void read_earlier_programs(Planning& planning);
// Plans each operation by its strategy.
void plan_operations(Planning& planning);
// The paths of job.operations[place], as the operation is by now.
std::vector<toolpath::PlannedOperation> plan_operation_at(Planning& planning, std::size_t place);
// Leaves in the paths what is still stock after earlier programs and earlier operations. Plans those with a scallop again.
void keep_rest(Planning& planning);
// Lifts links over clamps and vises, and adds the post's rounding to the bounds.
void finish_paths(Planning& planning);
// Groups by tool, shortens the ways between pockets.
void put_in_order(Planning& planning);
// Refuses chamfers and v-carvings that begin below stock which stands by then.
void prove_edges(Planning& planning);
// Ends rapid moves above the stock that they would meet: an operation that begins below such stock goes through it at
// the plunge feed, a pecking drill in pecks; rapid moves across it run at the clearance height. A warning of each
// operation says how deep. Refuses rapid moves that would cut stock all the same.
void prove_rapids(Planning& planning);
// Measures lengths and estimates times.
void measure_paths(Planning& planning);
// Refuses a program that is longer, wider or higher than the machine travels.
void prove_travel(Planning& planning);
// Refuses shanks and holders in stock.
void prove_reach(Planning& planning);
// Finds what of the feed moves is in air.
void find_air(Planning& planning);
// Warns of what may not be meant: air, overlaps, levels, tools that are too short.
void warn(Planning& planning);
// Warns of an operation that cuts the tabs of another.
void warn_of_cut_tabs(Planning& planning);
// Measures the engagement of the tools where the job bounds it, or feeds by it.
void find_engagement(Planning& planning);
// Writes the G-code, unless it is written.
void write_gcode(Planning& planning);
// Replaces estimated times by simulated ones, and parts them into cutting, air and rapid moves.
void put_times(Planning& planning);
// Sets the feeds of operations with chip_load by their engagement.
void put_feeds_by_load(Planning& planning);
// Adds what engagement and feeds were found to the statistics.
void count_engagement(Planning& planning);
// Warns of thin floors over cuts of the other side.
void warn_of_thin_floors(Planning& planning);

}  // namespace cusp::plan
