// Limits the axial depth of cut of runs over the floor: where a run would cut deeper than
// max_depth, passes above it cut first.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/clearing/axial_depth_tracker.hpp"
#include "host_tools/grid_pocket/cl_path_fitter.hpp"
#include "host_tools/toolpath/toolpath_writer.hpp"

namespace cusp::grid_pocket {

class DepthLimiter {
public:
    // writer, path  that the runs are added to; outlive this
    // depth         of the path; the depth is tracked with and without a limit
    DepthLimiter(toolpath::ToolpathWriter& writer,
                 const toolpath::Toolpath& path,
                 clearing::AxialDepthTracker depth);

    // As enter_run(), but to the first level where stock is too deep over the start of the run.
    void enter(const ClPathFitter& floor,
               const std::vector<Vec2d>& corners,
               double stock_top,
               bool link,
               const toolpath::ToolpathWriter::HelixFloor& circle);

    // As ClPathFitter::follow(), with the tip at the first corner or over it.
    void follow(ClPathFitter& floor,
                const std::vector<Vec2d>& corners,
                const toolpath::ToolpathWriter::HelixFloor& circle);

    // Whether following the corners would cut too deep anywhere.
    bool too_deep(const ClPathFitter& floor, const std::vector<Vec2d>& corners);

    // Tracks all moves so far.
    void track_moves() { depth_.track(path_.moves); }

    // mm: deepest cut of the moves tracked so far.
    double deepest() const { return depth_.deepest(); }

    // Passes that were added.
    int added() const { return added_; }

private:
    struct Stretch {
        double begin;  // mm along a segment
        double end;
        double min_z;  // z of a tip that does not cut too deep there
        double low;    // the lowest that moves may be
    };

    toolpath::ToolpathWriter& writer_;
    const toolpath::Toolpath& path_;
    clearing::AxialDepthTracker depth_;
    double spacing_;  // mm between places of a run that are looked at
    int added_{0};

    bool is_limited() const { return depth_.max_depth().has_value(); }
    // Where a tip at the lowest over the floor would cut too deep.
    std::vector<Stretch> deep_stretches(const ClPathFitter& floor, Vec2d a, Vec2d b) const;
    void follow_segment(ClPathFitter& floor,
                        Vec2d a,
                        Vec2d b,
                        const toolpath::ToolpathWriter::HelixFloor& circle);
    void lower(ClPathFitter& floor,
               Vec2d a,
               Vec2d b,
               const toolpath::ToolpathWriter::HelixFloor& circle);
};

}  // namespace cusp::grid_pocket
