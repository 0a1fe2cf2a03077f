// Curves of the domain, mapped to the offset of the surface and trimmed there by the whole model.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/cam/adaptive_isocurve/domain_curve.hpp"
#include "host_tools/cam/finishing/gouge_free_path.hpp"

namespace cusp::adaptive_isocurve {

// A part of a curve along which the tool is clear, as dense tips.
struct TracedPiece {
    finishing::Points points;
    finishing::CcParameterList cc_parameters;
    double u_begin;
    double u_end;
};

struct TracedCurve {
    std::vector<TracedPiece> pieces;
    bool blocked{};  // somewhere by another part of the model, not by a trim only
};

class OffsetCurveTrimmer {
public:
    OffsetCurveTrimmer(const std::vector<nurbs::Surface>& surfaces,
                       const finishing::GougeFreePathFitter& path_fitter)
        : surfaces_{surfaces}, path_fitter_{path_fitter}
    {
    }

    // The tip of the ball whose contact is (u, v), off the surface by the band's offset.
    Vec3d tip(int surface, double u, double v) const;

    // True if (u, v) is inside the trims and the tool there is clear of the rest of the model.
    bool is_clear_at(int surface, double u, double v) const;

    // The parts of the curve where the tool is clear. A blocked part shorter than 1 mm may remain:
    // the proof of the path lifts the tool over it.
    TracedCurve trace(const DomainCurve& curve) const;

    // The whole curve, clear or not.
    TracedPiece whole(const DomainCurve& curve) const
    {
        return along(curve, curve.u.front(), curve.u.back());
    }

    // Tips along the edge of the clear part of the surface, on the model: trimmed edges, and curves
    // where the offsets of two surfaces meet. Empty where all is clear.
    //
    // spacing  mm, of the grid on which the edge is searched
    std::vector<finishing::Points> clear_region_edges(int surface, double spacing) const;

private:
    // A segment in the domain from a clear point to a blocked one.
    struct EdgeSide {
        Vec2d free;
        Vec2d blocked;
    };
    Vec3d edge_tip(int surface, const EdgeSide& side) const;
    std::vector<finishing::Points> along_edges(
        int surface, const std::vector<std::vector<EdgeSide>>& edges) const;
    // Tips along the edge from one segment, with tip `a`, to the next, with tip `b`; none where the
    // segment halfway between them starts blocked.
    std::optional<finishing::Points> edge_points(
        int surface, const EdgeSide& from, const EdgeSide& to, Vec3d a, Vec3d b) const;
    TracedPiece along(const DomainCurve& curve, double from, double to) const;

    const std::vector<nurbs::Surface>& surfaces_;
    const finishing::GougeFreePathFitter& path_fitter_;
};

}  // namespace cusp::adaptive_isocurve
