// Curves of the domain mapped to the offset of the surface, and trimmed there by the whole model.
#pragma once

#include <vector>

#include "host_tools/adaptive_isocurve/domain_curve.hpp"
#include "host_tools/finishing/gouge_free_path.hpp"

namespace cusp::adaptive_isocurve {

// A part of a curve where the tool is free, as dense tips.
struct TracedPiece {
    finishing::Points points;
    finishing::CcParameterList cc_parameters;
    double u_begin;
    double u_end;
};

struct TracedCurve {
    std::vector<TracedPiece> pieces;
    bool blocked{};  // somewhere by another place of the model, not by a trim only
};

class OffsetCurveTrimmer {
public:
    OffsetCurveTrimmer(const std::vector<nurbs::Surface>& surfaces,
                       const finishing::GougeFreePathFitter& path_fitter)
        : surfaces_{surfaces}, path_fitter_{path_fitter}
    {
    }

    // The tip of the ball that touches the surface at (u, v), lifted by the band's lift.
    Vec3d tip(int surface, double u, double v) const;

    // Whether (u, v) is in the trimmed domain and the tool there is free of the rest of the model.
    bool is_clear_at(int surface, double u, double v) const;

    // The parts of the curve where the tool is free. A loss of less than 1 mm that
    // hides between free places is not trimmed here: the proof of the path lifts over it.
    TracedCurve trace(const DomainCurve& curve) const;

    // All of the curve, free or not.
    TracedPiece whole(const DomainCurve& curve) const
    {
        return along(curve, curve.u.front(), curve.u.back());
    }

    // Lines along the edge of the free part of the surface, on the model: where offsets of two
    // surfaces meet, and trimmed edges. Empty where all is free.
    //
    // spacing  mm: of the grid on which the edge is looked for
    std::vector<finishing::Points> clear_region_edges(int surface, double spacing) const;

private:
    // A way in the domain from a free place to one that is not.
    struct EdgeSide {
        Vec2d free;
        Vec2d blocked;
    };
    Vec3d edge_tip(int surface, const EdgeSide& side) const;
    // From the tip of one side's edge to the other's.
    finishing::Points edge_points(
        int surface, const EdgeSide& from, const EdgeSide& to, Vec3d a, Vec3d b) const;
    TracedPiece along(const DomainCurve& curve, double from, double to) const;

    const std::vector<nurbs::Surface>& surfaces_;
    const finishing::GougeFreePathFitter& path_fitter_;
};

}  // namespace cusp::adaptive_isocurve
