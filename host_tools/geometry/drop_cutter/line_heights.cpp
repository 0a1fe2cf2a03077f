// The distance is greatest where bounds from both sides meet.
#include "host_tools/geometry/drop_cutter/line_heights.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>

namespace cusp::drop_cutter {

double off_by_curvature(const LineHeights& h, double curvature)
{
    const auto parabola = [&](double x) {
        return curvature / 2 * x * x;
    };
    const auto convex = [&](std::size_t k) {
        return h.z[k] + parabola((static_cast<double>(k) - 1) * h.step);
    };
    // the middle of a chord of the parabola is a quarter of that of its half over it
    double worst = std::max(h.z[2] - h.chord(h.step), 0.0) + parabola(h.step) / 4;
    for (const std::size_t k : {std::size_t{1}, std::size_t{2}}) {
        const double before = convex(k) - convex(k - 1);      // rise of the line from before
        const double beyond = convex(k + 2) - convex(k + 1);  // and of the one from beyond
        const double rise = convex(k + 1) - convex(k);
        const double meet =
            beyond > before ? std::clamp((beyond - rise) / (beyond - before), 0.0, 1.0) : 1.0;
        for (const double t : {0.0, meet, 1.0}) {
            const double x = (static_cast<double>(k) - 1 + t) * h.step;
            const double lowest =
                std::max(convex(k) + t * before, convex(k + 1) - (1 - t) * beyond) - parabola(x);
            worst = std::max(worst, h.chord(x) - lowest + 2 * h.error);
        }
    }
    return worst;
}

double off_by_slope(const LineHeights& h, double slope)
{
    double worst = 0;
    for (const std::size_t k : {std::size_t{1}, std::size_t{2}}) {
        const double begin = (static_cast<double>(k) - 1) * h.step;
        const double rise = (h.z[k + 1] - h.z[k]) / h.step;
        const double aside = slope > 0 ? std::clamp(rise / (2 * slope), -0.5, 0.5) : 0.0;
        const double low = (0.5 - aside) * h.step;
        const double high = (0.5 + aside) * h.step;
        worst = std::max({worst, h.chord(begin + low) - (h.z[k] - h.error - slope * low),
                          h.z[k] + slope * high - h.chord(begin + high),
                          std::abs(h.z[k] - h.chord(begin)) + h.error});
    }
    return worst;
}

}  // namespace cusp::drop_cutter
