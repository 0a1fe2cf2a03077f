// Each square of the coarse grid has the value of its worst point.
#include "host_tools/judge/view/left_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::view {

using verify::HeightGrid;
using verify::Verification;

namespace {

constexpr double kUnit = 1e4;  // of 0.1 um in a millimetre
constexpr std::int32_t kUncut = 32767;
constexpr std::int32_t kNoFloor = -32768;
// mm: error of the map; smaller gouges are ignored.
constexpr double kJudgement = 5e-4;

void put_planes(const std::vector<std::uint16_t>& values, Bytes& out)
{
    for (unsigned plane = 0; plane < 2; ++plane) {
        for (const std::uint16_t value : values) {
            out.put_u8(unsigned{value} >> 8U * plane);
        }
    }
}

// Negative: depth of a gouge. Otherwise the stock left above the reachable height. NaN: no floor.
double over_part(const Verification& v, std::size_t k)
{
    return v.gouge[k] > kJudgement ? -v.gouge[k]
           : std::isnan(v.left[k]) ? v.left[k]
                                   : std::max(0.0, v.left[k]);
}

// The value of a square that is farthest from 0; NaN where none has a floor.
double worst_of_square(const Verification& v, std::size_t i0, std::size_t j0, std::size_t size)
{
    double worst = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = i0; i < std::min(v.grid.nx, i0 + size); ++i) {
        for (std::size_t j = j0; j < std::min(v.grid.ny, j0 + size); ++j) {
            const double left = over_part(v, v.grid.index(i, j));
            if (!std::isnan(left) && !(std::abs(left) <= std::abs(worst))) {
                worst = left;
            }
        }
    }
    return worst;
}

std::int32_t steps_of_left(double left)
{
    if (std::isnan(left)) {
        return kNoFloor;
    }
    if (std::isinf(left)) {
        return kUncut;
    }
    return static_cast<std::int32_t>(
        std::lround(std::clamp(left * kUnit, kNoFloor + 1.0, kUncut - 1.0)));
}

struct Candidate {
    double rank;
    std::size_t k;
};

}  // namespace

std::vector<WorstPlace> worst_places(const Verification& v, double top)
{
    constexpr std::size_t kMost = 10;
    constexpr std::size_t kMostSorted = 20000;
    const double allowed = std::max(kJudgement, v.bounds.floor_tolerance);
    const double scallop = std::max(kJudgement, v.figures.scallop_bound.value_or(allowed));
    std::vector<Candidate> all;
    for (std::size_t k = 0; k < v.left.size(); ++k) {
        const double left = over_part(v, k);
        if (left < 0) {
            all.push_back({-left / allowed, k});
        } else if (left > kJudgement) {
            const double over = std::isinf(left) ? top - v.part[k] : left;
            all.push_back({over / scallop, k});
        }
    }
    const auto worse = [](const Candidate& a, const Candidate& b) {
        return a.rank > b.rank || (a.rank == b.rank && a.k < b.k);
    };
    const std::size_t sorted = std::min(all.size(), kMostSorted);
    std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(sorted), all.end(),
                      worse);
    all.resize(sorted);

    const HeightGrid& grid = v.grid;
    const double apart = std::max(
        10 * grid.pitch, 0.03 * grid.pitch * static_cast<double>(std::max(grid.nx, grid.ny)));
    std::vector<WorstPlace> places;
    for (const Candidate& candidate : all) {
        const std::size_t i = candidate.k / grid.ny;
        const std::size_t j = candidate.k % grid.ny;
        const Vec3d at{grid.x(i, j), grid.y(i, j), v.part[candidate.k]};
        const bool near_another =
            std::any_of(places.begin(), places.end(), [&](const WorstPlace& p) {
                return elementary::hypot(p.at.x - at.x, p.at.y - at.y) < apart;
            });
        if (near_another) {
            continue;
        }
        const double left = over_part(v, candidate.k);
        if (left < 0) {
            places.push_back({"gouge", -left, at});
        } else if (std::isinf(left)) {
            places.push_back({"uncut", top - at.z, at});
        } else {
            places.push_back({"left", left, at});
        }
        if (places.size() == kMost) {
            break;
        }
    }
    return places;
}

Bytes left_map(const Verification& v, const HeightGrid& grid)
{
    const auto times = static_cast<std::size_t>(std::lround(grid.pitch / v.grid.pitch));
    std::vector<double> part(grid.size());
    std::vector<std::uint16_t> left(grid.size());
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (std::size_t i = 0; i < grid.nx; ++i) {
        for (std::size_t j = 0; j < grid.ny; ++j) {
            const std::size_t i0 = i * times;
            const std::size_t j0 = j * times;
            const double z = v.part[v.grid.index(std::min(v.grid.nx - 1, i0 + times / 2),
                                                 std::min(v.grid.ny - 1, j0 + times / 2))];
            part[grid.index(i, j)] = z;
            if (std::isfinite(z)) {
                low = std::min(low, z);
                high = std::max(high, z);
            }
            left[grid.index(i, j)] =
                static_cast<std::uint16_t>(steps_of_left(worst_of_square(v, i0, j0, times)));
        }
    }
    constexpr double kSteps = 65534;
    constexpr std::uint16_t kNone = 65535;
    std::vector<std::uint16_t> heights(grid.size(), kNone);
    for (std::size_t k = 0; k < part.size(); ++k) {
        if (std::isfinite(part[k])) {
            const double share = high > low ? (part[k] - low) / (high - low) : 0.0;
            heights[k] = static_cast<std::uint16_t>(std::lround(share * kSteps));
        }
    }
    Bytes planes;
    put_planes(heights, planes);
    put_planes(left, planes);
    Bytes out;
    out.put_f64(std::isfinite(low) ? low : 0.0);
    out.put_f64(std::isfinite(high) ? high : 0.0);
    out.put(deflated(planes.text()));
    return out;
}

}  // namespace cusp::view
