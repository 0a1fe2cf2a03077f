// Rows of 64-bit words.
#include "host_tools/geometry/nesting/cell_mask.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::nesting {

namespace {

constexpr int kBits = 64;

int bits_of(std::uint64_t word)
{
    int count = 0;
    for (; word != 0; word &= word - 1) {
        ++count;
    }
    return count;
}

// Each cell becomes that `cells` columns to its right; from the lowest word up, in place.
void shift_down(std::vector<std::uint64_t>& row, int cells)
{
    const auto whole = static_cast<std::size_t>(cells / kBits);
    const int rest = cells % kBits;
    for (std::size_t w = 0; w < row.size(); ++w) {
        const std::uint64_t low = w + whole < row.size() ? row[w + whole] : 0;
        const std::uint64_t high = w + whole + 1 < row.size() ? row[w + whole + 1] : 0;
        row[w] = rest == 0 ? low : low >> rest | high << (kBits - rest);
    }
}

void join_shifted(std::vector<std::uint64_t>& row, int cells)
{
    std::vector<std::uint64_t> shifted = row;
    shift_down(shifted, cells);
    for (std::size_t w = 0; w < row.size(); ++w) {
        row[w] |= shifted[w];
    }
}

// A segment takes, of each row that it reaches, the cells between the ends of its part in that row.
void mark(Vec2d from, Vec2d to, double cell, CellMask& mask)
{
    if (from.y > to.y) {
        std::swap(from, to);
    }
    const auto column = [&](double x) {
        return static_cast<int>(std::floor(x / cell));
    };
    const int first = column(from.y - kNestRounding);
    const int last = column(to.y + kNestRounding);
    for (int row = std::max(first, 0); row <= std::min(last, mask.rows() - 1); ++row) {
        const double height = to.y - from.y;
        const auto x_at = [&](double y) {
            const double share = height > 0 ? std::clamp((y - from.y) / height, 0.0, 1.0) : 0.0;
            return from.x + share * (to.x - from.x);
        };
        const double a = height > 0 ? x_at(row * cell - kNestRounding) : from.x;
        const double b = height > 0 ? x_at((row + 1) * cell + kNestRounding) : to.x;
        mask.set(row, column(std::min(a, b) - kNestRounding),
                 column(std::max(a, b) + kNestRounding));
    }
}

// Takes what the outside can't reach from cell to neighbour.
void fill(CellMask& mask)
{
    CellMask outside(mask.columns(), mask.rows());
    std::vector<std::pair<int, int>> open;
    const auto visit = [&](int column, int row) {
        if (column >= 0 && row >= 0 && column < mask.columns() && row < mask.rows() &&
            !mask.at(column, row) && !outside.at(column, row)) {
            outside.set(row, column, column);
            open.emplace_back(column, row);
        }
    };
    for (int column = 0; column < mask.columns(); ++column) {
        visit(column, 0);
        visit(column, mask.rows() - 1);
    }
    for (int row = 0; row < mask.rows(); ++row) {
        visit(0, row);
        visit(mask.columns() - 1, row);
    }
    while (!open.empty()) {
        const auto [column, row] = open.back();
        open.pop_back();
        visit(column - 1, row);
        visit(column + 1, row);
        visit(column, row - 1);
        visit(column, row + 1);
    }
    for (int row = 0; row < mask.rows(); ++row) {
        for (int column = 0; column < mask.columns(); ++column) {
            if (!outside.at(column, row)) {
                mask.set(row, column, column);
            }
        }
    }
}

}  // namespace

CellMask::CellMask(int columns, int rows)
    : columns_{columns},
      rows_{rows},
      words_{(columns + kBits - 1) / kBits},
      bits_(static_cast<std::size_t>(words_) * static_cast<std::size_t>(rows), 0)
{
}

bool CellMask::at(int column, int row) const
{
    return (bits_[index(column / kBits, row)] >> (column % kBits) & 1) != 0;
}

