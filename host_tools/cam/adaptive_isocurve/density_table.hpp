// A table over (u, v) of the number of steps between passes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "host_tools/cam/adaptive_isocurve/equal_scallop_passes.hpp"

namespace cusp::adaptive_isocurve {

// Density of steps and metric at the nodes of a grid over the domain.
class DensityTable {
public:
    DensityTable(const nurbs::Surface& surface,
                 const SurfaceFunction& at,
                 const StepDensity& density);

    // Steps from the lower end of v.
    double steps(std::size_t i, double at) const
    {
        const std::size_t j = cell(at);
        const double h = v[j + 1] - v[j];
        return cubic(i, j, (at - v[j]) / h);
    }

    // The inverse of steps(): the v of a number of steps. It may lie a little outside the surface.
    double inverse(std::size_t i, double wanted) const
    {
        const auto row = sum_.begin() + static_cast<std::ptrdiff_t>(i * v.size());
        const auto next =
            std::upper_bound(row + 1, row + static_cast<std::ptrdiff_t>(v.size()) - 1, wanted);
        const std::size_t j = static_cast<std::size_t>(next - row) - 1;
        const std::size_t end = i * v.size() + v.size() - 1;
        // Outside the density is that at the border, for passes that begin there.
        if (wanted < 0) {
            return v.front() + wanted / std::max(kLeastDensity, density_[i * v.size()]);
        }
        if (wanted > sum_[end]) {
            return v.back() + (wanted - sum_[end]) / std::max(kLeastDensity, density_[end]);
        }
        // The density is linear in the cell: a root of a parabola.
        const double h = v[j + 1] - v[j];
        const double at_low = density_[i * v.size() + j];
        const double more = density_[i * v.size() + j + 1] - at_low;
        const double part = (wanted - row[static_cast<std::ptrdiff_t>(j)]) / h;
        const double root = std::sqrt(std::max(0.0, at_low * at_low + 2 * more * part));
        const double t = at_low + root > 0 ? std::clamp(2 * part / (at_low + root), 0.0, 1.0) : 0;
        return v[j] + t * h;
    }

    // Length of a short move (du, dv) near the node, mm.
    double length(std::size_t i, double at, double du, double dv) const
    {
        const std::array<double, 3>& g = metric_[i * v.size() + cell(at)];
        return std::sqrt(std::max(0.0, g[0] * du * du + 2 * g[1] * du * dv + g[2] * dv * dv));
    }

    // Fits the density to what the strips between the curves require: slanting passes may be
    // farther apart than isocurves, and passes with changing curvature between them closer.
    void fit(const std::vector<DomainCurve>& curves, const StripJudge& judge);

    // Records a factor required between the nodes i and i + 1 of u, at v = `at`, for tighten().
    void require(std::size_t i, double at, double factor);

    // Multiplies the density by the recorded factors, smoothed over the nodes around.
    void tighten();

    void integrate()
    {
        sum_.assign(density_.size(), 0.0);
        for (std::size_t i = 0; i < u.size(); ++i) {
            for (std::size_t j = 1; j < v.size(); ++j) {
                const std::size_t k = i * v.size() + j;
                sum_[k] = sum_[k - 1] + 0.5 * (density_[k - 1] + density_[k]) * (v[j] - v[j - 1]);
            }
        }
    }

    std::vector<double> u;
    std::vector<double> v;

private:
    static constexpr double kLeastDensity = 1e-6;

    // Replaces each value by a weighted mean with its neighbours (1, 2, 1), along lines of values
    // `stride` apart.
    static void smooth(std::vector<double>& values,
                       std::size_t stride,
                       std::size_t line_stride,
                       std::size_t count,
                       std::size_t lines);

    // Replaces each value by the largest of itself and its neighbours.
    static void raise(std::vector<double>& values,
                      std::size_t stride,
                      std::size_t line_stride,
                      std::size_t count,
                      std::size_t lines);

    std::size_t cell(double at) const
    {
        const auto next = std::upper_bound(v.begin() + 1, v.end() - 1, at);
        return static_cast<std::size_t>(next - v.begin()) - 1;
    }

    // The integral of the density, which is linear between nodes.
    double cubic(std::size_t i, std::size_t j, double t) const
    {
        const std::size_t k = i * v.size() + j;
        const double h = v[j + 1] - v[j];
        return sum_[k] + h * t * (density_[k] + 0.5 * t * (density_[k + 1] - density_[k]));
    }

    std::vector<double> density_;
    std::vector<double> asked_;
    std::vector<double> sum_;
    std::vector<std::array<double, 3>> metric_;
};

}  // namespace cusp::adaptive_isocurve
