// Tips that are near each other are one pass; others begin the next.
#include "host_tools/cam/finishing/joined_tips.hpp"

namespace cusp::finishing {

namespace {

constexpr double kJoinedApart = 0.3;  // in stepovers: tips that one line may join
constexpr double kFarApart = 0.5;     // radii: tips that one pass may join
constexpr double kDab = 1e-3;         // mm

}  // namespace

std::vector<Points> joined_tips(const Points& tips,
                                const GougeFreePathFitter& path_fitter,
                                double step)
{
    // Drops are accurate to a micrometre only: a point at the limit may have had a tip in one query
    // and none in the next.
    if (tips.empty()) {
        return {};
    }
    std::vector<Points> out{{tips.front()}};
    for (std::size_t k = 1; k < tips.size(); ++k) {
        const double apart = norm(tips[k] - out.back().back());
        if (apart > kFarApart * path_fitter.tool().radius) {
            out.push_back({tips[k]});
            continue;
        }
        if (apart > kJoinedApart * step) {
            const Points between = path_fitter.sample_dropped(out.back().back(), tips[k]);
            out.back().insert(out.back().end(), between.begin() + 1, between.end() - 1);
        }
        out.back().push_back(tips[k]);
    }
    for (Points& run : out) {
        if (run.size() == 1) {
            run.push_back(run.front() + Vec3d{kDab, 0, 0});
        }
    }
    return out;
}

}  // namespace cusp::finishing
