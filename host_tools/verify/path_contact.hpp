// Planned paths, before they are written: shank and holder against the stock that they leave.
#pragma once

#include <vector>

#include "host_tools/verify/machined_stock.hpp"
#include "host_tools/verify/tool_contact.hpp"

namespace cusp::verify {

struct PathContact {
    BodyPart part;
    double depth;  // mm along the axis, clearance included
    std::size_t path;
    Vec3d tip;
    toolpath::MoveKind move;
    double long_enough;  // mm: flutes, or the tool out of its holder
};

// The worst contact of each part of a tool on each path: by path, then by part. The paths are cut one
// after the other from the job's whole stock, on the grid and at the spacing of verify(). It takes its
// time too, but none where no tool goes as deep as its flutes or its length.
//
// paths  none is null; each starts with a rapid move
//
// Accuracy: as ContactTrace; verify() finds nothing in what this found nothing in, as its discs are
// smaller by kProgramSlack.
std::vector<PathContact> path_contacts(const job::Job& job,
                                       const std::vector<const toolpath::Toolpath*>& paths,
                                       const Progress& progress);

}  // namespace cusp::verify
