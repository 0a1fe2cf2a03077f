// Which isocurves finish a surface: their spacing by iso_distance or scallop, and the bounds proved
// for it.
#pragma once

#include <vector>

#include "host_tools/cam/adaptive_isocurve/domain_curve.hpp"
#include "host_tools/cam/adaptive_isocurve/equal_scallop_passes.hpp"
#include "host_tools/cam/adaptive_isocurve/isocurve_scallop.hpp"
#include "host_tools/cam/finishing/surface_operation.hpp"
#include "host_tools/job/job/job.hpp"

namespace cusp::adaptive_isocurve {

// Not for use by two threads at once.
class IsocurveSelection {
public:
    // work       of the operation
    // is_smooth  the part is one smooth surface without trims: its scallops are bounded between
    //            neighbouring passes alone, not by a check of the whole surface
    IsocurveSelection(const job::Operation& operation,
                      const finishing::SurfaceOperation& work,
                      bool is_smooth);

    // The curves of one surface, in order of v.
    //
    // complete  every curve over all of u, at equal steps of v
    // follow    scallops count passes as bent along their curves, not as straight: sharper, and
    //           twice as slow
    std::vector<DomainCurve> curves_of(int surface, bool complete, bool follow);

    // The highest scallop between neighbours. Strips where it exceeds the operation's scallop are
    // listed instead of counted.
    IsocurveScallop::Highest highest_between(int surface,
                                             const std::vector<DomainCurve>& curves) const;

    // mm: the distance of neighbours at equal u proved for iso_distance, over all surfaces so far;
    // 0 where passes are spaced by scallop.
    double spacing_bound() const { return spacing_bound_; }

private:
    const nurbs::Surface& surface_at(int surface) const;
    double planned_scallop() const;
    StepDensity density() const;
    double least_step(int surface) const;
    std::vector<DomainCurve> curves_for_scallop(int surface, bool follow) const;
    std::vector<DomainCurve> curves_within(double distance, int surface);

    const job::Operation& operation_;
    const finishing::SurfaceOperation& work_;
    ScallopTool tool_;
    bool is_smooth_;
    double spacing_bound_{};
};

// The part of the surface's domain that strips cover, 0 to 1.
double share_of_domain(const std::vector<IsocurveScallop::Strip>& strips,
                       const nurbs::Surface& surface);

}  // namespace cusp::adaptive_isocurve
