// The density at the nodes, fitted to what the strips between curves require.
#include "host_tools/cam/adaptive_isocurve/density_table.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/nurbs/knot_insertion.hpp"

namespace cusp::adaptive_isocurve {

using nurbs::knots_between;
using nurbs::Surface;
using nurbs::SurfacePoint;

namespace {

constexpr std::size_t kLeastNodes = 160;
constexpr std::size_t kNodesInSpan = 4;
constexpr std::size_t kMostTableNodes = 800;
constexpr double kLeastFitted = 0.4;  // steps: narrower strips are not fitted
constexpr double kMostFitted = 1.2;   // largest change of the density in a round
constexpr double kFullStep = 0.998;   // the rest is for the interpolation between nodes

// All distinct knots, and equally spaced nodes between them.
std::vector<double> nodes_of(const std::vector<double>& knots, double begin, double end)
{
    const std::vector<double> breaks = knots_between(knots, begin, end);
    const std::size_t spans = breaks.size() - 1;
    const std::size_t parts = std::clamp(kLeastNodes / spans + 1, kNodesInSpan,
                                         std::max(kNodesInSpan, kMostTableNodes / spans));
    std::vector<double> out;
    for (std::size_t k = 0; k < spans; ++k) {
        for (std::size_t part = 0; part < parts; ++part) {
            const double t = static_cast<double>(part) / static_cast<double>(parts);
            out.push_back(breaks[k] + t * (breaks[k + 1] - breaks[k]));
        }
    }
    out.push_back(end);
    return out;
}

}  // namespace

DensityTable::DensityTable(const Surface& surface,
                           const SurfaceFunction& at,
                           const StepDensity& density)
    : u{nodes_of(surface.knots_u, surface.u_begin(), surface.u_end())},
      v{nodes_of(surface.knots_v, surface.v_begin(), surface.v_end())}
{
    for (const double here_u : u) {
        for (std::size_t j = 0; j < v.size(); ++j) {
            const SurfacePoint p = at(here_u, v[j]);
            const double apart = 0.5 * (v[std::min(j + 1, v.size() - 1)] - v[j == 0 ? 0 : j - 1]);
            density_.push_back(density(p, apart) / kFullStep);
            metric_.push_back({dot(p.du, p.du), dot(p.du, p.dv), dot(p.dv, p.dv)});
        }
    }
    integrate();
}

void DensityTable::fit(const std::vector<DomainCurve>& curves, const StripJudge& judge)
{
    std::vector<double> factor(density_.size(), 1.0);
    for (std::size_t i = 0; i < u.size(); ++i) {
        const std::vector<CurvePlace> across = places_at(curves, u[i]);
        double* row = &factor[i * v.size()];
        std::size_t j = 0;
        double last_v = v.front();
        double last = 0;
        for (std::size_t k = 1; k < across.size(); ++k) {
            const double width = steps(i, across[k].v) - steps(i, across[k - 1].v);
            if (width < kLeastFitted) {
                continue;
            }
            const double asked = judge(u[i], across[k - 1], across[k], 0) / width;
            const double here = std::clamp(asked, 1 / kMostFitted, kMostFitted);
            const double here_v = 0.5 * (across[k - 1].v + across[k].v);
            last = last == 0 ? here : last;
            for (; j < v.size() && v[j] <= here_v; ++j) {
                row[j] = last + (here - last) * (v[j] - last_v) / std::max(1e-300, here_v - last_v);
            }
            last_v = here_v;
            last = here;
        }
        if (last > 0) {
            std::fill(row + j, row + v.size(), last);
        }
    }
    smooth(factor, v.size(), 1, u.size(), v.size());
    smooth(factor, 1, v.size(), v.size(), u.size());
    for (std::size_t k = 0; k < density_.size(); ++k) {
        density_[k] *= factor[k];
    }
    integrate();
}

void DensityTable::require(std::size_t i, double at, double factor)
{
    asked_.resize(density_.size(), 1.0);
    const std::size_t j = cell(at);
    for (const std::size_t k : {i * v.size() + j, (i + 1) * v.size() + j}) {
        asked_[k] = std::max(asked_[k], factor);
        asked_[k + 1] = std::max(asked_[k + 1], factor);
    }
}

void DensityTable::tighten()
{
    for (int turn = 0; turn < 2; ++turn) {
        raise(asked_, v.size(), 1, u.size(), v.size());
        raise(asked_, 1, v.size(), v.size(), u.size());
    }
    smooth(asked_, v.size(), 1, u.size(), v.size());
    smooth(asked_, 1, v.size(), v.size(), u.size());
    for (std::size_t k = 0; k < density_.size(); ++k) {
        density_[k] *= asked_[k];
    }
    asked_.clear();
    integrate();
}

void DensityTable::smooth(std::vector<double>& values,
                          std::size_t stride,
                          std::size_t line_stride,
                          std::size_t count,
                          std::size_t lines)
{
    for (std::size_t line = 0; line < lines; ++line) {
        double* at = &values[line * line_stride];
        double before = at[0];
        for (std::size_t k = 0; k + 1 < count; ++k) {
            const double here = at[k * stride];
            at[k * stride] = 0.25 * (before + 2 * here + at[(k + 1) * stride]);
            before = here;
        }
    }
}

void DensityTable::raise(std::vector<double>& values,
                         std::size_t stride,
                         std::size_t line_stride,
                         std::size_t count,
                         std::size_t lines)
{
    for (std::size_t line = 0; line < lines; ++line) {
        double* at = &values[line * line_stride];
        double before = at[0];
        for (std::size_t k = 0; k < count; ++k) {
            const double here = at[k * stride];
            const double after = k + 1 < count ? at[(k + 1) * stride] : here;
            at[k * stride] = std::max({before, here, after});
            before = here;
        }
    }
}

}  // namespace cusp::adaptive_isocurve
