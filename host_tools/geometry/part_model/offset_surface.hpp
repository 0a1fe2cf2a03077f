// A cubic B-spline approximation of the offset of a NURBS surface, with a computed error bound.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::part_model {

struct OffsetRequest {
    double distance{};   // mm > 0
    double tolerance{};  // mm > 0: required error bound
};

// At creases (knots of multiplicity degree) the offset is not connected, so it is approximated
// between them. The approximation interpolates the exact offset at the Greville abscissae of its
// knots. Knots are inserted in spans with too large an error bound. It is as smooth as the offset
// at the surface's own knots, and C2 elsewhere.
//
// The offset is on the side of the surface that faces up on average. Trims are ignored.
// Source: Elber & Cohen 1993, section 3, for its use; the bound is ours (offset_error.hpp).
class OffsetSurface {
public:
    OffsetSurface(const nurbs::Surface& surface, const OffsetRequest& request);

    // Part of an isocurve of the approximation, as an exact cubic B-spline in u. None where it
    // crosses a crease or a cell without a bound below the tolerance (poles, cusps), or where the
    // offset is on the lower side of the surface.
    //
    // v, u_begin < u_end  in the domain of the surface
    std::optional<nurbs::Curve> isocurve(double v, double u_begin, double u_end) const;

    // mm: the largest error bound of the cells within the tolerance.
    double error_bound() const { return error_bound_; }
    int cells() const { return cells_; }
    // The number of cells not within the tolerance.
    int cells_without_bound() const { return without_bound_; }
    // The number of control points of all pieces.
    int control_points() const;

private:
    struct Piece {
        nurbs::Surface surface;  // cubic, weights 1
        std::vector<double> u;
        std::vector<double> v;
        std::vector<bool> bounded;  // cell (i, j) at i * (v.size() - 1) + j
    };

    void add_piece(const nurbs::Surface& part, const OffsetRequest& request);
    bool is_up(double u, double v) const;

    nurbs::Surface source_;
    double side_{};  // of S_u x S_v
    std::vector<Piece> pieces_;
    double error_bound_{};
    int cells_{};
    int without_bound_{};
};

}  // namespace cusp::part_model
