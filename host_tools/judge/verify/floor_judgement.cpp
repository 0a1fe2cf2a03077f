// The figures compare the cut with that of ideal tools: stock that no tool can reach does not
// count.
#include "host_tools/judge/verify/floor_judgement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/judge/verify/bands.hpp"
#include "host_tools/judge/verify/reachable.hpp"
#include "host_tools/judge/verify/residual_thickness.hpp"
#include "host_tools/judge/verify/stock_distance.hpp"
#include "host_tools/judge/verify/tool_access.hpp"

namespace cusp::verify {

using toolpath::Tool;

namespace {

constexpr double kFlush = 1e-6;  // mm: files are not exact

// The grid grown by `n` points on every side, without shifts.
HeightGrid grown(const HeightGrid& grid, std::size_t n)
{
    const double by = static_cast<double>(n) * grid.pitch;
    return {grid.x0 - by, grid.y0 - by, grid.pitch, grid.nx + 2 * n, grid.ny + 2 * n, false};
}

// The least heights that the tools can leave, at `level` (the grid without shifts).
std::vector<double> best_heights(const FloorQuestion& q,
                                 const HeightGrid& level,
                                 const std::vector<double>& part)
{
    std::vector<double> best(level.size(), kInfinite);
    for (const Tool& tool : q.tools) {
        const auto n = static_cast<std::size_t>(std::ceil(tool.radius / level.pitch)) + 1;
        const HeightGrid wide = grown(level, n);
        std::vector<float> heights(wide.size(), -std::numeric_limits<float>::infinity());
        for (std::size_t i = 0; i < level.nx; ++i) {
            for (std::size_t j = 0; j < level.ny; ++j) {
                const double z = part[level.index(i, j)];
                if (std::isfinite(z)) {
                    heights[wide.index(i + n, j + n)] = static_cast<float>(z);
                }
            }
        }
        std::vector<char> forbidden(wide.size(), 0);
        for_each_band(wide.nx, [&](std::size_t begin, std::size_t end, std::size_t) {
            for (std::size_t i = begin; i < end && !q.walls.empty(); ++i) {
                for (std::size_t j = 0; j < wide.ny; ++j) {
                    const double c = q.walls.at(wide.x(i, j), wide.y(i, j));
                    forbidden[wide.index(i, j)] = c < tool.radius ? 1 : 0;
                }
            }
        });
        const std::vector<float> lowest = lowest_reachable(heights, forbidden, wide, tool);
        for (std::size_t i = 0; i < level.nx; ++i) {
            for (std::size_t j = 0; j < level.ny; ++j) {
                double& at = best[level.index(i, j)];
                at = std::min(at, static_cast<double>(lowest[wide.index(i + n, j + n)]));
            }
        }
    }
    return best;
}

// Largest of the values up to `reach` points away, along both directions.
std::vector<double> maximum_around(const std::vector<double>& values,
                                   const HeightGrid& grid,
                                   std::size_t reach)
{
    std::vector<double> rows(values.size());
    std::vector<double> out(values.size());
    for (std::size_t i = 0; i < grid.nx; ++i) {
        for (std::size_t j = 0; j < grid.ny; ++j) {
            const auto first =
                values.begin() + static_cast<std::ptrdiff_t>(grid.index(i, j - std::min(j, reach)));
            const auto last = values.begin() + static_cast<std::ptrdiff_t>(
                                                   grid.index(i, std::min(grid.ny - 1, j + reach)));
            rows[grid.index(i, j)] = *std::max_element(first, last + 1);
        }
    }
    for (std::size_t i = 0; i < grid.nx; ++i) {
        for (std::size_t j = 0; j < grid.ny; ++j) {
            double most = rows[grid.index(i, j)];
            for (std::size_t k = i - std::min(i, reach); k <= std::min(grid.nx - 1, i + reach);
                 ++k) {
                most = std::max(most, rows[grid.index(k, j)]);
            }
            out[grid.index(i, j)] = most;
        }
    }
    return out;
}

struct Ideal {
    std::vector<double> height;  // after a perfect program; not finite where no tool can come
    std::vector<char> unfit;     // no tool fits there
};

Ideal ideal_heights(const FloorQuestion& q, const PartHeights& part)
{
    HeightGrid level = q.grid;
    level.shifted = false;
    const PartHeights flat = part_heights(q.surfaces, q.mesh, level);
    const std::vector<double> best = best_heights(q, level, flat.z);
    // on a smooth floor the closing of a height map by a tool is too high by up to this
    const double max_error = 0.002 + level.pitch * level.pitch / (4 * least_radius(q.tools));
    std::vector<double> unfit(level.size(), 0.0);
    for (std::size_t k = 0; k < level.size(); ++k) {
        unfit[k] = std::isfinite(flat.z[k]) && !(best[k] - flat.z[k] <= max_error) ? 1.0 : 0.0;
    }
    // shifted points are up to half a pitch beside the points without shifts
    constexpr std::size_t kAround = 2;
    const std::vector<double> near_unfit = maximum_around(unfit, level, kAround);
    const std::vector<double> most = maximum_around(best, level, kAround);
    Ideal ideal{part.z, std::vector<char>(level.size(), 0)};
    for (std::size_t k = 0; k < level.size(); ++k) {
        if (near_unfit[k] > 0) {
            ideal.unfit[k] = 1;
            ideal.height[k] = std::max(most[k], part.z[k]);
        }
    }
    return ideal;
}

bool is_owed(const FloorQuestion& q, const PartHeights& part, std::size_t k)
{
    const Vec3d place{q.grid.x(k / q.grid.ny, k % q.grid.ny),
                      q.grid.y(k / q.grid.ny, k % q.grid.ny), part.z[k]};
    return q.owed.holds(place, part.cosine[k]);
}

// Points inside the walls where the stock is higher than the scallop above the part.
std::vector<std::size_t> doubtful_places(const FloorQuestion& q,
                                         const PartHeights& part,
                                         const std::vector<double>& clear)
{
    std::vector<std::size_t> places;
    const double radius = least_radius(q.tools);
    for (std::size_t k = 0; k < q.grid.size(); ++k) {
        if (std::isfinite(part.z[k]) && clear[k] >= radius &&
            (q.cut[k] - part.z[k]) * part.cosine[k] > *q.scallop && is_owed(q, part, k)) {
            places.push_back(k);
        }
    }
    return places;
}

// Replaces the grid's heights at these points by the lowest height that the tools can cut there:
// the grid misses rims and crests between its points, and the lowest points of narrow valleys.
// Returns the number of points where the stock is still higher than the scallop above that.
std::size_t settle(const FloorQuestion& q,
                   const PartHeights& part,
                   const std::vector<std::size_t>& places,
                   Ideal& ideal)
{
    const FloorSamples samples{q.grid, part.z};
    for_each_band(places.size(), [&](std::size_t begin, std::size_t end, std::size_t) {
        ToolAccess reach{q.surfaces, q.mesh, q.tools, q.walls, samples, q.path_clearance};
        for (std::size_t n = begin; n < end; ++n) {
            const std::size_t k = places[n];
            const std::size_t i = k / q.grid.ny;
            const std::size_t j = k % q.grid.ny;
            const Vec3d normal{part.lean[k][0], part.lean[k][1], part.cosine[k]};
            ideal.height[k] = reach.lowest_over({q.grid.x(i, j), q.grid.y(i, j), part.z[k]}, normal,
                                                q.cut[k] - *q.scallop / part.cosine[k]);
        }
    });
    return static_cast<std::size_t>(std::count_if(places.begin(), places.end(), [&](std::size_t k) {
        return (q.cut[k] - ideal.height[k]) * part.cosine[k] > *q.scallop;
    }));
}

// If there are many doubtful points, some are settled first: they detect a grossly uncut floor. The
// other points then keep the grid's heights.
void settle_doubts(const FloorQuestion& q,
                   const PartHeights& part,
                   const std::vector<double>& clear,
                   Ideal& ideal)
{
    constexpr std::size_t kMany = 40000;
    constexpr std::size_t kFirst = 10000;
    constexpr double kGrosslyUncut = 0.1;  // of the floor: ten times the allowed share
    std::vector<std::size_t> places = doubtful_places(q, part, clear);
    if (places.size() <= kMany) {
        settle(q, part, places, ideal);
        return;
    }
    const std::size_t each = places.size() / kFirst;
    std::vector<std::size_t> first;
    std::vector<std::size_t> rest;
    for (std::size_t n = 0; n < places.size(); ++n) {
        (n % each == 0 ? first : rest).push_back(places[n]);
    }
    const double open = static_cast<double>(settle(q, part, first, ideal));
    const double floor = static_cast<double>(
        std::count_if(part.z.begin(), part.z.end(), [](double z) { return std::isfinite(z); }));
    if (open * static_cast<double>(each) <= kGrosslyUncut * floor) {
        settle(q, part, rest, ideal);
    }
}

// Finds the thickest stock above the surface that the tools can cut.
void find_thickest(const FloorQuestion& q,
                   const Ideal& ideal,
                   const std::vector<double>& clear,
                   const std::vector<double>& left,
                   VerifyFigures& figures)
{
    struct High {
        std::size_t k;
        double over;  // mm, along the axis
    };
    std::vector<High> all;
    const double radius = least_radius(q.tools);
    for (std::size_t k = 0; k < left.size(); ++k) {
        if (left[k] > q.most_left && clear[k] >= radius) {
            all.push_back({k, std::min(q.cut[k], q.top) - ideal.height[k]});
        }
    }
    std::sort(all.begin(), all.end(), [](const High& a, const High& b) { return a.over > b.over; });
    const ResidualThickness residual{q.runs, q.top};
    double most = q.most_left;
    for (const High& high : all) {
        if (high.over <= most) {
            break;
        }
        const Vec3d place{q.grid.x(high.k / q.grid.ny, high.k % q.grid.ny),
                          q.grid.y(high.k / q.grid.ny, high.k % q.grid.ny), ideal.height[high.k]};
        const double thick = residual.at(place, high.over, most);
        if (thick > most) {
            most = thick;
            figures.thickest_left = ThickestLeft{thick, place};
        }
    }
}

struct Sums {
    std::size_t part{};
    std::size_t owed{};
    std::size_t cells{};  // that are judged
    std::size_t unreachable{};
    std::size_t uncovered{};
    std::size_t highest{};  // the point with most left, of those
    double total{};
    std::vector<std::size_t> seen;  // points where some stock was cut
};

// mm square to the part: what the program, not one before it, cut away below it.
double cut_below(const FloorQuestion& q, const PartHeights& part, std::size_t k)
{
    const double stood = q.stock.height(k);
    return q.cut[k] < stood ? std::max(0.0, std::min(part.z[k], stood) - q.cut[k]) * part.cosine[k]
                            : 0.0;
}

void add_uncovered(const std::vector<double>& left, std::size_t k, Sums& sums)
{
    sums.highest = sums.uncovered == 0 || left[k] > left[sums.highest] ? k : sums.highest;
    ++sums.uncovered;
}

// mm from the stock's top at a point to what no tool can cut, by columns around the point that are
// nearer together than the grid's: an eighth of the distance, which is too high by no more.
//
// distance    mm: as stock_distance() has it
// sufficient  mm: results up to this may be too high
double fine_distance(ToolAccess& reach, Vec3d top, double distance, double sufficient)
{
    constexpr int kColumns = 8;      // in each direction
    constexpr double kNearer = 0.9;  // a round that gains less is the last
    std::vector<Vec2d> around;       // in distances
    for (int i = -kColumns; i <= kColumns; ++i) {
        for (int j = -kColumns; j <= kColumns; ++j) {
            around.push_back(
                {static_cast<double>(i) / kColumns, static_cast<double>(j) / kColumns});
        }
    }
    std::stable_sort(around.begin(), around.end(), [](Vec2d a, Vec2d b) {
        return elementary::hypot(a.x, a.y) < elementary::hypot(b.x, b.y);
    });
    double least = distance;
    double before = kInfinite;
    while (least > sufficient && least < kNearer * before) {
        before = least;
        for (const Vec2d at : around) {
            const double out = before * elementary::hypot(at.x, at.y);
            if (out >= least || least <= sufficient) {
                break;
            }
            const Vec3d place{top.x + before * at.x, top.y + before * at.y, top.z - before};
            const double height = reach.lowest_over(place, {0, 0, 1}, top.z);
            least = std::min(least, elementary::hypot(out, std::max(0.0, top.z - height)));
        }
    }
    return least;
}

// The greatest distance of the stock's top from the material that stays, of points in falling order
// of their height along the normal. If the columns of the grid say more than the bound, nearer ones
// are asked.
double highest_scallop(const FloorQuestion& q,
                       const std::vector<double>& floor,
                       const Ideal& ideal,
                       const std::vector<double>& left,
                       const std::vector<std::size_t>& falling)
{
    const FloorSamples samples{q.grid, floor};
    ToolAccess reach{q.surfaces, q.mesh, q.tools, q.walls, samples, 0.0};
    double most = std::min(left[falling.front()], 0.0);
    for (const std::size_t k : falling) {
        if (left[k] <= most) {
            break;
        }
        const Vec3d top{q.grid.x(k / q.grid.ny, k % q.grid.ny),
                        q.grid.y(k / q.grid.ny, k % q.grid.ny), std::min(q.cut[k], q.top)};
        const double distance = stock_distance(q.grid, ideal.height, k, top.z, left[k], most);
        const double sufficient = std::max(most, q.scallop.value_or(kInfinite));
        most =
            std::max(most, distance > sufficient ? fine_distance(reach, top, distance, sufficient)
                                                 : distance);
    }
    return most;
}

void fill_figures(const FloorQuestion& q,
                  const std::vector<double>& floor,
                  const Ideal& ideal,
                  const std::vector<double>& left,
                  const Sums& sums,
                  VerifyFigures& figures)
{
    const auto share = [](std::size_t part, std::size_t whole) {
        return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
    };
    const std::size_t cells = sums.cells;
    figures.cells = cells;
    figures.unreachable_share = share(sums.unreachable, sums.part);
    // Slopes and heights may leave nothing that is owed; ground that is owed and can't be judged is open.
    const double without_cells = sums.part > 0 && sums.owed == 0 ? 0.0 : 1.0;
    figures.uncut_share = cells > 0 ? 1 - share(sums.seen.size(), cells) : without_cells;
    figures.uncovered_share = cells > 0 ? share(sums.uncovered, cells) : without_cells;
    if (sums.uncovered > 0) {
        const std::size_t k = sums.highest;
        figures.uncovered_at =
            FaultPlace{{q.grid.x(k / q.grid.ny, k % q.grid.ny),
                        q.grid.y(k / q.grid.ny, k % q.grid.ny), std::min(q.cut[k], q.top)}};
    }
    if (sums.seen.empty()) {
        return;
    }
    std::vector<std::size_t> falling = sums.seen;
    std::sort(falling.begin(), falling.end(),
              [&](std::size_t a, std::size_t b) { return left[a] > left[b]; });
    figures.scallop_max = highest_scallop(q, floor, ideal, left, falling);
    const std::size_t last = falling.size() - 1;
    const double place = 0.99 * static_cast<double>(last);
    const auto low = static_cast<std::size_t>(place);
    const double rest = place - static_cast<double>(low);
    const double below = left[falling[last - low]];
    const double above = left[falling[last - std::min(low + 1, last)]];
    figures.scallop_p99 = std::min(below + rest * (above - below), figures.scallop_max);
    figures.scallop_mean = sums.total / static_cast<double>(falling.size());
}

// mm: distance of each point from the walls.
std::vector<double> wall_clearances(const FloorQuestion& q)
{
    std::vector<double> clear(q.grid.size(), kInfinite);
    for_each_band(q.grid.nx, [&](std::size_t begin, std::size_t end, std::size_t) {
        for (std::size_t i = begin; i < end && !q.walls.empty(); ++i) {
            for (std::size_t j = 0; j < q.grid.ny; ++j) {
                clear[q.grid.index(i, j)] = q.walls.at(q.grid.x(i, j), q.grid.y(i, j));
            }
        }
    });
    return clear;
}

// Beyond walls the part's height is the stock's top.
void fill_beyond_walls(const FloorQuestion& q, const std::vector<double>& clear, PartHeights& part)
{
    for (std::size_t k = 0; k < q.grid.size(); ++k) {
        if (clear[k] < 0) {
            part.z[k] = q.top;
        }
    }
}

}  // namespace

FloorMaps judge_floor(const FloorQuestion& q, VerifyFigures& figures)
{
    PartHeights part = part_heights(q.surfaces, q.mesh, q.grid);
    Ideal ideal = ideal_heights(q, part);
    const double radius = least_radius(q.tools);
    const double bound = q.scallop.value_or(kInfinite);
    std::vector<double> left(q.grid.size(), kNoValue);
    std::vector<double> gouge(q.grid.size(), 0.0);
    const std::vector<double> clear = wall_clearances(q);
    if (q.scallop) {
        settle_doubts(q, part, clear, ideal);
    }
    Sums sums;
    double wall_left = -kInfinite;
    for (std::size_t k = 0; k < q.grid.size(); ++k) {
        if (!std::isfinite(part.z[k]) || std::isnan(q.cut[k])) {
            continue;
        }
        ++sums.part;
        const bool touched = q.cut[k] < q.top;
        const double below = cut_below(q, part, k);
        figures.gouge_max = std::max(figures.gouge_max, below);
        gouge[k] = clear[k] >= 0 ? below : 0.0;
        const bool reached = clear[k] >= radius;
        sums.unreachable += reached && ideal.unfit[k] != 0 ? 1U : 0U;
        const bool owed = is_owed(q, part, k);
        sums.owed += owed ? 1U : 0U;
        if (!std::isfinite(ideal.height[k]) || !(clear[k] >= 0) || !owed) {
            continue;
        }
        // uncut stock within the bound needs no cut
        const bool done =
            touched || (q.top - ideal.height[k]) * part.cosine[k] <= q.scallop.value_or(kFlush);
        left[k] = done ? (q.cut[k] - ideal.height[k]) * part.cosine[k] : kInfinite;
        if (!reached) {
            wall_left = std::max(wall_left, left[k]);
            continue;
        }
        ++sums.cells;
        if (!(left[k] <= bound)) {
            add_uncovered(left, k, sums);
        }
        if (done) {
            sums.seen.push_back(k);
            sums.total += left[k];
            figures.left_volume +=
                std::max(0.0, q.cut[k] - part.z[k]) * q.grid.pitch * q.grid.pitch;
        }
    }
    if (!q.walls.empty() && wall_left > -kInfinite) {
        figures.wall_left_max = wall_left;
    }
    figures.scallop_bound = q.scallop;
    if (q.scallop) {
        find_thickest(q, ideal, clear, left, figures);
    }
    fill_figures(q, part.z, ideal, left, sums, figures);
    fill_beyond_walls(q, clear, part);
    return {std::move(left), std::move(gouge), std::move(part.z)};
}

}  // namespace cusp::verify
