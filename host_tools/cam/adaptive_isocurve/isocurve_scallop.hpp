// The scallop that a ball leaves between two neighbouring passes of one surface.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/cam/adaptive_isocurve/domain_curve.hpp"
#include "host_tools/geometry/part_model/surface_cut.hpp"

namespace cusp::adaptive_isocurve {

struct ScallopTool {
    double radius{};   // mm, of the ball
    double outward{};  // mm: maximum distance of the path off the surface
};

// Quickest where consecutive queries have the same u, or the same passes. Not for use by two
// threads at once.
class IsocurveScallop {
public:
    IsocurveScallop(const part_model::PartModel& model, int surface, const ScallopTool& tool)
        : model_{model}, surface_{surface}, tool_{tool}
    {
    }

    // The scallop height at u between two passes, along the normal; kInfinite where neither ball
    // reaches. The centres of the balls are assumed to move straight, in their direction at u. If
    // the places have curves, the direction is that at the nearest point of the curve.
    //
    // Returns an upper bound where the passes are closer than the ball is wide. The search ends at
    // a bound of at most `sufficient`.
    double between(double u, CurvePlace low, CurvePlace high, double sufficient = 0);

    // A part of the domain between two neighbours.
    struct Strip {
        double u0, u1, v0, v1;
    };
    struct Highest {
        double scallop_height;    // of all neighbours but those of `open`
        std::vector<Strip> open;  // where it exceeds `allowed`
    };
    // The highest scallop between neighbours at `count` + 1 sections along u. Open strips extend to
    // the next sections.
    //
    // allowed  mm: scallops below 0.995 of it may be inexact
    Highest highest(const std::vector<DomainCurve>& curves,
                    double u_begin,
                    double u_end,
                    int count,
                    double allowed = kInfinite);

private:
    // A ball that moves straight.
    struct Sweep {
        CurvePlace place;
        double u;
        Vec3d centre;
        Vec3d tangent;
        double rate;  // mm of the path by u
    };
    // The stock that a ball leaves over a point, along the normal.
    struct Uncut {
        double height;
        double ahead;  // mm: from the point to the nearest ball, along the path
    };
    // towards  v of the neighbour
    Sweep sweep_at(double u, CurvePlace place, double towards);
    Uncut uncut_by(const Sweep& sweep, Vec3d p, Vec3d normal) const;
    bool counts_as_straight(const Uncut& left) const;
    double uncut_by_pass(Sweep& sweep, double towards, Vec3d p, Vec3d normal);
    double balanced(Sweep low, Sweep high, double sufficient, bool follow);

    const part_model::PartModel& model_;
    int surface_;
    ScallopTool tool_;
    std::optional<part_model::SurfaceCut> cut_;
    double u_{};
    std::optional<Sweep> last_;  // the upper of the last two
    double share_{0.5};          // position of the last ridge between the passes, 0 to 1
};

}  // namespace cusp::adaptive_isocurve
