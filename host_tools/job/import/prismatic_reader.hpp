// The keys of 2.5-D operations: pocket, profile, drill, face, engrave, v_carve, chamfer.
#pragma once

#include <string>

#include "host_tools/job/import/drawing_choice.hpp"
#include "host_tools/job/import/job_table.hpp"
#include "host_tools/job/import/part_files.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/job/job/strategy.hpp"

namespace cusp::import {

// Reads the keys; the operation has `prismatic` afterwards where its strategy is one of them.
//
// Errors: InputError with the line: values out of range, keys that the strategy needs and lacks.
void read_prismatic_keys(JobTable& table, const job::Strategy& strategy, job::Operation& operation);

// Reads the drawing, `prismatic->file`, that a profile, drill, face, engrave, v_carve or chamfer takes its curves from.
//
// choice  which of its shapes
//
// Errors: InputError: no such layer, open loops, no hole of the wanted diameter, a hole narrower
// than the tool.
void read_drawing(JobTable& table,
                  const DrawingChoice& choice,
                  PartFiles& parts,
                  job::Operation& operation);

// Gives the loops of a pocket or a profile reliefs at their inner corners, where the job asks for them.
//
// Errors: InputError on a profile on the line.
void read_reliefs(JobTable& table, PartFiles& parts, job::Operation& operation);

// When the stock's sides are known: refuses a profile beside the part in a job whose stock, for an operation
// on a floor without a boundary, would be the part's box.
//
// Errors: InputError.
void check_sheet(const job::Job& job);

// When the stock's top is known: the level at which each operation begins, its own `top` or what
// the last face left, and the flat floors of pockets.
//
// Errors: InputError where tabs are no lower than the cut is deep.
void settle_levels(job::Job& job);

}  // namespace cusp::import
