// Upper bound of the distance between neighbouring curves at equal u, everywhere, not at samples.
//
// Proof: let D be the difference of two curves on the surface. Between u0 and u1 it deviates from
// its chord by at most (u1 - u0)^2 / 8 times the largest D'', and the length of a vector along a
// chord is largest at an end. D'' follows from bounds of the surface's derivatives on the cells
// that the curves cross (convex hulls of control points) and from the cubics of v over u. Where
// this proves too little, the interval is halved.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "host_tools/cam/adaptive_isocurve/domain_curve.hpp"
#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/part_model/bezier_cell.hpp"
#include "host_tools/geometry/part_model/part_model.hpp"

namespace cusp::adaptive_isocurve {

class IsocurveSpacingBound {
public:
    // surface  the one of that number in the model
    IsocurveSpacingBound(const nurbs::Surface& surface,
                         const part_model::PartModel& model,
                         int number);

    // The bound, mm, over all neighbours. At each u, the curves that pass it are neighbours in
    // order of v.
    //
    // allowed  mm: where neighbours are farther apart, the bound is accurate to a thousandth of
    //          this
    //
    // Accuracy: never below the distance but for rounding (`IsocurveSpacingBound` tests).
    double over(const std::vector<DomainCurve>& curves, double allowed) const;

private:
    // Bounds of the lengths of derivatives on a part of the domain.
    struct Leaf {
        double u0, u1, v0, v1;
        double dv, duu, duv, dvv;
    };
    // A curve over an interval: control values of its cubic, points at the ends, and the largest
    // second derivative by u.
    struct Strand {
        std::array<double, 4> v;
        Vec3d from;
        Vec3d to;
        double bend;
    };

    void collect(const part_model::BezierCell& cell, int halvings, std::vector<Leaf>& out) const;
    double bend_over(double u0, double u1, const std::array<double, 4>& v) const;
    double over_interval(
        double u0, double u1, const std::vector<Strand>& strands, double allowed, int depth) const;
    double over_halves(
        double u0, double u1, const std::vector<Strand>& strands, double allowed, int depth) const;
    static std::vector<std::size_t> first_of_groups(const std::vector<Strand>& strands);
    static bool by_middle(const Strand& a, const Strand& b);

    const part_model::PartModel& model_;
    int number_;
    double v_begin_;
    double v_end_;
    std::vector<double> breaks_u_;
    std::vector<double> breaks_v_;
    std::vector<std::vector<Leaf>> patches_;  // row by row in u, then v
};

}  // namespace cusp::adaptive_isocurve
