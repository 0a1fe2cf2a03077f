// Runs over the floor that are never cut deeper than max_depth: where one would be, passes above it
// take the metal first.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/clearing/stock_height_map.hpp"
#include "host_tools/grid_pocket/grid_toolpath_writer.hpp"

namespace cusp::grid_pocket {

class DepthLimiter {
public:
    // moves, path  that the runs are added to; outlive this
    // most         mm: no limit where there is none; the depth is tracked either way
    DepthLimiter(GridToolpathWriter& moves,
                 const toolpath::Toolpath& path,
                 const offset::Box2d& box,
                 double top,
                 std::optional<double> most);

    // As GridToolpathWriter::enter(), but to the first level where metal stands over the start of
    // the run.
    void enter(const ClPathFitter& floor,
               const std::vector<Vec2d>& corners,
               double stock_top,
               bool link,
               const GridToolpathWriter::CircleFloor& circle);

    // As ClPathFitter::follow(), from where the tip stands at the first corner or over it.
    void follow(ClPathFitter& floor,
                const std::vector<Vec2d>& corners,
                const GridToolpathWriter::CircleFloor& circle);

    // Whether following the corners would cut too deep anywhere.
    bool too_deep(const ClPathFitter& floor, const std::vector<Vec2d>& corners);

    // Brings the metal up to date with all moves so far.
    void track_moves();

    // mm: deepest cut of the moves tracked so far.
    double deepest() const { return deepest_; }

    // Passes that were added.
    int added() const { return added_; }

private:
    struct Stretch {
        double begin;  // mm along a segment
        double end;
        double min_z;  // z of a tip that does not cut too deep there
        double low;    // the lowest that moves may be
    };

    GridToolpathWriter& moves_;
    const toolpath::Toolpath& path_;
    std::optional<double> max_depth_;
    clearing::StockHeightMap stock_;
    double spacing_;                // mm between places of a run that are looked at
    std::size_t tracked_moves_{0};  // moves that the metal knows of
    Vec3d at_{};                    // where they end
    double deepest_{0};
    int added_{0};

    // Where a tip at the lowest over the floor would cut too deep.
    std::vector<Stretch> deep_stretches(const ClPathFitter& floor, Vec2d a, Vec2d b) const;
    void follow_segment(ClPathFitter& floor,
                        Vec2d a,
                        Vec2d b,
                        const GridToolpathWriter::CircleFloor& circle);
    void lower(ClPathFitter& floor,
               Vec2d a,
               Vec2d b,
               const GridToolpathWriter::CircleFloor& circle);
};

}  // namespace cusp::grid_pocket
