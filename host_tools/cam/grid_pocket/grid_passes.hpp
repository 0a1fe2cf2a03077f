// The passes of the pocket and the moves between them: layers, main path, wall, zigzags.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host_tools/cam/grid_pocket/adaptive_layers.hpp"
#include "host_tools/cam/grid_pocket/depth_limiter.hpp"
#include "host_tools/cam/grid_pocket/pocket_space.hpp"

namespace cusp::grid_pocket {

class GridPasses {
public:
    // pocket, path  must outlive this; `pocket.rough_heights` are needed for layers only
    GridPasses(PocketSpace& pocket, toolpath::Toolpath& path);

    // One roughing layer: the navigation over the cells that the floor leaves free, then the wall.
    void layer(double plane);

    // One layer of bounded engagement: its passes, then the cells that they do not reach, then the
    // wall.
    void adaptive_layer(const AdaptiveLayers& layers, const AdaptiveLayer& layer);

    // Pass P of the paper: the whole navigation over the floor.
    void main_path(const Navigation& navigation);

    // Pass W: along boundary and islands.
    void wall();

    // Pass N: over the steps along 'x' or 'y' that are not yet tracks; adds them to the tracks.
    void zigzag(char axis, Tracks& tracks);

    void finish();
    std::size_t main_moves() const { return main_moves_; }
    int backtracks() const { return backtracks_; }
    int dead_ends() const { return dead_ends_; }
    int lifts() const { return lifts_; }
    int passes() const { return passes_; }
    int steps() const { return steps_; }
    int adaptive_entries() const { return adaptive_entries_; }
    int retracts() const { return writer_.retracts(); }
    const toolpath::ToolpathWriter& writer() const { return writer_; }
    // mm; none if everything is cut in one layer.
    std::optional<double> deepest_cut() const
    {
        return depth_ ? std::optional<double>{depth_->deepest()} : std::nullopt;
    }
    // Number of passes added to keep runs within max_depth.
    int depth_passes() const { return depth_ ? depth_->added() : 0; }

private:
    PocketSpace& pocket_;
    toolpath::Toolpath& path_;
    toolpath::ToolpathWriter writer_;
    std::optional<DepthLimiter> depth_;  // for pockets with layers
    std::vector<float> stock_tops_;      // z of the stock over each cell
    std::optional<double> last_plane_;   // of the layers so far
    std::size_t main_moves_{0};
    int backtracks_{0};
    int dead_ends_{0};
    int lifts_{0};
    int passes_{0};
    int steps_{0};
    int adaptive_entries_{0};

    double stock_top_at(Cell c) const
    {
        return static_cast<double>(stock_tops_[pocket_.grid.index(c)]);
    }
    // z at which a descending tool may first touch stock at a place.
    double stock_top_under(Vec2d at) const;
    // Cuts the free cells as low as plane and floor allow.
    void cut_cells(double plane, const std::function<bool(Cell)>& free, ClPathFitter& floor);
    void count(const Navigation& navigation);
    // True if the steps before and after `i` have the same direction, one cell each.
    static bool straight(const Navigation& navigation, std::size_t i);
    // Returns the number of moves that cut.
    std::size_t follow_navigation(const Navigation& navigation, ClPathFitter& floor);
    void follow(ClPathFitter& floor, const std::vector<Vec2d>& corners);
    void enter(ClPathFitter& floor, const std::vector<Vec2d>& corners, double stock_top, bool link);
    void begin_run(const std::vector<Vec2d>& corners, double stock_top, ClPathFitter& floor);
    // True if a straight link at the height of the layer above reaches the place. That layer has
    // cut all that the floor leaves free, except for scallops between tracks.
    bool can_link(Vec2d to) const;
    // True if the layer above has visited every cell below the move.
    bool cut_along(Vec3d from, Vec3d to) const;
    // The pass along the wall, from its nearest point on.
    offset::Contour wall_loop(const offset::Contour& contour) const;
    // Points along an edge of such a loop, after its start.
    void append_points(const offset::Edge& edge, std::vector<Vec2d>& corners) const;
    std::vector<Vec2d> wall_corners(const offset::Contour& loop) const;
    bool follow_arc(ClPathFitter& floor, const offset::Edge& arc);
    Vec2d here() const;
    // For helices over what `floor` leaves.
    toolpath::ToolpathWriter::HelixFloor circle_over(const ClPathFitter& floor) const;
    // To the first corner: along the floor if nothing is in between, else by an entry at a cell
    // beside it that the main path has cut.
    void approach(const std::vector<Vec2d>& corners);
    // Along the wall where its roughing floor is below `above`.
    void wall_level(double above, ClPathFitter& floor);
    void cut_level(std::vector<Vec2d>& run, double above, ClPathFitter& floor);
    double height_or(Vec2d at) const;
};

}  // namespace cusp::grid_pocket
