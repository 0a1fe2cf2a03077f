// Dilation by the tool, its rims between grid points included, gives the lowest tips, erosion by it
// what they cut.
#include "host_tools/verify/reachable.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host_tools/verify/bands.hpp"

namespace cusp::host {
namespace {

struct Shift {
    std::ptrdiff_t i, j;
    float height;
};

std::vector<Shift> shifts_of(const Tool& tool, double pitch)
{
    std::vector<Shift> shifts;
    const auto n = static_cast<std::ptrdiff_t>(tool.radius / pitch);
    for (std::ptrdiff_t i = -n; i <= n; ++i) {
        for (std::ptrdiff_t j = -n; j <= n; ++j) {
            const double d = std::hypot(static_cast<double>(i), static_cast<double>(j)) * pitch;
            if (d <= tool.radius) {
                shifts.push_back({i, j, static_cast<float>(profile_height(tool, d))});
            }
        }
    }
    return shifts;
}

// A place of the tool between two neighbouring grid points.
struct Between {
    Shift first;
    std::ptrdiff_t i, j;  // from the first to the second
    float share;          // of the way to the second
};

// Where circles of a tool's lower side cross the lines of the grid: the edge of its foot and its
// rim. On a slope a flat end rests on its rim, up to a pitch farther out than the last grid point
// under it.
std::vector<Between> rims_of(const Tool& tool, double pitch)
{
    std::vector<Between> rims;
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
                rims.push_back({{k, whole, height}, 0, 1, share});
                rims.push_back({{whole, k, height}, 1, 0, share});
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

// Raises best[i][j] to what stands at those places, less their heights.
void raise_over(const std::vector<float>& source,
                const HeightGrid& grid,
                const std::vector<Between>& rims,
                std::vector<float>& best)
{
    const auto nx = static_cast<std::ptrdiff_t>(grid.nx);
    const auto ny = static_cast<std::ptrdiff_t>(grid.ny);
    for_each_band(grid.nx, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (auto i = static_cast<std::ptrdiff_t>(begin); i < static_cast<std::ptrdiff_t>(end);
             ++i) {
            float* to = best.data() + i * ny;
            for (const Between& rim : rims) {
                const std::ptrdiff_t row = i + rim.first.i;
                if (row < 0 || row + rim.i >= nx) {
                    continue;
                }
                const float* a = source.data() + row * ny + rim.first.j;
                const float* b = a + rim.i * ny + rim.j;
                const std::ptrdiff_t low = std::max<std::ptrdiff_t>(0, -rim.first.j);
                const std::ptrdiff_t high = std::min(ny, ny - rim.first.j - rim.j);
                for (std::ptrdiff_t j = low; j < high; ++j) {
                    const float here = a[j] + rim.share * (b[j] - a[j]) - rim.first.height;
                    to[j] = here > to[j] ? here : to[j];
                }
            }
        }
    });
}

// best[i][j] = extreme over the shifts of source[i + di][j + dj] + sign * height.
template <class Better>
std::vector<float> combined(const std::vector<float>& source,
                            const HeightGrid& grid,
                            const std::vector<Shift>& shifts,
                            float sign,
                            float worst,
                            Better better)
{
    std::vector<float> best(source.size(), worst);
    const auto nx = static_cast<std::ptrdiff_t>(grid.nx);
    const auto ny = static_cast<std::ptrdiff_t>(grid.ny);
    for_each_band(grid.nx, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (auto i = static_cast<std::ptrdiff_t>(begin); i < static_cast<std::ptrdiff_t>(end);
             ++i) {
            float* to = best.data() + i * ny;
            for (const Shift& shift : shifts) {
                if (i + shift.i < 0 || i + shift.i >= nx) {
                    continue;
                }
                const float* from = source.data() + (i + shift.i) * ny + shift.j;
                const std::ptrdiff_t low = std::max<std::ptrdiff_t>(0, -shift.j);
                const std::ptrdiff_t high = std::min(ny, ny - shift.j);
                const float height = sign * shift.height;
                for (std::ptrdiff_t j = low; j < high; ++j) {
                    to[j] = better(from[j] + height, to[j]);
                }
            }
        }
    });
    return best;
}

}  // namespace

std::vector<float> lowest_reachable(const std::vector<float>& heights,
                                    const std::vector<char>& forbidden,
                                    const HeightGrid& grid,
                                    const Tool& tool)
{
    constexpr float kFar = std::numeric_limits<float>::infinity();
    const std::vector<Shift> shifts = shifts_of(tool, grid.pitch);
    std::vector<float> tips = combined(heights, grid, shifts, -1.0F, -kFar,
                                       [](float a, float b) { return a > b ? a : b; });
    raise_over(heights, grid, rims_of(tool, grid.pitch), tips);
    for (std::size_t k = 0; k < tips.size(); ++k) {
        if (forbidden[k] != 0) {
            tips[k] = kFar;
        }
    }
    return combined(tips, grid, shifts, 1.0F, kFar, [](float a, float b) { return a < b ? a : b; });
}

}  // namespace cusp::host
