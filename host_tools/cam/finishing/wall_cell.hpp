// A cell of a face by its control points: how far it is off a plane facet, and how its normals turn,
// bounded by the hulls of Bernstein polynomials.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::finishing {

// A polynomial over the unit square, in powers of s, 1 - s, t and 1 - t: Bernstein coefficients times
// their binomials, so that a product is a convolution.
struct ScaledBernstein {
    std::size_t p{};
    std::size_t q{};
    std::vector<double> c;  // (i, j) at i * (q + 1) + j

    // Bounds of all values.
    std::array<double, 2> range() const;
};

// All that is said of a cell holds everywhere in it, but for rounding. The normal of a rational patch
// is, but for its length, a polynomial: its cross product is taken of numerators.
class WallCell {
public:
    // low, high  of the cell, in the patch's domain
    WallCell(const nurbs::BezierPatch& patch, Vec2d low, Vec2d high);

    // True if the unit normal's z is farther from 0 than `z` everywhere, to one side.
    bool leans_more_than(double z) const;

    // Bounds of dot(point - from, way), mm.
    std::array<double, 2> along(Vec3d from, Vec3d way) const;

    // The normals of a facet turn evenly: at a point p they lead to
    //     normal + along * (bend * dot(p - middle, along)).
    struct Frame {
        Vec3d middle;
        Vec3d normal;  // unit
        Vec3d along;   // unit, square to it
        double bend;   // 1/mm
    };
    // z of the face's normals is expected at `low` in the cell's lowest corner, and to grow by `slope`
    // over all of the cell.
    struct Lines {
        double low;
        Vec2d slope;
    };
    struct Turn {
        double along;  // of the unit normals off those of the facet, level
        double rise;   // the same, square to that
        double most;   // of the unit normals off the facet's in its middle, level
        double lines;  // of z off what is expected
    };
    // None where the normals are not proved to be within a right angle of the facet's.
    //
    // side  1 where cross(du, dv) leads to the facet's side, else -1; z is that of the former
    std::optional<Turn> turn(const Frame& frame, const Lines& lines, double side) const;

    // Bounds of second derivatives by shares of the cell, mm, of places seen along the normal of a frame.
    struct Bends {
        double uu{};
        double uv{};
        double vv{};

        // mm: how far the cell's points over a straight side are off the line between those over its
        // ends.
        //
        // way  from end to end, in shares of the cell
        double bow(Vec2d way) const
        {
            const Vec2d w{std::abs(way.x), std::abs(way.y)};
            return 0.125 * (uu * w.x * w.x + 2 * uv * w.x * w.y + vv * w.y * w.y);
        }
    };
    Bends bends(const Frame& frame) const;

private:
    using Vector = std::array<ScaledBernstein, 3>;
    Vector normal_of(std::array<std::vector<double>, 4>& nets) const;
    ScaledBernstein normal_along(Vec3d way) const;

    std::size_t p_;
    std::size_t q_;
    bool rational_;
    std::vector<Vec3d> points_;  // relative to origin_
    std::vector<double> weights_;
    Vec3d origin_;
    Vector normal_;  // not of unit length
};

}  // namespace cusp::finishing
