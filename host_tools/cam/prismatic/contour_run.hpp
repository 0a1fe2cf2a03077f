// A plan path addressed by arc length: its parts, and the moves along them at a height.
//
//     const ContourRun run{contour};                 // closed where its ends meet
//     run.part(10.0, 25.0);                          // edges from 10 to 25 mm
//     run.turned(3.0);                               // the same contour from 3 mm on
//     write_edges(run.part(0, run.length()), -2, -2, form, writer);
#pragma once

#include <vector>

#include "host_tools/geometry/offset/contour.hpp"
#include "host_tools/geometry/toolpath/toolpath_writer.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::prismatic {

class ContourRun {
public:
    explicit ContourRun(std::vector<offset::Edge> edges);

    double length() const { return ends_.empty() ? 0.0 : ends_.back(); }  // mm
    const std::vector<offset::Edge>& edges() const { return edges_; }
    // mm from the start to where an edge begins.
    double begin_of(std::size_t edge) const { return edge == 0 ? 0.0 : ends_[edge - 1]; }

    // 0 <= at <= length().
    Vec2d point(double at) const;
    // mm from the start to the place nearest to `p`.
    double nearest_to(Vec2d p) const;

    // The edges from one length to another. Precondition: 0 <= from <= to <= length().
    std::vector<offset::Edge> part(double from, double to) const;

    // A closed contour with its start moved to `at`.
    ContourRun turned(double start) const;

private:
    std::vector<offset::Edge> edges_;
    std::vector<double> ends_;
};

// The rules by which edges become moves.
struct EdgeForm {
    bool arcs{true};           // else lines
    double tolerance{};        // mm: of lines in place of arcs
    bool waste_on_left{true};  // on which side lines may stray from an arc
    bool exact{};              // no side: chords of arcs
};

// Points that follow the edges, without the first one: of an arc, chords on its waste side within
// the tolerance; ends are exact.
std::vector<Vec2d> points_along(const std::vector<offset::Edge>& edges, const EdgeForm& form);

// The edges at the height of the start, as a slope follows them: arcs where the form has them.
toolpath::EntryRun run_along(const std::vector<offset::Edge>& edges,
                             Vec3d start,
                             const EdgeForm& form);

// Moves along the edges, from where the tool is; the height changes evenly from z0 to z1. A descent
// is a plunging cut.
void write_edges(const std::vector<offset::Edge>& edges,
                 double z0,
                 double z1,
                 const EdgeForm& form,
                 toolpath::ToolpathWriter& writer);

}  // namespace cusp::prismatic
