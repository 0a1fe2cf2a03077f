// Passes along the curves of one surface, on several threads.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "host_tools/cam/adaptive_isocurve/domain_curve.hpp"
#include "host_tools/cam/adaptive_isocurve/offset_curve_trimmer.hpp"
#include "host_tools/cam/finishing/surface_operation.hpp"
#include "host_tools/geometry/part_model/offset_surface.hpp"

namespace cusp::adaptive_isocurve {

// The passes along one curve.
struct CurvePasses {
    std::vector<finishing::SurfaceOperation::FittedPass> passes;
    bool whole{};    // one pass, from end to end
    bool blocked{};  // the tool would cut something else
    int exact{};     // passes with an exact curve
};

class CurveFitter {
public:
    // work, tracer  kept
    CurveFitter(const finishing::SurfaceOperation& work, const OffsetCurveTrimmer& tracer)
        : work_{work}, tracer_{tracer}
    {
    }

    // The passes along curves `begin` to `end` - 1, in their order. For a caller that has SharedQueries.
    //
    // may_be_clear  whether to try first if the tool is clear all along
    // offset        of the surface, for exact curves; none for lines and arcs
    // done          called for each curve, by any thread
    std::vector<CurvePasses> fitted(const std::vector<DomainCurve>& curves,
                                    std::size_t begin,
                                    std::size_t end,
                                    bool may_be_clear,
                                    const std::optional<part_model::OffsetSurface>& offset,
                                    const std::function<void()>& done) const;

private:
    // The pieces that are still to be fitted, besides passes.
    struct Traced {
        std::vector<TracedPiece> pieces;
        CurvePasses out;

        std::size_t points() const;
    };
    Traced traced(const DomainCurve& curve, bool may_be_clear) const;
    bool add_whole(const DomainCurve& curve, CurvePasses& out) const;
    bool reaches_ends(const DomainCurve& curve, const finishing::Points& piece) const;
    void fit_pieces(const DomainCurve& curve,
                    const std::optional<part_model::OffsetSurface>& offset,
                    Traced& traced) const;
    std::optional<nurbs::Curve> tip_isocurve(const part_model::OffsetSurface& offset,
                                             const DomainCurve& curve,
                                             const TracedPiece& piece) const;

    const finishing::SurfaceOperation& work_;
    const OffsetCurveTrimmer& tracer_;
};

}  // namespace cusp::adaptive_isocurve
