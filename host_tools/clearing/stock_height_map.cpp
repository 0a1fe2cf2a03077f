// Each sampled position lowers the points under the tool to its lower side.
#include "host_tools/clearing/stock_height_map.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::clearing {

using offset::Box2d;
using toolpath::Tool;

namespace {

constexpr double kSpacingShare = 1.0 / 10;  // of the radius
constexpr double kMostPlaces = 4e6;
constexpr double kLeastSliver = 2e-3;  // mm
constexpr double kHeights = 256;       // of the tool's lower side
constexpr double kLevel = 1e-9;        // mm: rounding of a level move's heights

}  // namespace

double StockHeightMap::Profile::at(double squared) const
{
    if (flat == 0.0) {
        return corner - std::sqrt(std::max(0.0, corner * corner - squared));
    }
    const double beyond = std::max(0.0, std::sqrt(squared) - flat);
    return corner - std::sqrt(std::max(0.0, corner * corner - beyond * beyond));
}

StockHeightMap::StockHeightMap(const Box2d& box, const Tool& tool, double top, double share)
    : origin_{box.x0, box.y0},
      pitch_{std::max(tool.radius * share,
                      std::sqrt((box.x1 - box.x0) * (box.y1 - box.y0) / kMostPlaces))},
      columns_{static_cast<std::size_t>((box.x1 - box.x0) / pitch_) + 1},
      rows_{static_cast<std::size_t>((box.y1 - box.y0) / pitch_) + 1},
      top_{top},
      heights_(columns_ * rows_, static_cast<float>(top))
{
    set_tool(tool);
}

void StockHeightMap::set_tool(const Tool& tool)
{
    last_.reset();
    spacing_ = tool.radius * kSpacingShare;
    sliver_ = spacing_ * spacing_ / (4 * tool.radius) + kLeastSliver;
    tool_ = {tool.radius - tool.corner_radius, tool.corner_radius, tool.radius * tool.radius};
    const double radius = tool.radius - sliver_;
    const double corner = std::max(0.0, tool.corner_radius - sliver_);
    probe_profile_ = {radius - corner, corner, radius * radius};
    for (std::size_t i = 0; i < at_least_.size(); ++i) {
        at_least_[i] = tool_.at(tool_.reach * static_cast<double>(i) / kHeights);
    }
}

StockHeightMap::Range StockHeightMap::range(double low, double high, const Axis& axis)
{
    const auto place = [&](double at) {
        return static_cast<std::size_t>(
            std::clamp((at - axis.origin) / axis.pitch, 0.0, static_cast<double>(axis.count)));
    };
    return {place(low), std::min(place(high) + 1, axis.count)};
}

double StockHeightMap::contact_height(Vec2d at, double share) const
{
    const double reach = share * std::sqrt(probe_profile_.reach);
    const Range columns = range(at.x - reach, at.x + reach, column_axis());
    const Range rows = range(at.y - reach, at.y + reach, row_axis());
    double highest = -kUnbounded;
    for (std::size_t i = columns.begin; i < columns.end; ++i) {
        const double dx = origin_.x + static_cast<double>(i) * pitch_ - at.x;
        const float* heights = heights_.data() + i * rows_;
        for (std::size_t j = rows.begin; j < rows.end; ++j) {
            const double dy = origin_.y + static_cast<double>(j) * pitch_ - at.y;
            const double squared = dx * dx + dy * dy;
            const double z = static_cast<double>(heights[j]) - probe_profile_.at(squared);
            highest = squared <= reach * reach && z > highest ? z : highest;
        }
    }
    return highest - sliver_;
}

void StockHeightMap::cut_column(std::size_t column,
                                Range rows,
                                const Position& position,
                                double& deepest)
{
    const Vec3d tip = position.tip;
    const Profile& taken = position.shrunk ? probe_profile_ : tool_;
    const double scale = kHeights / tool_.reach;
    const double dx = origin_.x + static_cast<double>(column) * pitch_ - tip.x;
    float* heights = heights_.data() + column * rows_;
    for (std::size_t j = rows.begin; j < rows.end; ++j) {
        const double dy = origin_.y + static_cast<double>(j) * pitch_ - tip.y;
        const double squared = dx * dx + dy * dy;
        const double over = static_cast<double>(heights[j]) - tip.z;
        if (squared > taken.reach) {
            continue;
        }
        const double at_least = at_least_[static_cast<std::size_t>(squared * scale)];
        if (over <= at_least) {
            continue;
        }
        if (over - sliver_ - at_least > deepest && squared <= probe_profile_.reach) {
            deepest = std::max(deepest, over - sliver_ - probe_profile_.at(squared));
        }
        const double left = taken.at(squared);
        if (left < over) {
            if (on_trial_) {
                lowered_.push_back({column * rows_ + j, heights[j]});
            }
            heights[j] = static_cast<float>(tip.z + left);
        }
    }
}

