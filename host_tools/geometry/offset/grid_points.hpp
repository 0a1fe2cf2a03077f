// Points of an integer grid: what decides how regions overlay is computed from them exactly.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "host_tools/geometry/offset/contour.hpp"

namespace cusp::offset {

struct GridPoint {
    std::int64_t x{};
    std::int64_t y{};
    friend GridPoint operator-(GridPoint a, GridPoint b) { return {a.x - b.x, a.y - b.y}; }
    friend bool operator==(GridPoint a, GridPoint b) { return a.x == b.x && a.y == b.y; }
};

// Coordinates have 40 bits at most, products of three differences 126.
__extension__ using WideInt = __int128;
inline WideInt cross(GridPoint a, GridPoint b) { return WideInt{a.x} * b.y - WideInt{a.y} * b.x; }
inline WideInt dot(GridPoint a, GridPoint b) { return WideInt{a.x} * b.x + WideInt{a.y} * b.y; }

// Vertices on the grid, numbered from 0, each with its place: the first point that was given for it.
class GridPoints {
public:
    // The grid's step is 2^-24 mm (6e-8 mm) where the box reaches no farther than 16 m from the
    // origin, and the least power of two that keeps to 38 bits elsewhere.
    explicit GridPoints(const Box2d& box);

    // The nearest vertex no farther than kSameVertex, or a new one.
    std::uint32_t near(Vec2d place);
    // The vertex at exactly this point, or a new one.
    std::uint32_t at(GridPoint point);

    std::size_t size() const { return points_.size(); }  // vertices
    GridPoint point(std::uint32_t vertex) const { return points_[vertex]; }
    Vec2d place(std::uint32_t vertex) const { return places_[vertex]; }

private:
    std::uint32_t add(GridPoint point, Vec2d place);
    template <class Visit>
    void visit_cell(std::int64_t x, std::int64_t y, Visit visit) const;

    double step_;
    std::vector<GridPoint> points_;
    std::vector<Vec2d> places_;
    std::vector<std::uint32_t> next_;  // of the same cell
    std::unordered_map<std::uint64_t, std::uint32_t> first_;
};

}  // namespace cusp::offset
