// The trimmed domain of a surface: what is inside, and the edges as polylines in space.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::part_model {

class TrimRegion {
public:
    // surface     its trims are closed loops in (u, v) with the inside to their left
    // edge_error  mm: maximum distance between an edge in space and its polyline. The polylines cut
    //             off nothing: every point inside the loops is inside here, so what is proved for
    //             this region holds for the trimmed surface
    TrimRegion(const nurbs::Surface& surface, double edge_error);

    bool trimmed() const { return !corners_.empty(); }
    bool inside(double u, double v) const;

    enum class Part : std::uint8_t { kInside, kOutside, kCut };
    // Place of a rectangle of the domain; kCut if an edge may touch it.
    Part part(double u_begin, double u_end, double v_begin, double v_end) const;

    // The inside part of a rectangle of the domain lies in the convex hull of these points (u, v).
    struct Remnant {
        std::vector<Vec2d> corners;  // corners of the rectangle that are inside
        std::vector<Vec2d> edge;     // ends of the parts of polyline sides in the rectangle
    };
    // Place of the rectangle, as part() says.
    //
    // out  set to the remnant where the result is kCut, else emptied; keeps its memory
    Part remnant(double u_begin, double u_end, double v_begin, double v_end, Remnant& out) const;

    // A place inside the trims and the direction of an edge near it.
    struct Beside {
        Vec2d place;
        Vec2d along;
    };
    // A place in a rectangle that an edge cuts; in the middle of a sliver where the rectangle holds
    // nothing else. None found where no edge cuts it.
    std::optional<Beside> beside(Vec2d low, Vec2d high) const;

    // The edges in space, each loop a closed polyline with its first corner at the end. Not kept: a
    // part has hundreds of thousands of corners.
    //
    // surface  that of the region
    std::vector<std::vector<Vec3d>> edges(const nurbs::Surface& surface) const;

    // The edges in (u, v), each loop a closed polyline without its first corner at the end.
    std::vector<std::vector<Vec2d>> loops() const;

private:
    struct Box {
        Vec2d low, high;
    };
    static Box widened(double u_begin, double u_end, double v_begin, double v_end);
    std::size_t rows() const { return row_begins_.size() - 1; }
    std::size_t row(double v) const;
    double left_of(double u) const;
    std::array<bool, 2> inside_at(const std::array<double, 2>& u, double v) const;
    void make_rows();
    void find_blocks();
    // The sides of a row, in their order, but for some that lie beside [low, high] in u.
    template <class Visit>
    void visit_sides(std::size_t row, double low, double high, const Visit& visit) const;
    // True if rows from `first` on up to this one hold the side for the first time: a long side is in
    // many rows.
    bool is_seen_first(std::uint32_t side, std::size_t row, std::size_t first) const
    {
        return row == std::max<std::size_t>(first, first_rows_[side]);
    }
    std::array<Vec2d, 2> side(std::size_t number) const
    {
        return {corners_[number], corners_[number + 1]};
    }
    // Calls visit(number) for the sides of all loops in order.
    template <class Visit>
    void for_each_side(const Visit& visit) const;

    // A part has a million sides: each corner is kept once, and lists are not longer than needed.
    std::vector<Vec2d> corners_;            // of all loops; each ends with its first corner
    std::vector<std::uint32_t> loop_ends_;  // past the last corner of each loop
    // The sides that touch each of the equal rows between the least and the greatest v, row by row;
    // a side has the number of its first corner.
    std::vector<std::uint32_t> row_sides_;
    std::vector<std::uint32_t> row_begins_;  // in row_sides_, and its end
    // Least and greatest u of each kBlock of row_sides_, rounded outward. An edge along u has all
    // its sides in one row.
    static constexpr std::size_t kBlock = 8;
    std::vector<std::array<float, 2>> blocks_;
    std::vector<std::uint16_t> first_rows_;  // of each side
    double low_{};
    double high_{};
    double largest_u_{};
};

}  // namespace cusp::part_model
