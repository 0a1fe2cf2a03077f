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
    //
    // Returns the deepest cut of a feed move at one position, mm.
    double cut(const ToolPositions& positions,
               double spacing,
               const Progress& progress,
               EngagementTrace* trace = nullptr,
               ContactTrace* contact = nullptr);

    // From now on there is no stock over the point of the grid: its height is
    // -kUnbounded.
    void clear(std::size_t point) { heights_[point] = -kUnbounded; }

    const std::vector<double>& heights() const { return heights_; }
    double top() const { return top_; }
    double removed_volume() const;  // mm^3, without what was cleared

private:
    double cut_band(const ToolPositions& positions,
                    double spacing,
                    EngagementTrace* trace,
                    ContactTrace* contact,
                    std::size_t band,
                    std::size_t begin,
                    std::size_t end);
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
};

}  // namespace cusp::verify
