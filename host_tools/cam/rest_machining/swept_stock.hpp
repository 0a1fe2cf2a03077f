// The stock that earlier moves leave: exactly what none of them has swept, without a raster.
//
//     SweptStock stock{0.0};                          // top
//     stock.add(EndProfile{tool}, {0, 0, -2}, {50, 0, -2});
//     stock.is_clear({EndProfile{small, 0.01}, {10, 0, -2}, {40, 0, -2}});   // true
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "host_tools/cam/rest_machining/tool_sweep.hpp"

namespace cusp::rest_machining {

// Unbounded in x and y.
class SweptStock {
public:
    // top  z of the uncut stock
    explicit SweptStock(double top) : top_{top} {}

    // Removes what a tool sweeps on a straight move.
    void add(const EndProfile& end, Vec3d from, Vec3d to);

    // Adds all sweeps of the other stock that overlap the box.
    void add_near(const SweptStock& other, Vec2d low, Vec2d high);

    double top() const { return top_; }
    std::size_t sweeps() const { return sweeps_.size(); }

    // z of the stock at a point.
    double height(Vec2d p) const;

    // True if a sweep provably meets no stock: each cell under it is under one earlier sweep, or
    // below the tool by its tangent plane. False also where the proof takes too long or would need cells
    // under 0.002 mm.
    bool is_clear(const ToolSweep& tool) const;

private:
    struct Square {
        Vec2d middle;
        double half;
    };
    // A cell of a quadtree that is built on demand: the sweeps that may be lowest in its square.
    struct Cell {
        std::vector<std::uint32_t> sweeps;
        std::int32_t children{-1};  // the first of four
    };

    void prepare() const;
    std::int32_t bucket(std::size_t column, std::size_t row) const;
    std::vector<std::uint32_t> lowest_in(const Square& square,
                                         const std::vector<std::uint32_t>& candidates) const;
    std::int32_t children_of(std::int32_t cell, const Square& square) const;
    bool is_covered(std::int32_t cell, const Square& square, const SupportPlane& plane) const;
    bool is_clear_in(const ToolSweep& tool,
                     std::int32_t cell,
                     const Square& square,
                     int& budget) const;
    bool is_contained(const ToolSweep& tool) const;
    Square square_of(std::size_t column, std::size_t row) const;
    std::size_t column_of(double x) const;
    std::size_t row_of(double y) const;

    double top_;
    std::vector<ToolSweep> sweeps_;
    // built from the sweeps by the first query
    mutable bool prepared_{false};
    mutable Vec2d origin_{};
    mutable double size_{};  // mm: of a bucket
    mutable std::size_t columns_{};
    mutable std::size_t rows_{};
    mutable std::vector<std::vector<std::uint32_t>> listed_;  // of each bucket
    mutable std::vector<std::int32_t> roots_;                 // cells of the buckets; -1: none yet
    mutable std::vector<Cell> cells_;
};

}  // namespace cusp::rest_machining
