// The pocket as cells: those whose centre the cutter's axis can reach. Choi, Cho & Kim, section
// 3.2.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "host_tools/geometry/offset/offset.hpp"

namespace cusp::grid_pocket {

struct Cell {
    int column{};
    int row{};
    friend bool operator==(Cell a, Cell b) { return a.column == b.column && a.row == b.row; }
    friend bool operator!=(Cell a, Cell b) { return !(a == b); }
};

// A rectangular block of cells over the pocket's box, each inside or outside.
class CellGrid {
public:
    // Cells of gx by gy mm from the lower left corner of the pocket's box. A cell is inside if its
    // centre lies in the region, at least `radius` mm from every wall (to 1e-6 mm).
    CellGrid(const offset::RegionOffset& pocket, double gx, double gy, double radius);

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    double gx() const { return gx_; }
    double gy() const { return gy_; }
    std::size_t size() const { return inside_.size(); }
    std::size_t count_inside() const;

    std::size_t index(Cell c) const
    {
        return static_cast<std::size_t>(c.row) * static_cast<std::size_t>(columns_) +
               static_cast<std::size_t>(c.column);
    }
    Cell cell(std::size_t index) const
    {
        const auto columns = static_cast<std::size_t>(columns_);
        return {static_cast<int>(index % columns), static_cast<int>(index / columns)};
    }
    bool within(Cell c) const
    {
        return c.column >= 0 && c.row >= 0 && c.column < columns_ && c.row < rows_;
    }
    bool inside(Cell c) const { return within(c) && inside_[index(c)] != 0; }
    Vec2d centre(Cell c) const
    {
        return {origin_.x + (c.column + 0.5) * gx_, origin_.y + (c.row + 0.5) * gy_};
    }
    Cell nearest(Vec2d p) const
    {
        return {static_cast<int>(std::floor((p.x - origin_.x) / gx_)),
                static_cast<int>(std::floor((p.y - origin_.y) / gy_))};
    }

private:
    double gx_;
    double gy_;
    Vec2d origin_;
    int columns_{};
    int rows_{};
    std::vector<std::uint8_t> inside_;
};

}  // namespace cusp::grid_pocket
