// Jobs of one-line calls with drawings: `cusp plan plate.dxf --tool flat:3 --depth 6`.
#pragma once

#include "host_tools/job/import/one_line_job.hpp"

namespace cusp::import {

// True if the file, which "#layer" may follow, is a drawing.
bool is_drawing_name(const std::string& name);

// True if the parts are drawings, all of them.
bool is_sheet_request(const OneLineRequest& request);

// Layers that an option names are made what it says; those whose names have words for pockets, holes, engraving
// or dimensions likewise. In all other layers together an outline is cut outside, a loop within it inside, a
// circle that fits a drill is drilled, an open line is engraved. Outlines come last. Several drawings are one
// job: an outline of one that lies in an outline of another is a hole.
//
// Errors: InputError that names the option, or file, layer and place.
OneLineJob sheet_job(const OneLineRequest& request,
                     const job::Strategies& strategies,
                     PartFiles& parts);

}  // namespace cusp::import
