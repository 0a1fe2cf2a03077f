// Paths of a tool along open lines of a drawing, on them or beside them, and the cut along them level by level.
//
//     const std::vector<offset::Edge> line = edges_along(chain);
//     std::vector<LineCut> cuts;
//     for (std::vector<offset::Edge>& path : beside_line(line, 3.0, true)) { cuts.push_back({{path}}); }
//     return {cut_lines(job, operation, "left of 1 line", cuts)};
#pragma once

#include <string>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::prismatic {

// The chain's curves as lines and arcs, within kFit.
std::vector<offset::Edge> edges_along(const job::Chain& chain);

// From its end to its start.
std::vector<offset::Edge> turned_around(std::vector<offset::Edge> edges);

// True if it ends where it starts.
bool is_closed(const std::vector<offset::Edge>& edges);

// The contours at a distance `away` (mm, > 0) from a line, on both sides of it; the line is on their right.
std::vector<offset::Contour> around_line(const std::vector<offset::Edge>& line, double away);

// The parts of them that lie on the left of a line, or on its right, up to its ends.
std::vector<std::vector<offset::Edge>> beside_line(const std::vector<offset::Edge>& line,
                                                   double away,
                                                   bool left);

// Paths that are cut one after the other at each level, without a lift: each begins in what those before have cut.
// Paths after the first are closed, with their waste on the left for a climb cut, else on the right.
struct LineCut {
    std::vector<std::vector<offset::Edge>> paths;
    // The first has a wall beside it, and runs like those after it. Else it may begin at either end.
    bool has_wall{};
};

// Cuts them in a short tour, level by level; an open path there and back. A ramp along the first path goes down.
toolpath::PlannedOperation cut_lines(const job::Job& job,
                                     const job::Operation& operation,
                                     const std::string& comment,
                                     std::vector<LineCut> cuts);

}  // namespace cusp::prismatic
