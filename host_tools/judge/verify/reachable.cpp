// Dilation by the tool, rims between grid points included, gives the lowest tips; erosion by the
// tool gives their cut.
#include "host_tools/judge/verify/reachable.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/judge/verify/bands.hpp"

namespace cusp::verify {

using toolpath::Tool;

namespace {

// A point of the tool's lower side: at a grid point, or on a line to the next one.
struct Place {
    std::ptrdiff_t i, j;
    float height;  // above the tip
    std::ptrdiff_t step_i, step_j;
    float share;  // of the step
};

std::vector<Place> points_under(const Tool& tool, double pitch)
{
    std::vector<Place> places;
    const auto n = static_cast<std::ptrdiff_t>(tool.radius / pitch);
    for (std::ptrdiff_t i = -n; i <= n; ++i) {
        for (std::ptrdiff_t j = -n; j <= n; ++j) {
            const double d =
                elementary::hypot(static_cast<double>(i), static_cast<double>(j)) * pitch;
            if (d <= tool.radius) {
                places.push_back({i, j, static_cast<float>(profile_height(tool, d)), 0, 0, 0});
            }
        }
    }
    return places;
}

// Places where circles of a tool's lower side cross the lines of the grid: the edge of its flat and
// its rim. On a slope a flat end touches with its rim, up to a pitch outside the last grid point
// below it.
std::vector<Place> rims_of(const Tool& tool, double pitch)
{
    std::vector<Place> rims;
    const auto add_circle = [&](double radius) {
        const auto height = static_cast<float>(profile_height(tool, radius));
        const double reach = radius / pitch;
        const auto n = static_cast<std::ptrdiff_t>(reach);
        for (std::ptrdiff_t k = -n; k <= n; ++k) {
            const auto across = static_cast<double>(k);
            const double out = std::sqrt(reach * reach - across * across);
            for (const double place : {-out, out}) {
                const double low = std::floor(place);
                const auto whole = static_cast<std::ptrdiff_t>(low);
                const auto share = static_cast<float>(place - low);
                rims.push_back({k, whole, height, 0, 1, share});
                rims.push_back({whole, k, height, 1, 0, share});
            }
        }
    };
    const double foot = tool.radius - tool.corner_radius;
    if (foot > pitch) {
        add_circle(foot);
        add_circle(tool.radius);
    }
    return rims;
}

// best[i][j] = the better of it and `height` of the tool at each of its positions there.
template <class Height, class Better>
void combine(const std::vector<float>& source,
             const HeightGrid& grid,
             const std::vector<Place>& places,
             Height height,
             Better better,
             std::vector<float>& best)
{
    const auto nx = static_cast<std::ptrdiff_t>(grid.nx);
    const auto ny = static_cast<std::ptrdiff_t>(grid.ny);
    for_each_band(grid.nx, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (auto i = static_cast<std::ptrdiff_t>(begin); i < static_cast<std::ptrdiff_t>(end);
             ++i) {
            float* to = best.data() + i * ny;
            for (const Place place : places) {  // a copy: `to` might alias it
                const std::ptrdiff_t row = i + place.i;
                if (row < 0 || row + place.step_i >= nx) {
                    continue;
                }
                const float* from = source.data() + row * ny + place.j;
                const float* next = from + place.step_i * ny + place.step_j;
                const std::ptrdiff_t low = std::max<std::ptrdiff_t>(0, -place.j);
                const std::ptrdiff_t high = std::min(ny, ny - place.j - place.step_j);
                for (std::ptrdiff_t j = low; j < high; ++j) {
                    to[j] = better(height(place, from[j], next[j]), to[j]);
                }
            }
        }
    });
}

}  // namespace

std::vector<float> lowest_reachable(const std::vector<float>& heights,
                                    const std::vector<char>& forbidden,
                                    const HeightGrid& grid,
                                    const Tool& tool)
{
    constexpr float kFar = std::numeric_limits<float>::infinity();
    const auto higher = [](float a, float b) {
        return a > b ? a : b;
    };
    const auto lower = [](float a, float b) {
        return a < b ? a : b;
    };
    const std::vector<Place> points = points_under(tool, grid.pitch);
    std::vector<float> tips(heights.size(), -kFar);
    combine(
        heights, grid, points, [](const Place& at, float here, float) { return here - at.height; },
        higher, tips);
    combine(
        heights, grid, rims_of(tool, grid.pitch),
        [](const Place& at, float here, float next) {
            return here + at.share * (next - here) - at.height;
        },
        higher, tips);
    for (std::size_t k = 0; k < tips.size(); ++k) {
        if (forbidden[k] != 0) {
            tips[k] = kFar;
        }
    }
    std::vector<float> lowest(tips.size(), kFar);
    combine(
        tips, grid, points, [](const Place& at, float here, float) { return here + at.height; },
        lower, lowest);
    return lowest;
}

}  // namespace cusp::verify
