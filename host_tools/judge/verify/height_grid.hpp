// The grid of points in plan at which heights are stored.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

namespace cusp::verify {

// A grid of nx columns (x) of ny points (y). Each row and each column is shifted by its own part of
// a pitch, so that straight ridges cross all phases of the grid.
struct HeightGrid {
    double x0{};  // of the first column before its shifts
    double y0{};
    double pitch{};  // mm
    std::size_t nx{};
    std::size_t ny{};
    bool shifted{true};

    std::size_t size() const { return nx * ny; }
    std::size_t index(std::size_t i, std::size_t j) const { return i * ny + j; }
    double x(std::size_t i, std::size_t j) const
    {
        return x0 + static_cast<double>(i) * pitch + shift(j);
    }
    double y(std::size_t i, std::size_t j) const
    {
        return y0 + static_cast<double>(j) * pitch + shift(i);
    }

    // Within half a pitch; golden section, so no two near rows share it.
    double shift(std::size_t k) const
    {
        constexpr double kGolden = 0.6180339887498949;
        const double turn = static_cast<double>(k) * kGolden;
        return shifted ? pitch * (turn - std::floor(turn) - 0.5) : 0.0;
    }

    // The first and the end column that can lie in [low, high], with a margin of one pitch.
    std::size_t first_column(double low) const { return clamped((low - x0) / pitch - 1, nx); }
    std::size_t end_column(double high) const { return clamped((high - x0) / pitch + 2, nx); }
    std::size_t first_row(double low) const { return clamped((low - y0) / pitch - 1, ny); }
    std::size_t end_row(double high) const { return clamped((high - y0) / pitch + 2, ny); }

    // A value as a number of points, at most a limit.
    static std::size_t clamped(double value, std::size_t limit)
    {
        return value <= 0                            ? 0
               : value >= static_cast<double>(limit) ? limit
                                                     : static_cast<std::size_t>(value);
    }
};

// first_row() and end_row() without a division.
class GridRows {
public:
    explicit GridRows(const HeightGrid& grid)
        : y0_{grid.y0}, per_mm_{1 / grid.pitch}, count_{grid.ny}
    {
    }

    std::size_t first(double low) const
    {
        return HeightGrid::clamped((low - y0_) * per_mm_ - 1, count_);
    }
    std::size_t end(double high) const
    {
        return HeightGrid::clamped((high - y0_) * per_mm_ + 2, count_);
    }

private:
    double y0_;
    double per_mm_;
    std::size_t count_;
};

}  // namespace cusp::verify
