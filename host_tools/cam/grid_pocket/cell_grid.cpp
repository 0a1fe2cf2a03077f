// Cells far from every wall are decided by their neighbour: the distance from walls changes no
// faster than the position.
#include "host_tools/cam/grid_pocket/cell_grid.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::grid_pocket {

using offset::Box2d;
using offset::RegionOffset;

namespace {

// Number of cells that cover `length`; a remainder below a millionth of a cell is rounding.
int cells(double length, double size) { return static_cast<int>(std::ceil(length / size - 1e-6)); }

}  // namespace

CellGrid::CellGrid(const RegionOffset& pocket, double gx, double gy, double radius)
    : gx_{gx}, gy_{gy}
{
    constexpr double kOnTheLine = 1e-6;
    const Box2d box = box_of(pocket.source());
    origin_ = {box.x0, box.y0};
    columns_ = cells(box.x1 - box.x0, gx);
    rows_ = cells(box.y1 - box.y0, gy);
    inside_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 0);
    for (int row = 0; row < rows_; ++row) {
        double known = 0;  // clearance at the last cell computed, less the distance since
        for (int column = 0; column < columns_; ++column) {
            const Cell c{column, row};
            known -= gx;
            if (known < radius) {
                known = pocket.clearance(centre(c));
            }
            inside_[index(c)] = known >= radius - kOnTheLine ? 1 : 0;
        }
    }
}

std::size_t CellGrid::count_inside() const
{
    return static_cast<std::size_t>(std::count(inside_.begin(), inside_.end(), std::uint8_t{1}));
}

}  // namespace cusp::grid_pocket
