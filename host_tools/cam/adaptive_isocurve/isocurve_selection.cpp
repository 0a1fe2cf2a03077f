// Spacing by the paper's rule, by equal scallops, or by the bound on neighbours.
#include "host_tools/cam/adaptive_isocurve/isocurve_selection.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "firmware/base/math.hpp"
#include "host_tools/cam/adaptive_isocurve/adaptive_isocurve.hpp"
#include "host_tools/cam/adaptive_isocurve/cross_section.hpp"
#include "host_tools/cam/adaptive_isocurve/isocurve_extraction.hpp"
#include "host_tools/cam/adaptive_isocurve/isocurve_spacing_bound.hpp"
#include "host_tools/geometry/toolpath/stepover.hpp"

namespace cusp::adaptive_isocurve {

using finishing::SurfaceOperation;
using job::Operation;
using nurbs::Surface;
using nurbs::SurfacePoint;
using part_model::SurfaceCut;
using toolpath::stepover;

namespace {

constexpr int kScallopSections = 200;  // along u
constexpr int kCurvatureSamples = 60;  // along u and v
// Share of the allowed scallop on one smooth surface: room for the bend of passes between the
// sections compared. Checking the strips that would exceed it costs more than the closer passes.
constexpr double kSmoothShare = 0.99;
// Share of the scallop that passes are planned for: the rest is room for their bend along the way.
constexpr double kPlannedShare = 0.99;
// Share of the scallop that is planned where ScallopCheck proves it: the proof needs a reserve.
constexpr double kCheckedShare = 0.97;
constexpr double kCompleteShare = 0.99;  // of the least step
constexpr int kSpacingRounds = 5;
constexpr double kCloser = 0.9998;  // than the bound requires

}  // namespace

IsocurveSelection::IsocurveSelection(const Operation& operation,
                                     const SurfaceOperation& work,
                                     bool is_smooth)
    : operation_{operation},
      work_{work},
      tool_{operation.tool.radius, work.outward()},
      is_smooth_{is_smooth}
{
}

const Surface& IsocurveSelection::surface_at(int surface) const
{
    return work_.surfaces()[static_cast<std::size_t>(surface)];
}

// mm: the scallop less what the tolerance may add.
double IsocurveSelection::planned_scallop() const
{
    return (is_smooth_ ? kPlannedShare : kCheckedShare) *
           (*operation_.tolerance.scallop - work_.outward());
}

// Steps for which the scallop has the planned height. A crest turns by half a turn at most: between
// two nodes it counts as no sharper, or a cusp would require millions of passes.
StepDensity IsocurveSelection::density() const
{
    const double scallop_height = planned_scallop();
    const double radius = operation_.tool.radius;
    return [scallop_height, radius](const SurfacePoint& p, double apart) {
        const CrossSection section = cross_section_at(p);
        const double sharpest = section.speed > 0 ? kPi / (section.speed * apart) : kInfinite;
        return section.speed /
               stepover(radius, scallop_height, std::min(sharpest, section.curvature));
    };
}

// The least step that any place of the surface requires.
double IsocurveSelection::least_step(int surface) const
{
    const Surface& s = surface_at(surface);
    const double scallop_height = planned_scallop();
    double least = 2 * operation_.tool.radius;
    for (int i = 0; i <= kCurvatureSamples; ++i) {
        for (int j = 0; j <= kCurvatureSamples; ++j) {
            const SurfacePoint p = work_.model().evaluate(
                surface, s.u_begin() + (s.u_end() - s.u_begin()) * i / kCurvatureSamples,
                s.v_begin() + (s.v_end() - s.v_begin()) * j / kCurvatureSamples);
            least = std::min(least, stepover(operation_.tool.radius, scallop_height,
                                             cross_section_at(p).curvature));
        }
    }
    return least;
}

std::vector<DomainCurve> IsocurveSelection::curves_of(int surface, bool complete, bool follow)
{
    const Surface& s = surface_at(surface);
    if (complete) {
        const double step = finish_keys(operation_).iso_distance
                                ? *finish_keys(operation_).iso_distance
                                : kCompleteShare * least_step(surface);
        return complete_isocurves(s, surface, step);
    }
    if (finish_keys(operation_).iso_distance && finish_keys(operation_).even_steps) {
        return curves_within(*finish_keys(operation_).iso_distance, surface);
    }
    if (finish_keys(operation_).iso_distance) {
        spacing_bound_ = std::max(spacing_bound_, *finish_keys(operation_).iso_distance);
        return adaptive_isocurves(s, surface, *finish_keys(operation_).iso_distance);
    }
    return curves_for_scallop(surface, follow);
}

std::vector<DomainCurve> IsocurveSelection::curves_for_scallop(int surface, bool follow) const
{
    const SurfaceFunction at = [this, surface](double u, double v) {
        return work_.model().evaluate(surface, u, v);
    };
    IsocurveScallop scallops{work_.model(), surface, tool_};
    const double allowed =
        (is_smooth_ ? kSmoothShare : 1.0) * (*operation_.tolerance.scallop - tool_.outward);
    const StripJudge judge = [&](double u, CurvePlace low, CurvePlace high, double sufficient) {
        if (!follow) {
            low.curve = high.curve = nullptr;
        }
        const double scallop_height =
            scallops.between(u, low, high, tool_.outward + sufficient * sufficient * allowed);
        const double over = (scallop_height - tool_.outward) / allowed;
        return std::min(1.5, std::sqrt(std::max(0.0, over)));
    };
    return equal_scallop_passes(surface_at(surface), surface, at, density(), judge).curves;
}

// Passes at equal steps, closer by as much as the bound on neighbours requires.
std::vector<DomainCurve> IsocurveSelection::curves_within(double distance, int surface)
{
    const SurfaceFunction at = [this, surface](double u, double v) {
        return work_.model().evaluate(surface, u, v);
    };
    const Surface& s = surface_at(surface);
    const IsocurveSpacingBound bound{s, work_.model(), surface};
    std::vector<DomainCurve> curves;
    std::optional<SurfaceCut> cut;
    double cut_at = 0;
    double step = distance;
    double apart = 0;
    for (int round = 0; round < kSpacingRounds; ++round) {
        const StepDensity steps = [step](const SurfacePoint& p, double /*apart*/) {
            return norm(p.dv) / step;
        };
        const StripJudge judge = [&](double u, CurvePlace low, CurvePlace high, double) {
            if (!cut || u != cut_at) {
                cut.emplace(work_.model().cut_at(surface, u));
                cut_at = u;
            }
            return norm(cut->at(high.v).point - cut->at(low.v).point) / step;
        };
        curves = equal_scallop_passes(s, surface, at, steps, judge).curves;
        apart = bound.over(curves, distance);
        if (apart <= distance) {
            break;
        }
        step *= kCloser * distance / apart;
    }
    spacing_bound_ = std::max(spacing_bound_, apart);
    return curves;
}

IsocurveScallop::Highest IsocurveSelection::highest_between(
    int surface, const std::vector<DomainCurve>& curves) const
{
    const Surface& s = surface_at(surface);
    const bool by_scallop = operation_.tolerance.scallop && !finish_keys(operation_).iso_distance;
    return IsocurveScallop{work_.model(), surface, tool_}.highest(
        curves, s.u_begin(), s.u_end(), kScallopSections,
        by_scallop ? *operation_.tolerance.scallop : kInfinite);
}

double share_of_domain(const std::vector<IsocurveScallop::Strip>& strips, const Surface& surface)
{
    double area = 0;
    for (const IsocurveScallop::Strip& strip : strips) {
        area += (strip.u1 - strip.u0) * (strip.v1 - strip.v0);
    }
    return area / ((surface.u_end() - surface.u_begin()) * (surface.v_end() - surface.v_begin()));
}

}  // namespace cusp::adaptive_isocurve
