// Planned paths, before they are written: shank and holder against the stock that they leave.
#pragma once

#include <vector>

#include "host_tools/judge/verify/machined_stock.hpp"
#include "host_tools/judge/verify/tool_contact.hpp"

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
// after the other from the job's whole stock, on the grid and at the spacing of verify(). It costs
// as much as verify(), and nothing where no tool goes as deep as its flutes or its length.
//
// paths  none is null; each starts with a rapid move
//
// Accuracy: as ContactTrace. verify() finds no contact in a program that has none here, since its
// discs are smaller by kProgramSlack.
std::vector<PathContact> path_contacts(const job::Job& job,
                                       const std::vector<const toolpath::Toolpath*>& paths,
                                       const Progress& progress);

}  // namespace cusp::verify
