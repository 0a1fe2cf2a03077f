// Checks the request of a one-line job.
#pragma once

#include <vector>

#include "host_tools/job/import/one_line_job.hpp"
#include "host_tools/job/import/tool_text.hpp"

namespace cusp::import {

// Errors: InputError that names the option or the file, its value, its limit and what to do.
void check_request(const OneLineRequest& request, const job::Strategies& strategies);

// As check_request(), where the parts are drawings.
void check_sheet_request(const OneLineRequest& request);

// As check_request(), where nothing needs a ball and so no scallop.
void check_solid_request(const OneLineRequest& request);

// The one that is asked for; else that of a pocket where there is a boundary, or of a finish.
// Throws InputError where there is none of the name.
const job::Strategy& strategy_of(const OneLineRequest& request, const job::Strategies& strategies);

// Throws InputError where a tool is none for parts, or is wider than the part of `part` mm or inches.
void check_shapes(const OneLineRequest& request,
                  const std::vector<NamedTool>& tools,
                  const Vec2d& part);

// Throws InputError where the last tool can't finish the part as requested.
void check_tools(const OneLineRequest& request, const std::vector<NamedTool>& tools);

// True if files of this ending hold parts (kPartEndings).
bool is_part_file(const std::string& file);

}  // namespace cusp::import
