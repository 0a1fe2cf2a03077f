// Each thread cuts its own band of columns along the whole path.
#include "host_tools/judge/verify/machined_stock.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <tuple>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/judge/verify/ahead.hpp"
#include "host_tools/judge/verify/bands.hpp"
#include "host_tools/judge/verify/cut_rows.hpp"
#include "host_tools/judge/verify/end_sweeps.hpp"
#include "host_tools/judge/verify/engagement_trace.hpp"
#include "host_tools/judge/verify/tool_contact.hpp"

namespace cusp::verify {

using toolpath::Tool;

namespace {

bool is_cylindrical(const Tool& tool)
{
    return flat_radius(tool) >= tool.radius && !is_conical(tool);
}

// Behind the last position of the rapid move that begins at a position.
std::size_t end_of_move(const ToolPositions& positions, std::size_t k)
{
    std::size_t end = k + 1;
    while (end < positions.tips.size() && positions.rapid[end] &&
           (positions.lines.empty() || positions.lines[end] == positions.lines[k])) {
        ++end;
    }
    return end;
}

// One of each move: bands see different parts of it.
std::vector<DeepRapid> joined(const std::vector<CutFigures>& bands)
{
    std::map<std::size_t, DeepRapid> by_end;
    for (const CutFigures& band : bands) {
        for (const DeepRapid& rapid : band.deep_rapids) {
            const auto [found, is_new] = by_end.try_emplace(rapid.end, rapid);
            DeepRapid& known = found->second;
            known.end_depth = std::max(known.end_depth, rapid.end_depth);
            if (std::tie(known.depth, rapid.position) < std::tie(rapid.depth, known.position)) {
                known.depth = rapid.depth;
                known.position = rapid.position;
            }
        }
    }
    std::vector<DeepRapid> out;
    for (const auto& [end, rapid] : by_end) {
        out.push_back(rapid);
    }
    return out;
}

}  // namespace

const DeepRapid* CutFigures::deepest_rapid() const
{
    const auto found =
        std::max_element(deep_rapids.begin(), deep_rapids.end(),
                         [](const DeepRapid& a, const DeepRapid& b) { return a.depth < b.depth; });
    return found == deep_rapids.end() ? nullptr : &*found;
}

MachinedStock::MachinedStock(const HeightGrid& grid, double top)
    : grid_{grid}, top_{top}, heights_(grid.size(), top), row_x_(grid.ny), row_y_(grid.ny)
{
    for (std::size_t j = 0; j < grid.ny; ++j) {
        row_x_[j] = grid.shift(j);
        row_y_[j] = grid.y0 + static_cast<double>(j) * grid.pitch;
    }
}

CutFigures MachinedStock::cut_band(const ToolPositions& positions,
                                   double spacing,
                                   EngagementTrace* trace,
                                   ContactTrace* contact,
                                   std::size_t band,
                                   std::size_t begin,
                                   std::size_t end)
{
    const Tool& tool = positions.tool;
    const double shrink = spacing * spacing / (4 * tool.radius) + 0.002;
    // Tools with round corners leave no more between positions than the square of their distance.
    const bool edged = flat_radius(tool) > 0 && tool.corner_radius < spacing;
    CutFigures figures;
    std::size_t measured = 0;  // rapid positions before this one are
    for (std::size_t k = 0; k < positions.tips.size(); ++k) {
        if (positions.rapid[k] && k >= measured) {
            measured = end_of_move(positions, k);
            const DeepRapid rapid = deepest_of(positions, k, measured, shrink, begin, end);
            figures.rapid_cut = std::max(figures.rapid_cut, rapid.depth);
            if (rapid.depth > kRapidCutAllowed) {
                figures.deep_rapids.push_back(rapid);
            }
        }
        const Vec3d tip = positions.tips[k];
        const bool ends_alone = rapids_ == RapidCut::kAtEnd;
        const bool is_passed = ends_alone && k + 1 < measured;  // on the way to a rapid's end
        if (tip.z >= top_ || is_passed || !is_looked_at(tool, tip)) {
            continue;
        }
        if (trace != nullptr) {
            trace->look(heights_, k, band, begin, end);
        }
        if (contact != nullptr) {
            contact->look(heights_, k, band, begin, end);
        }
        const bool from_here = !ends_alone || !positions.rapid[k];
        const bool goes_on = from_here && k > 0;
        const double depth =
            cut_at(tool, tip, shrink, goes_on ? &positions.tips[k - 1] : nullptr, begin, end);
        if (trace != nullptr && depth > 0) {
            trace->add_cut(k, band);
        }
        if (edged && from_here && k > 0 && positions.tips[k - 1].z < top_) {
            sweep_flat(tool, positions.tips[k - 1], tip, begin, end);
        }
        if (is_conical(tool) && from_here && k > 0 && positions.tips[k - 1].z < top_) {
            sweep_cone(tool, positions.tips[k - 1], tip, begin, end);
        }
        if (!positions.rapid[k]) {
            figures.cut_depth = std::max(figures.cut_depth, depth);
        }
    }
    return figures;
}

DeepRapid MachinedStock::deepest_of(const ToolPositions& positions,
                                    std::size_t first,
                                    std::size_t last,
                                    double shrink,
                                    std::size_t begin,
                                    std::size_t end) const
{
    bool is_empty = first > 0 && !positions.rapid[first - 1];  // what it has cut
    DeepRapid deepest{last - 1, first, 0, 0};
    for (std::size_t k = first; k < last; ++k) {
        if (positions.tips[k].z >= top_) {
            is_empty = true;
            continue;
        }
        const double depth = depth_at(positions.tool, positions.tips[k], shrink,
                                      is_empty ? &positions.tips[k - 1] : nullptr, begin, end);
        is_empty = depth <= 0;
        if (depth > deepest.depth) {
            deepest.position = k;
            deepest.depth = depth;
        }
        deepest.end_depth = k + 1 == last ? depth : 0.0;
    }
    return deepest;
}

double MachinedStock::depth_at(const Tool& tool,
                               Vec3d tip,
                               double shrink,
                               const Vec3d* before,
                               std::size_t begin,
                               std::size_t end) const
{
    const Profile probe{tool, shrink};
    const double bottom = tip.z + shrink;
    double deepest = 0;
    visit_disc(tool, tip, probe.reach, before, begin, end, [&](const DiscColumn& column) {
        const double* height = heights_.data() + column.index * grid_.ny;
        for (std::size_t j0 = column.first; j0 < column.last; j0 += kRun) {
            const std::size_t j1 = std::min(column.last, j0 + kRun);
            const bool is_over = highest_of(height, j0, j1) - bottom > deepest;
            for (std::size_t j = is_over ? j0 : j1; j < j1; ++j) {
                if (height[j] - bottom > deepest) {
                    const double squared = column.squared(j);
                    deepest = squared <= probe.reach
                                  ? std::max(deepest, height[j] - bottom - probe.at(squared))
                                  : deepest;
                }
            }
        }
    });
    if (tool.corner_radius > 0 || is_conical(tool)) {
        deepest = std::max(deepest, level_around(tip.x, tip.y, begin, end) - bottom);
    }
    // The height by which the tool was raised is in stock too.
    return deepest > kRapidCutAllowed ? deepest + shrink : deepest;
}

double MachinedStock::level_around(double x, double y, std::size_t begin, std::size_t end) const
{
    constexpr double kLevel = 0.01;  // mm
    // Several points at all sides, so that a groove of a vee is never level. Other bands are cut at the same time:
    // the one with both columns beside the place looks at its own.
    const auto [left, right] = columns_beside(x);
    if (left < begin || right >= end) {
        return -kUnbounded;
    }
    const double reach = 2 * grid_.pitch;
    const std::size_t first = std::max(begin, grid_.first_column(x - reach));
    const std::size_t last = std::min(end, grid_.end_column(x + reach));
    double least = kUnbounded;
    double most = -kUnbounded;
    for (std::size_t i = first; i < last; ++i) {
        for (std::size_t j = grid_.first_row(y - reach); j < grid_.end_row(y + reach); ++j) {
            least = std::min(least, heights_[grid_.index(i, j)]);
            most = std::max(most, heights_[grid_.index(i, j)]);
        }
    }
    return least <= most && most - least <= kLevel ? least : -kUnbounded;
}

std::pair<std::size_t, std::size_t> MachinedStock::columns_beside(double x) const
{
    const double column = std::floor((x - grid_.x0) / grid_.pitch);
    const auto last = static_cast<double>(grid_.nx - 1);
    return {static_cast<std::size_t>(std::clamp(column, 0.0, last)),
            static_cast<std::size_t>(std::clamp(column + 1, 0.0, last))};
}

std::vector<std::size_t> MachinedStock::bands_of(const ToolPositions& positions) const
{
    std::vector<bool> parts(grid_.nx + 1,
                            false);  // columns beside a place: those before from this one
    const bool is_pointed = positions.tool.corner_radius > 0 || is_conical(positions.tool);
    for (std::size_t k = 0; is_pointed && k < positions.tips.size(); ++k) {
        if (positions.rapid[k] && positions.tips[k].z < top_) {
            parts[columns_beside(positions.tips[k].x).second] = true;
        }
    }
    std::vector<std::size_t> ends;
    for (std::size_t band = 1; band < kBands; ++band) {
        const std::size_t wanted = grid_.nx * band / kBands;
        const std::size_t before = ends.empty() ? 0 : ends.back();
        std::size_t end = before;  // an empty band, where every place parts two columns
        for (std::size_t away = 0; away <= grid_.nx / (2 * kBands) && end == before; ++away) {
            end = !parts[wanted + away] ? wanted + away : end;
            end = !parts[wanted - away] && wanted - away >= before ? wanted - away : end;
        }
        ends.push_back(end);
    }
    ends.push_back(grid_.nx);
    return ends;
}

bool MachinedStock::look_at_rapids_alone(const std::vector<ToolPositions>& runs, RapidCut rapids)
{
    rapids_ = rapids;
    bool any = false;
    // Each box of points adds 1 at one corner and takes it away behind the others; sums fill it.
    std::vector<std::int32_t> corners((grid_.nx + 1) * (grid_.ny + 1), 0);
    const auto corner = [&](std::size_t i, std::size_t j) -> std::int32_t& {
        return corners[i * (grid_.ny + 1) + j];
    };
    for (const ToolPositions& run : runs) {
        for (std::size_t k = 0; k < run.tips.size(); ++k) {
            const Vec3d tip = run.tips[k];
            if (!run.rapid[k] || tip.z >= top_) {
                continue;
            }
            any = true;
            const std::size_t i0 = grid_.first_column(tip.x - run.tool.radius);
            const std::size_t i1 = grid_.end_column(tip.x + run.tool.radius);
            const std::size_t j0 = grid_.first_row(tip.y - run.tool.radius);
            const std::size_t j1 = grid_.end_row(tip.y + run.tool.radius);
            ++corner(i0, j0);
            --corner(i1, j0);
            --corner(i0, j1);
            ++corner(i1, j1);
        }
    }
    looked_at_.assign(any ? corners.size() : 0, 0);
    for (std::size_t i = 0; any && i < grid_.nx; ++i) {
        for (std::size_t j = 0; j < grid_.ny; ++j) {
            if (i > 0) {
                corner(i, j) += corner(i - 1, j);
            }
        }
    }
    for (std::size_t i = 0; any && i < grid_.nx; ++i) {
        std::int32_t boxes = 0;
        std::uint32_t count = 0;
        for (std::size_t j = 0; j < grid_.ny; ++j) {
            boxes += corner(i, j);
            count += boxes > 0 ? 1U : 0U;
            looked_at_[(i + 1) * (grid_.ny + 1) + j + 1] =
                looked_at_[i * (grid_.ny + 1) + j + 1] + count;
        }
    }
    return any;
}

bool MachinedStock::is_looked_at(const Tool& tool, Vec3d tip) const
{
    if (looked_at_.empty()) {
        return true;
    }
    const auto sum = [&](std::size_t i, std::size_t j) {
        return looked_at_[i * (grid_.ny + 1) + j];
    };
    // with the sweep from the position before
    const double reach = tool.radius + 2 * grid_.pitch;
    const std::size_t i0 = grid_.first_column(tip.x - reach);
    const std::size_t i1 = grid_.end_column(tip.x + reach);
    const std::size_t j0 = grid_.first_row(tip.y - reach);
    const std::size_t j1 = grid_.end_row(tip.y + reach);
    return i0 < i1 && j0 < j1 && sum(i1, j1) - sum(i0, j1) - sum(i1, j0) + sum(i0, j0) > 0;
}

template <class Visit>
void MachinedStock::visit_disc(const Tool& tool,
                               Vec3d tip,
                               double reach,
                               const Vec3d* before,
                               std::size_t begin,
                               std::size_t end,
                               Visit visit) const
{
    const double max_error = grid_.pitch / 2;
    const GridRows rows{grid_};
    const Ahead ahead{tool, tip, before, grid_};
    const bool leaves_disc = before != nullptr && is_cylindrical(tool) && before->z <= tip.z;
    const std::size_t last = std::min(end, grid_.end_column(tip.x + tool.radius));
    for (std::size_t i = std::max(begin, grid_.first_column(tip.x - tool.radius)); i < last; ++i) {
        const double x = grid_.x0 + static_cast<double>(i) * grid_.pitch;
        DiscColumn column{i, 0, 0, x - tip.x, grid_.shift(i) - tip.y, row_x_.data(), row_y_.data()};
        const double half = half_chord(reach, std::max(0.0, std::abs(column.x) - max_error));
        column.first = rows.first(tip.y - half);
        column.last = rows.end(tip.y + half);
        ahead.narrow(rows, column.x, column.first, column.last);
        if (!leaves_disc) {
            visit(column);
            continue;
        }
        const double inner = half_chord(reach, std::abs(x - before->x) + max_error);
        const std::size_t done = rows.end(before->y - inner);
        const std::size_t open = std::max(done, rows.first(before->y + inner));
        DiscColumn above = column;
        column.last = std::min(done, column.last);
        above.first = std::max(open, above.first);
        visit(column);
        visit(above);
    }
}

double MachinedStock::cut_at(const Tool& tool,
                             Vec3d tip,
                             double shrink,
                             const Vec3d* before,
                             std::size_t begin,
                             std::size_t end)
{
    const Cutter cutter{tip.z, shrink, Profile{tool, 0}, Profile{tool, shrink}};
    const bool is_flat = is_cylindrical(tool);
    double deepest = 0;
    visit_disc(tool, tip, cutter.profile.reach, before, begin, end, [&](const DiscColumn& column) {
        double* heights = heights_.data() + column.index * grid_.ny;
        deepest = is_flat ? cut_rows_flat(cutter, column, heights, deepest)
                          : cut_rows(cutter, column, heights, deepest);
    });
    return deepest;
}

// Both end positions are cut: of a level way, all but two slivers at its sides.
void MachinedStock::sweep_flat(
    const Tool& tool, Vec3d from, Vec3d to, std::size_t begin, std::size_t end)
{
    const double radius = flat_radius(tool);
    if (from.z != to.z) {
        sweep_slope(radius, from, to, begin, end);
        return;
    }
    const FlatSweep sweep{from, to, radius};
    const Vec2d way = in_plan(to) - in_plan(from);
    const double length = norm(way);
    const double near = half_chord(radius * radius, length / 2);
    for (const double side : {-1 / length, 1 / length}) {
        const Vec2d across = length > 0 ? Vec2d{-way.y, way.x} * side : Vec2d{};
        const auto [x_low, x_high] =
            std::minmax({from.x + across.x * near, from.x + across.x * radius,
                         to.x + across.x * near, to.x + across.x * radius});
        const auto [y_low, y_high] =
            std::minmax({from.y + across.y * near, from.y + across.y * radius,
                         to.y + across.y * near, to.y + across.y * radius});
        const std::size_t first = grid_.first_row(y_low);
        const std::size_t stop = grid_.end_row(y_high);
        const std::size_t last = std::min(end, grid_.end_column(x_high));
        for (std::size_t i = std::max(begin, grid_.first_column(x_low)); i < last; ++i) {
            sweep_rows(sweep, from.z, i, first, stop);
        }
    }
}

// Only a crescent beside the lower of the two end positions is still uncut.
void MachinedStock::sweep_slope(
    double radius, Vec3d from, Vec3d to, std::size_t begin, std::size_t end)
{
    const double squared = radius * radius;
    const double max_error = grid_.pitch / 2;
    const FlatSweep sweep{from, to, radius};
    const GridRows rows{grid_};
    const Vec3d lower = from.z < to.z ? from : to;
    const auto [x_low, x_high] = std::minmax(from.x, to.x);
    const auto [y_low, y_high] = std::minmax(from.y, to.y);
    const std::size_t last = std::min(end, grid_.end_column(x_high + radius));
    for (std::size_t i = std::max(begin, grid_.first_column(x_low - radius)); i < last; ++i) {
        const double x = grid_.x0 + static_cast<double>(i) * grid_.pitch;
        const double outer =
            half_chord(squared, std::max({0.0, x_low - x - max_error, x - x_high - max_error}));
        const double inner = half_chord(squared, std::abs(x - lower.x) + max_error);
        const std::size_t high = rows.end(y_high + outer);
        const std::size_t done = rows.end(lower.y - inner);
        const std::size_t open = std::max(done, rows.first(lower.y + inner));
        sweep_rows(sweep, lower.z, i, rows.first(y_low - outer), std::min(done, high));
        sweep_rows(sweep, lower.z, i, open, high);
    }
}

void MachinedStock::sweep_rows(
    const FlatSweep& sweep, double low, std::size_t i, std::size_t first, std::size_t stop)
{
    const double x = grid_.x0 + static_cast<double>(i) * grid_.pitch;
    const double shift = grid_.shift(i);
    double* heights = heights_.data() + i * grid_.ny;
    for (std::size_t j = first; j < stop; ++j) {
        if (heights[j] > low) {
            heights[j] = std::min(heights[j], sweep.lowest(x + row_x_[j], row_y_[j] + shift));
        }
    }
}

// Exact on straight moves: where a cone goes down or up, a point is cut lowest from a position ahead of the nearest.
void MachinedStock::sweep_cone(
    const Tool& tool, Vec3d from, Vec3d to, std::size_t begin, std::size_t end)
{
    const double rise = 1 / elementary::tan(tool.tip_angle / 2);
    const double reach = std::min(
        tool.radius, tool.tip_radius + tool.corner_radius + (top_ - std::min(from.z, to.z)) / rise);
    const ConeSweep sweep{tool, from, to};
    const auto [x_low, x_high] = std::minmax(from.x, to.x);
    const auto [y_low, y_high] = std::minmax(from.y, to.y);
    const std::size_t last = std::min(end, grid_.end_column(x_high + reach));
    for (std::size_t i = std::max(begin, grid_.first_column(x_low - reach)); i < last; ++i) {
        for (std::size_t j = grid_.first_row(y_low - reach); j < grid_.end_row(y_high + reach);
             ++j) {
            double& height = heights_[grid_.index(i, j)];
            height = std::min(height, sweep.lowest(grid_.x(i, j), grid_.y(i, j)));
        }
    }
}

CutFigures MachinedStock::cut(const ToolPositions& positions,
                              double spacing,
                              const Progress& progress,
                              EngagementTrace* trace,
                              ContactTrace* contact)
{
    std::vector<CutFigures> bands(kBands);
    std::mutex guard;
    std::size_t done = 0;
    const std::vector<std::size_t> ends = bands_of(positions);
    parallel::for_each(kBands, [&](std::size_t band) {
        const std::size_t begin = band == 0 ? 0 : ends[band - 1];
        bands[band] = cut_band(positions, spacing, trace, contact, band, begin, ends[band]);
        const std::lock_guard lock{guard};
        progress(static_cast<double>(++done) / static_cast<double>(kBands));
    });
    CutFigures sum;
    sum.deep_rapids = joined(bands);
    for (const CutFigures& band : bands) {
        sum.rapid_cut = std::max(sum.rapid_cut, band.rapid_cut);
        sum.cut_depth = std::max(sum.cut_depth, band.cut_depth);
    }
    return sum;
}

double MachinedStock::removed_volume() const
{
    double depths = 0;
    for (const double height : heights_) {
        depths += height > -kUnbounded ? top_ - height : 0.0;
    }
    return depths * grid_.pitch * grid_.pitch;
}

}  // namespace cusp::verify
