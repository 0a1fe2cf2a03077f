// Each thread cuts its own band of columns along the whole path.
#include "host_tools/judge/verify/machined_stock.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

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

}  // namespace

MachinedStock::MachinedStock(const HeightGrid& grid, double top)
    : grid_{grid}, top_{top}, heights_(grid.size(), top), row_x_(grid.ny), row_y_(grid.ny)
{
    for (std::size_t j = 0; j < grid.ny; ++j) {
        row_x_[j] = grid.shift(j);
        row_y_[j] = grid.y0 + static_cast<double>(j) * grid.pitch;
    }
}

double MachinedStock::cut_band(const ToolPositions& positions,
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
    double deepest = 0;
    for (std::size_t k = 0; k < positions.tips.size(); ++k) {
        const Vec3d tip = positions.tips[k];
        if (tip.z >= top_) {
            continue;
        }
        if (trace != nullptr) {
            trace->look(heights_, k, band, begin, end);
        }
        if (contact != nullptr) {
            contact->look(heights_, k, band, begin, end);
        }
        const double depth =
            cut_at(tool, tip, shrink, k > 0 ? &positions.tips[k - 1] : nullptr, begin, end);
        if (trace != nullptr && depth > 0) {
            trace->add_cut(k, band);
        }
        if (edged && k > 0 && positions.tips[k - 1].z < top_) {
            sweep_flat(tool, positions.tips[k - 1], tip, begin, end);
        }
        if (is_conical(tool) && k > 0 && positions.tips[k - 1].z < top_) {
            sweep_cone(tool, positions.tips[k - 1], tip, begin, end);
        }
        if (!positions.rapid[k]) {
            deepest = std::max(deepest, depth);
        }
    }
    return deepest;
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

double MachinedStock::cut(const ToolPositions& positions,
                          double spacing,
                          const Progress& progress,
                          EngagementTrace* trace,
                          ContactTrace* contact)
{
    std::vector<double> deepest(kBands);
    std::mutex guard;
    std::size_t done = 0;
    for_each_band(grid_.nx, [&](std::size_t begin, std::size_t end, std::size_t band) {
        deepest[band] = cut_band(positions, spacing, trace, contact, band, begin, end);
        const std::lock_guard lock{guard};
        progress(static_cast<double>(++done) / static_cast<double>(kBands));
    });
    return *std::max_element(deepest.begin(), deepest.end());
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
