// A cubic B-spline surface that stands for the offset of a NURBS surface, with a computed bound of
// how far it is from the exact one.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"

namespace cusp::part_model {

struct OffsetRequest {
    double distance{};   // mm > 0
    double tolerance{};  // mm > 0: what the bound is to be below
};

// Where the surface has creases (knots of multiplicity degree) its offset is not connected: it is
// approximated piece by piece. The approximation interpolates the exact offset at the Greville
// abscissae of its knots; knots are inserted in the spans where the bound is not met. It is as
// smooth as the offset at the surface's own knots, and C2 elsewhere.
//
// The offset is on the side of the surface that is mostly up. Trims are not looked at.
// Source: Elber & Cohen 1993, section 3, for its use; the bound is ours (offset_error.hpp).
class OffsetSurface {
public:
    OffsetSurface(const nurbs::Surface& surface, const OffsetRequest& request);

    // Part of an isocurve of the approximation, a cubic B-spline in u, exactly; none where a cell
    // on its way has no bound below the tolerance (poles, cusps), it crosses a crease, or the
    // offset there is on the lower side of the surface.
    //
    // v, u_begin < u_end  in the domain of the surface
    std::optional<nurbs::Curve> isocurve(double v, double u_begin, double u_end) const;

    // The largest bound of the cells that are below the tolerance, mm; and how many are not.
    double error_bound() const { return error_bound_; }
    int cells() const { return cells_; }
    int cells_without_bound() const { return without_bound_; }
    // Of all pieces.
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
