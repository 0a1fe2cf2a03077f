// Dilation by the tool gives the lowest tips, erosion by it what they cut.
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
    for (std::size_t k = 0; k < tips.size(); ++k) {
        if (forbidden[k] != 0) {
            tips[k] = kFar;
        }
    }
    return combined(tips, grid, shifts, 1.0F, kFar, [](float a, float b) { return a < b ? a : b; });
}

}  // namespace cusp::host
