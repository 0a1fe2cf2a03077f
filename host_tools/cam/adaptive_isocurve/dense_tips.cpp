// Quintic interpolation through six neighbours: its error is of sixth order in the spacing.
#include "host_tools/cam/adaptive_isocurve/dense_tips.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace cusp::adaptive_isocurve {

using finishing::GougeFreePathFitter;
using finishing::Points;

namespace {

constexpr std::size_t kNodes = 6;
constexpr double kRight = 0.02;  // of the band
// Factor by which half the spacing lowers the error; 8 where a third derivative jumps.
constexpr double kFinerBy = 6;
constexpr double kSagShare = 0.06;        // of the band: between dense tips
constexpr std::size_t kMostBetween = 64;  // dense tips between two exact ones
constexpr int kDeepest = 12;              // halvings

using Weights = std::array<double, kNodes>;

// Lagrange weights at a place among nodes 0 to 5.
Weights weights_at(double place)
{
    Weights out;
    for (std::size_t k = 0; k < kNodes; ++k) {
        out[k] = 1;
        for (std::size_t m = 0; m < kNodes; ++m) {
            if (m != k) {
                out[k] *= (place - static_cast<double>(m)) /
                          (static_cast<double>(k) - static_cast<double>(m));
            }
        }
    }
    return out;
}

Vec3d mean(const Vec3d* nodes, const Weights& weights)
{
    Vec3d sum;
    for (std::size_t k = 0; k < kNodes; ++k) {
        sum = sum + nodes[k] * weights[k];
    }
    return sum;
}

// The first of six nodes around a span between two nodes.
std::size_t first_about(std::size_t span, std::size_t count)
{
    return std::min(span < 2 ? 0 : span - 2, count - kNodes);
}

// Weights for the parts of a span, by the position of the span among its six nodes.
class Parts {
public:
    const std::vector<Weights>& of(std::size_t offset, std::size_t parts)
    {
        std::vector<Weights>& out = known_[{offset, parts}];
        for (std::size_t k = out.size() + 1; k < parts; ++k) {
            out.push_back(weights_at(static_cast<double>(offset) +
                                     static_cast<double>(k) / static_cast<double>(parts)));
        }
        return out;
    }

private:
    std::map<std::pair<std::size_t, std::size_t>, std::vector<Weights>> known_;
};

}  // namespace

DenseTips dense_tips(const GougeFreePathFitter& path_fitter,
                     const std::function<Vec3d(double)>& at,
                     const std::vector<double>& breaks)
{
    DenseTips out;
    if (breaks.size() < kNodes) {
        out.points = path_fitter.sample(at, breaks, kDeepest, &out.u);
        return out;
    }
    const double band = path_fitter.band().half_width;
    Points nodes;
    for (const double u : breaks) {
        nodes.push_back(at(u));
    }
    // Breaks and the middles between.
    const std::size_t spans = breaks.size() - 1;
    Points halves{nodes.front()};
    std::vector<bool> smooth;
    for (std::size_t k = 0; k < spans; ++k) {
        const Vec3d middle = at(0.5 * (breaks[k] + breaks[k + 1]));
        const std::size_t first = first_about(k, nodes.size());
        const Weights weights = weights_at(static_cast<double>(k - first) + 0.5);
        smooth.push_back(norm(mean(&nodes[first], weights) - middle) <= kFinerBy * kRight * band);
        halves.push_back(middle);
        halves.push_back(nodes[k + 1]);
    }
    Parts parts_of;
    out.points.push_back(halves.front());
    out.u.push_back(breaks.front());
    for (std::size_t h = 0; h + 1 < halves.size(); ++h) {
        const std::size_t span = h / 2;
        const double from = h % 2 == 0 ? breaks[span] : 0.5 * (breaks[span] + breaks[span + 1]);
        const double to = h % 2 == 0 ? 0.5 * (breaks[span] + breaks[span + 1]) : breaks[span + 1];
        const std::size_t bent = std::clamp<std::size_t>(h, 1, halves.size() - 2);
        const double sag =
            norm(halves[bent - 1] - halves[bent] * 2 + halves[bent + 1]) / (8 * kSagShare * band);
        const std::size_t parts = static_cast<std::size_t>(std::ceil(std::sqrt(sag))) + 1;
        if (!smooth[span] || parts > kMostBetween) {
            std::vector<double> exact_u;
            const Points exact = path_fitter.sample(at, {from, to}, kDeepest, &exact_u);
            out.points.insert(out.points.end(), exact.begin() + 1, exact.end());
            out.u.insert(out.u.end(), exact_u.begin() + 1, exact_u.end());
            continue;
        }
        const std::size_t first = first_about(h, halves.size());
        const std::vector<Weights>& weights = parts_of.of(h - first, parts);
        for (std::size_t k = 1; k < parts; ++k) {
            out.points.push_back(mean(&halves[first], weights[k - 1]));
            out.u.push_back(from +
                            (to - from) * static_cast<double>(k) / static_cast<double>(parts));
        }
        out.points.push_back(halves[h + 1]);
        out.u.push_back(to);
    }
    return out;
}

}  // namespace cusp::adaptive_isocurve
