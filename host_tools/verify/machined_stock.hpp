// Material removal: the stock as a height map, and the cut of each position of a tool.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/toolpath/toolpath.hpp"
#include "host_tools/verify/height_grid.hpp"
#include "host_tools/verify/tool_positions.hpp"

namespace cusp::verify {

class ContactTrace;
class EngagementTrace;

struct CutFigures {
    double rapid_cut{};  // mm: deepest cut of a rapid move into stock
    double cut_depth{};  // mm: deepest cut of a feed move
};

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
    // Returns the depth, mm.
    //
    // shrink  mm: reduction of the measuring tool
    // before  of a cylinder: where it has just cut, no higher. Only what lies outside is cut. May be
    //         null.
    double cut_at(const toolpath::Tool& tool,
                  Vec3d tip,
                  double shrink,
                  const Vec3d* before,
                  std::size_t begin,
                  std::size_t end);
    void sweep_flat(
        const toolpath::Tool& tool, Vec3d from, Vec3d to, std::size_t begin, std::size_t end);

    void sweep_cone(
        const toolpath::Tool& tool, Vec3d from, Vec3d to, std::size_t begin, std::size_t end);

    HeightGrid grid_;
    double top_;
    std::vector<double> heights_;
    std::vector<double> row_x_;  // mm: offset of a row's points from their columns
    std::vector<double> row_y_;  // mm: of rows in a column without a shift
};

}  // namespace cusp::verify
