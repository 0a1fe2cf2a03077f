// The ridge that a ball leaves between two neighbouring passes of one surface.
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "host_tools/adaptive_isocurve/domain_curve.hpp"
#include "host_tools/part_model/surface_cut.hpp"

namespace cusp::adaptive_isocurve {

struct ScallopTool {
    double radius{};   // mm, of the ball
    double outward{};  // mm: farthest that the path lies off the surface
};

// Ridges between neighbours of one surface; quick where questions at the same u, and between the
// same passes, follow each other.
class IsocurveScallop {
public:
    IsocurveScallop(const part_model::PartModel& model, int surface, const ScallopTool& tool)
        : model_{model}, surface_{surface}, tool_{tool}
    {
    }

    // Height of what is left at u between two passes, square to the surface; infinity where the
    // ball of neither pass reaches. The ball's centre counts as moving straight as it does at u;
    // where the place knows its curve, as at that place of the curve which is nearest.
    //
    // Returns a bound: never below the ridge where the way across is shorter than the ball is wide.
    // The first that is no more than `sufficient` will do.
    double between(double u, CurvePlace low, CurvePlace high, double sufficient = 0);

    // A part of the domain, as low and high as two neighbours are there.
    struct Strip {
        double u0, u1, v0, v1;
    };
    struct Highest {
        double scallop_height;    // over all neighbours but those of `open`
        std::vector<Strip> open;  // where it is more than was allowed
    };
    // Over all neighbours at `count` + 1 places along u. What is open reaches to the next places.
    //
    // allowed  mm: scallops below a share of it may be inexact
    Highest highest(const std::vector<DomainCurve>& curves,
                    double u_begin,
                    double u_end,
                    int count,
                    double allowed = std::numeric_limits<double>::infinity());

private:
    // A ball that moves straight.
    struct Sweep {
        CurvePlace place;
        double u;
        Vec3d centre;
        Vec3d tangent;
        double rate;  // mm of the way by u
    };
    // What a ball leaves over a point along its normal, and how far on along the way it is nearest.
    struct Uncut {
        double height;
        double ahead;  // mm
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
    double share_{0.5};          // of the way across: where the last ridge was
};

}  // namespace cusp::adaptive_isocurve
