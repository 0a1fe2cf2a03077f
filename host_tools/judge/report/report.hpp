// Pictures (SVG) in plan of a program's path and of the stock it leaves. The front door of
// `report`; part_picture.hpp draws a part alone.
//
//     const verify::Verification result = verify::verify(job, "part.ngc", {}, progress);
//     files::write_text("path.svg", path_picture(job, result.program));  // a panel for each tool
//     files::write_text("engagement.svg", engagement_picture(job, result));  // where asked for
//     files::write_text("left.svg", left_picture(job, result));          // black: nothing was cut
//
// Each picture has a ruler in mm and a scale of colours. Equal input gives equal bytes.
#pragma once

#include <string>

#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/verify.hpp"

namespace cusp::report {

// The path with the walls of the part: cuts coloured by height, rapid moves dashed.
std::string path_picture(const job::Job& job, const verify::Program& program);

// The stock left above the floor: a colour map with its scale; black where nothing was cut.
std::string left_picture(const job::Job& job, const verify::Verification& result);

// The feed moves coloured by engagement, 0 to 180 degrees: each half millimetre has the colour of
// its greatest. Over the limit with red edges, air thin and grey, entries dashed.
//
// result  with its engagement
std::string engagement_picture(const job::Job& job, const verify::Verification& result);

}  // namespace cusp::report
