// Copies of drawings on a sheet (geometry/nesting), for a call without a job.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/import/one_line_choice.hpp"
#include "host_tools/job/import/placing.hpp"
#include "host_tools/job/import/sheet_drawing.hpp"

namespace cusp::import {

// Drawings that keep their places to each other, and all places of them.
struct NestedFiles {
    std::vector<std::string> files;
    std::vector<CopyPlace> places;
};

// True if the request lays its drawings on a sheet.
bool asks_for_sheet(const OneLineRequest& request);

// The places of the copies that the request asks for. The gap is 1.5 times the diameter of the first tool, which cuts
// outlines, if the request has none.
//
// drawings  as sheet_drawings() gives them for the request: all that is cut lies in these
//
// Errors: InputError with the option: no sheet, counts that are not those of the drawings, and how many copies there is room
// for.
std::vector<NestedFiles> nest_copies(const OneLineRequest& request,
                                     const OneLineChoice& choice,
                                     const std::vector<SheetDrawing>& drawings);

// In words: how many, how far apart, and how much of the sheet is used.
std::string said_of_copies(const OneLineRequest& request,
                           const OneLineChoice& choice,
                           const std::vector<NestedFiles>& nested);

// mm: from copy to copy, and to the sheet's edges.
double gap_of_copies(const OneLineRequest& request, const OneLineChoice& choice);

}  // namespace cusp::import
