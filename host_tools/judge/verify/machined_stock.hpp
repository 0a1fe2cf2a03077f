// Material removal: the stock as a height map, and the cut of each position of a tool.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "host_tools/geometry/toolpath/toolpath.hpp"
#include "host_tools/judge/verify/height_grid.hpp"
#include "host_tools/judge/verify/tool_positions.hpp"

namespace cusp::verify {

class ContactTrace;
class EngagementTrace;
class FlatSweep;

// mm: rapid moves may cut as deep as slivers and rounding.
inline constexpr double kRapidCutAllowed = 0.005;

// A rapid move that cuts deeper than allowed.
struct DeepRapid {
    std::size_t end;       // its last position
    std::size_t position;  // the first where it is deepest
    double depth;          // mm, there
    double end_depth;      // mm, at its last position
};

struct CutFigures {
    double rapid_cut{};                    // mm: deepest cut of a rapid move, along the whole move
    std::vector<DeepRapid> deep_rapids{};  // in the order of the path
    double cut_depth{};                    // mm: deepest cut of a feed move, at one position

    // The deepest; of several alike the first. None: null.
    const DeepRapid* deepest_rapid() const;
};

// The cut of a rapid move, before the moves after it: all along, or as if the tool had come to its end from above.
enum class RapidCut { kAlong, kAtEnd };

// Called with the share done, from time to time.
using Progress = std::function<void(double)>;

// A Z-map of its own, not clearing::StockHeightMap, whose planners it judges: docs/decisions/0009.
class MachinedStock {
public:
    MachinedStock(const HeightGrid& grid, double top);

    // Removes the volume of the tool at each position; for a flat bottom with a sharp edge, and for
    // a cone, also its sweep between positions.
    //
    // spacing  mm between positions: depths are measured with a tool reduced by the height of the
    //          slivers between two positions
    // trace    looks at the stock before each position; may be null
    // contact  likewise
    CutFigures cut(const ToolPositions& positions,
                   double spacing,
                   const Progress& progress,
                   EngagementTrace* trace = nullptr,
                   ContactTrace* contact = nullptr);

    // From now on only what rapid moves of these runs meet is kept true: positions far from all of their
    // moves below the stock's top are not cut. False where there is no such move.
    bool look_at_rapids_alone(const std::vector<ToolPositions>& runs, RapidCut rapids);

    // From now on there is no stock over the point of the grid: its height is
    // -kUnbounded.
    void clear(std::size_t point) { heights_[point] = -kUnbounded; }

    const std::vector<double>& heights() const { return heights_; }
    double top() const { return top_; }
    double removed_volume() const;  // mm^3, without what was cleared

private:
    CutFigures cut_band(const ToolPositions& positions,
                        double spacing,
                        EngagementTrace* trace,
                        ContactTrace* contact,
                        std::size_t band,
                        std::size_t begin,
                        std::size_t end);
    // The deepest of the positions [first, last) of a rapid move, in the stock before the first of them.
    DeepRapid deepest_of(const ToolPositions& positions,
                         std::size_t first,
                         std::size_t last,
                         double shrink,
                         std::size_t begin,
                         std::size_t end) const;
    // Calls visit(DiscColumn) for the points under the tool, and some around.
    //
    // reach   mm^2: square of the disc's radius
    // before  position that has cut, or is over all stock: points that it leaves nothing of are left out, but for
    //         some at the edge; null: none
    template <class Visit>
    void visit_disc(const toolpath::Tool& tool,
                    Vec3d tip,
                    double reach,
                    const Vec3d* before,
                    std::size_t begin,
                    std::size_t end,
                    Visit visit) const;
    // mm: how deep the tool, reduced by `shrink`, is in the stock.
    //
    // before  where it meets nothing. May be null.
    double depth_at(const toolpath::Tool& tool,
                    Vec3d tip,
                    double shrink,
                    const Vec3d* before,
                    std::size_t begin,
                    std::size_t end) const;
    // z of the stock around a place where it is level: what a pointed tool meets at its axis, between the points.
    // -kUnbounded elsewhere.
    double level_around(double x, double y, std::size_t begin, std::size_t end) const;
    // The columns left and right of a place, up to the grid's own.
    std::pair<std::size_t, std::size_t> columns_beside(double x) const;
    // The end of each band. None parts the columns beside a rapid position of a pointed tool.
    std::vector<std::size_t> bands_of(const ToolPositions& positions) const;
    bool is_looked_at(const toolpath::Tool& tool, Vec3d tip) const;
    // Returns the depth, mm.
    //
    // shrink  mm: reduction of the measuring tool
    // before  where it has just cut, or was over all stock. May be null.
    double cut_at(const toolpath::Tool& tool,
                  Vec3d tip,
                  double shrink,
                  const Vec3d* before,
                  std::size_t begin,
                  std::size_t end);
    void sweep_flat(
        const toolpath::Tool& tool, Vec3d from, Vec3d to, std::size_t begin, std::size_t end);
    void sweep_slope(double radius, Vec3d from, Vec3d to, std::size_t begin, std::size_t end);
    // Rows of a column, over a height.
    void sweep_rows(
        const FlatSweep& sweep, double low, std::size_t i, std::size_t first, std::size_t stop);

    void sweep_cone(
        const toolpath::Tool& tool, Vec3d from, Vec3d to, std::size_t begin, std::size_t end);

    HeightGrid grid_;
    double top_;
    std::vector<double> heights_;
    std::vector<double> row_x_;  // mm: offset of a row's points from their columns
    std::vector<double> row_y_;  // mm: of rows in a column without a shift
    // Number of points left of and below a point, both included, that are looked at; empty: all
    // are.
    std::vector<std::uint32_t> looked_at_;
    RapidCut rapids_{RapidCut::kAlong};
};

}  // namespace cusp::verify
