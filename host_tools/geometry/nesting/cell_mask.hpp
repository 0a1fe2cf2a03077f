// Squares of a grid that are taken, a bit each: of a piece, and of a sheet.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "host_tools/geometry/nesting/nesting.hpp"

namespace cusp::nesting {

// Runs of taken cells of each row: the first and the last column.
struct CellRuns {
    int columns{};
    std::vector<std::vector<std::pair<int, int>>> rows;
};

inline constexpr double kNestRounding = 1e-9;  // mm

class CellMask {
public:
    CellMask(int columns, int rows);

    CellRuns runs() const;

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    bool at(int column, int row) const;
    // Cells from `first` to `last` of a row; those outside of the grid do not count.
    void set(int row, int first, int last);
    int count() const;

    // The first column, `column` or right of it, at which no cell of `piece` is taken here and all lie in the grid, with its
    // lowest row at `row`; -1: there is none.
    int free_column(const CellRuns& piece, int column, int row) const;
    void add(const CellMask& piece, int column, int row);

private:
    std::size_t index(int word, int row) const
    {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(words_) +
               static_cast<std::size_t>(word);
    }

    int columns_;
    int rows_;
    int words_;  // of a row
    std::vector<std::uint64_t> bits_;
};

// The cells that the polylines touch, and all that they enclose. The grid begins at `low`.
//
// cell  mm: side of a square
CellMask filled_mask(const std::vector<Polyline>& polylines, Vec2d low, Vec2d high, double cell);

// `mask` with `margin` more cells on each side: all within `gap` mm of a taken cell are taken.
CellMask widened(const CellMask& mask, int margin, double gap, double cell);

}  // namespace cusp::nesting