// The rows of a column where the tool may be lower than before. With q the squared distance from
// the tip, a ball's lower side R - sqrt(R^2 - q) rises by at least (q' - q) / 2R from q to q' > q:
// points whose q has grown by 2R times the tool's descent are no lower. A descending flat end is
// lower everywhere.
StockHeightMap::Range StockHeightMap::maybe_lower(double x, Range rows, Vec3d tip) const
{
    const Vec2d way{tip.x - last_->tip.x, tip.y - last_->tip.y};
    const Vec2d middle{last_->tip.x + 0.5 * way.x, last_->tip.y + 0.5 * way.y};
    const double down = last_->tip.z - tip.z;
    if (tool_.flat > 0.0 && down > kLevel) {
        return rows;
    }
    const double ahead = (x - middle.x) * way.x + std::sqrt(tool_.reach) * std::max(0.0, down);
    if (way.y == 0.0) {
        return {ahead < 0.0 ? rows.end : rows.begin, rows.end};
    }
    const double y = middle.y - ahead / way.y;
    const Range here = range(y, y, row_axis());
    return way.y > 0.0 ? Range{std::clamp(here.begin, rows.begin, rows.end), rows.end}
                       : Range{rows.begin, std::clamp(here.end, rows.begin, rows.end)};
}

// The rows of a column, among those, below the last position of the flat.
StockHeightMap::Range StockHeightMap::under_last(double x, Range rows, Vec3d tip) const
{
    constexpr double kInside = 1.0 - 1e-9;
    const double foot = kInside * (last_->shrunk ? probe_profile_ : tool_).flat;
    const double dx = x - last_->tip.x;
    if (dx * dx >= foot * foot || last_->tip.z > tip.z + kLevel) {
        return {rows.begin, rows.begin};
    }
    const double half = std::sqrt(foot * foot - dx * dx);
    const double y = last_->tip.y;
    const std::size_t begin = range(y - half, y - half, row_axis()).end;
    const std::size_t end = range(y + half, y + half, row_axis()).end;
    const std::size_t from = std::clamp(begin, rows.begin, rows.end);
    return {from, std::clamp(end, from, rows.end)};
}

// The points under the last position are as low as the tool leaves them: rows that it cannot lower
// further are skipped.
void StockHeightMap::cut_at(const Position& position, double& deepest)
{
    const Vec3d tip = position.tip;
    const double squared = (position.shrunk ? probe_profile_ : tool_).reach;
    const double reach = std::sqrt(squared);
    const bool onward = last_ && (position.shrunk || !last_->shrunk) &&
                        std::hypot(tip.x - last_->tip.x, tip.y - last_->tip.y) < reach;
    const Range columns = range(tip.x - reach, tip.x + reach, column_axis());
    for (std::size_t i = columns.begin; i < columns.end; ++i) {
        const double x = origin_.x + static_cast<double>(i) * pitch_;
        const double half = std::sqrt(std::max(0.0, squared - (x - tip.x) * (x - tip.x)));
        Range rows = range(tip.y - half, tip.y + half, row_axis());
        if (onward) {
            rows = maybe_lower(x, rows, tip);
            const Range cut = under_last(x, rows, tip);
            cut_column(i, {rows.begin, cut.begin}, position, deepest);
            rows.begin = cut.end;
        }
        cut_column(i, rows, position, deepest);
    }
    last_ = position;
}

void StockHeightMap::begin_trial()
{
    on_trial_ = true;
    last_before_trial_ = last_;
}

// A point that was lowered several times gets its first height last.
void StockHeightMap::end_trial()
{
    for (auto lowered = lowered_.rbegin(); lowered != lowered_.rend(); ++lowered) {
        heights_[lowered->place] = lowered->before;
    }
    lowered_.clear();
    last_ = last_before_trial_;
    on_trial_ = false;
}

double StockHeightMap::sweep(Vec3d from, Vec3d to, bool inside)
{
    if (std::min(from.z, to.z) >= top_) {
        return 0;
    }
    const int count = std::max(1, static_cast<int>(std::ceil(norm(to - from) / spacing_)));
    double deepest = 0;
    for (int i = 1; i <= count; ++i) {
        const Vec3d tip = from + (to - from) * (static_cast<double>(i) / count);
        if (tip.z < top_) {
            cut_at({tip, inside}, deepest);
        }
    }
    return deepest;
}

}  // namespace cusp::clearing
