// Places of the ball beside facets, a square at a time; stretches along one line are joined.
#include "host_tools/cam/finishing/walls_over_nothing.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

#include "host_tools/cam/finishing/finish_area.hpp"
#include "host_tools/cam/finishing/uncut_walls.hpp"
#include "host_tools/cam/finishing/wall_side.hpp"

namespace cusp::finishing {

namespace {

constexpr double kSquare = 0.5;     // radii
constexpr double kSameWay = 1e-3;   // of a unit vector
constexpr double kSameLine = 0.01;  // mm

// A stretch of a wall, seen from above, on the line of its way out and its distance along that.
struct Stretch {
    std::int64_t out_x;
    std::int64_t out_y;
    std::int64_t distance;
    double from;
    double to;

    auto line() const { return std::tie(out_x, out_y, distance); }
};

double joined_length(std::vector<Stretch> stretches)
{
    std::sort(stretches.begin(), stretches.end(), [](const Stretch& a, const Stretch& b) {
        return std::tuple_cat(a.line(), std::tie(a.from)) <
               std::tuple_cat(b.line(), std::tie(b.from));
    });
    double sum = 0;
    double end = -kInfinite;
    for (std::size_t k = 0; k < stretches.size(); ++k) {
        const Stretch& at = stretches[k];
        if (k == 0 || at.line() != stretches[k - 1].line()) {
            end = -kInfinite;
        }
        sum += std::max(0.0, at.to - std::max(at.from, end));
        end = std::max(end, at.to);
    }
    return sum;
}

}  // namespace

double walls_over_nothing(const std::vector<WallFacet>& facets,
                          const GougeFreePathFitter& path_fitter)
{
    const double square = kSquare * path_fitter.tool().radius;
    std::map<std::pair<std::int64_t, std::int64_t>, bool> known;
    const auto is_over_nothing = [&](const WallSide& side, double along) {
        const Vec3d centre = side.centre_at_top(along);
        const auto [found, is_new] =
            known.try_emplace({std::llround(centre.x / square), std::llround(centre.y / square)});
        if (is_new) {
            path_fitter.model().forget_many_cells();
            found->second = !side.rests(centre);
        }
        return found->second;
    };
    std::vector<Stretch> stretches;
    for (const WallFacet& facet : facets_in(path_fitter.area(), facets)) {
        for (const WallSide& side : wall_sides_of(facet, path_fitter)) {
            const double length = side.end() - side.begin();
            const int parts = std::max(1, static_cast<int>(std::ceil(length / square)));
            const Vec3d out = side.out();
            const Stretch line{std::llround(out.x / kSameWay), std::llround(out.y / kSameWay),
                               std::llround(dot(side.corners().front(), out) / kSameLine), 0, 0};
            for (int k = 0; k < parts; ++k) {
                if (is_over_nothing(side, side.begin() + length * (k + 0.5) / parts)) {
                    stretches.push_back(line);
                    stretches.back().from = side.begin() + length * k / parts;
                    stretches.back().to = side.begin() + length * (k + 1) / parts;
                }
            }
        }
    }
    path_fitter.model().forget_queries();
    return joined_length(std::move(stretches));
}

}  // namespace cusp::finishing