void CellMask::set(int row, int first, int last)
{
    for (int column = std::max(first, 0); column <= std::min(last, columns_ - 1); ++column) {
        bits_[index(column / kBits, row)] |= std::uint64_t{1} << (column % kBits);
    }
}

int CellMask::count() const
{
    int count = 0;
    for (const std::uint64_t word : bits_) {
        count += bits_of(word);
    }
    return count;
}

CellRuns CellMask::runs() const
{
    CellRuns runs{columns_,
                  std::vector<std::vector<std::pair<int, int>>>(static_cast<std::size_t>(rows_))};
    for (int row = 0; row < rows_; ++row) {
        auto& found = runs.rows[static_cast<std::size_t>(row)];
        for (int column = 0; column < columns_; ++column) {
            if (!at(column, row)) {
                continue;
            }
            if (!found.empty() && found.back().second == column - 1) {
                found.back().second = column;
            } else {
                found.emplace_back(column, column);
            }
        }
    }
    return runs;
}

// A run from a to b meets a taken cell c at the columns c - b to c - a: the row, shifted by each of a to b, in log2 steps.
int CellMask::free_column(const CellRuns& piece, int column, int row) const
{
    std::vector<std::uint64_t> met(static_cast<std::size_t>(words_), 0);
    for (const auto& runs : piece.rows) {
        const auto begin = bits_.begin() + static_cast<std::ptrdiff_t>(index(0, row++));
        const std::vector<std::uint64_t> taken(begin, begin + words_);
        if (std::all_of(taken.begin(), taken.end(), [](std::uint64_t word) { return word == 0; })) {
            continue;
        }
        for (const auto& [first, last] : runs) {
            std::vector<std::uint64_t> run = taken;
            shift_down(run, first);
            int length = 1;
            for (; 2 * length <= last - first + 1; length *= 2) {
                join_shifted(run, length);
            }
            join_shifted(run, last - first + 1 - length);
            for (std::size_t w = 0; w < met.size(); ++w) {
                met[w] |= run[w];
            }
        }
    }
    for (; column + piece.columns <= columns_; ++column) {
        if ((met[static_cast<std::size_t>(column / kBits)] >> (column % kBits) & 1) == 0) {
            return column;
        }
    }
    return -1;
}

void CellMask::add(const CellMask& piece, int column, int row)
{
    for (int r = std::max(0, -row); r < std::min(piece.rows_, rows_ - row); ++r) {
        for (int c = 0; c < piece.columns_; ++c) {
            if (piece.at(c, r)) {
                set(row + r, column + c, column + c);
            }
        }
    }
}

CellMask filled_mask(const std::vector<Polyline>& polylines, Vec2d low, Vec2d high, double cell)
{
    const auto cells = [&](double length) {
        return static_cast<int>(std::floor((length + kNestRounding) / cell)) + 1;
    };
    CellMask mask(cells(high.x - low.x), cells(high.y - low.y));
    for (const Polyline& polyline : polylines) {
        for (std::size_t i = 0; i + 1 < polyline.size(); ++i) {
            mark(polyline[i] - low, polyline[i + 1] - low, cell, mask);
        }
    }
    fill(mask);
    return mask;
}

CellMask widened(const CellMask& mask, int margin, double gap, double cell)
{
    CellMask wide(mask.columns() + 2 * margin, mask.rows() + 2 * margin);
    const auto apart = [&](int cells) {
        return cell * std::max(cells - 1, 0);
    };
    for (int dy = -margin; dy <= margin; ++dy) {
        int reach = dy == 0 ? 0 : -1;  // a taken cell stays taken
        while (reach < margin && elementary::hypot(apart(reach + 1), apart(std::abs(dy))) < gap) {
            ++reach;
        }
        for (int row = 0; reach >= 0 && row < mask.rows(); ++row) {
            for (int column = 0; column < mask.columns(); ++column) {
                if (mask.at(column, row)) {
                    wide.set(row + dy + margin, column + margin - reach, column + margin + reach);
                }
            }
        }
    }
    return wide;
}

}  // namespace cusp::nesting
