// Limits the axial depth of cut of runs over the floor: where a run would cut deeper than
// max_depth, passes above it are added first.
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "host_tools/cam/clearing/axial_depth_tracker.hpp"
#include "host_tools/cam/grid_pocket/cl_path_fitter.hpp"
#include "host_tools/geometry/toolpath/toolpath_writer.hpp"

namespace cusp::grid_pocket {

class DepthLimiter {
public:
    // writer, path  that runs are added to; must outlive this
    // depth         of the path; tracked with and without a limit
    DepthLimiter(toolpath::ToolpathWriter& writer,
                 const toolpath::Toolpath& path,
                 clearing::AxialDepthTracker depth);

    // As enter_run(), but to the first level where stock above the start of the run is too deep.
    void enter(const ClPathFitter& floor,
               const std::vector<Vec2d>& corners,
               double stock_top,
               bool link,
               const toolpath::ToolpathWriter::HelixFloor& circle);

    // As ClPathFitter::follow(), with the tip at or above the first corner.
    void follow(ClPathFitter& floor,
                const std::vector<Vec2d>& corners,
                const toolpath::ToolpathWriter::HelixFloor& circle);

    // True if following the corners would cut too deep anywhere.
    bool too_deep(const ClPathFitter& floor, const std::vector<Vec2d>& corners);

    // Tracks the depth of all moves so far.
    void track_moves() { depth_.track(path_.moves); }

    // mm: deepest cut of the tracked moves.
    double deepest() const { return depth_.deepest(); }

    // Number of passes added.
    int added() const { return added_; }

private:
    struct Stretch {
        double begin;  // mm along a segment
        double end;
        double min_z;  // z of a tip that does not cut too deep there
        double low;    // lower limit of moves
    };

    // Evenly spaced from a to b.
    struct SampleRow {
        Vec2d a;
        Vec2d b;
        int count;  // of steps
        Vec2d place(int i) const
        {
            return a + (b - a) * (static_cast<double>(std::min(i, count)) / count);
        }
    };
    struct Sample {
        int number;
        double least;  // z: a level below is not too deep
        double level;  // z of a tip that does not cut too deep there
    };

    toolpath::ToolpathWriter& writer_;
    const toolpath::Toolpath& path_;
    clearing::AxialDepthTracker depth_;
    double spacing_;  // mm between samples of a run
    int added_{0};

    bool is_limited() const { return depth_.max_depth().has_value(); }
    std::vector<Sample> deep_samples(const ClPathFitter& floor, const SampleRow& row) const;
    // Places at which a tip at the lowest height over the floor would cut too deep.
    std::vector<Stretch> deep_stretches(const ClPathFitter& floor, Vec2d a, Vec2d b) const;
    double level_at_foot(const ClPathFitter& floor, Vec2d at, double low, Vec2d higher) const;
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
