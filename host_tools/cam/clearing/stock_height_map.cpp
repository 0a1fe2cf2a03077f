// Each sampled position lowers the points under the tool to its lower side.
#include "host_tools/cam/clearing/stock_height_map.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/parallel/parallel.hpp"

namespace cusp::clearing {

using offset::Box2d;
using toolpath::Tool;

namespace {

constexpr double kSpacingShare = 1.0 / 10;  // of the radius
constexpr double kMostPlaces = 4e6;
constexpr double kLeastSliver = 2e-3;      // mm
constexpr double kHeights = 256;           // of the tool's lower side
constexpr double kRounding = 1e-9;         // mm: of distances in plan
constexpr double kLevel = 1e-9;            // mm: rounding of a level move's heights
constexpr std::size_t kBands = 8;          // of columns, which threads share
constexpr std::size_t kManySamples = 200;  // fewer are not worth sharing: 0.1 ms

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
    return highest_over(at, reach, [&](double squared) { return probe_profile_.at(squared); });
}

double StockHeightMap::most_contact_height(Vec2d at, double within) const
{
    const double reach = std::sqrt(probe_profile_.reach);
    return highest_over(at, reach + within + kRounding, [&](double squared) {
        const double nearest = std::max(0.0, std::sqrt(squared) - within - kRounding);
        return probe_profile_.at(std::min(probe_profile_.reach, nearest * nearest));
    });
}

// The highest tip that touches stock within `reach` (mm) in plan; `lower_side` by squared distance.
template <class LowerSide>
double StockHeightMap::highest_over(Vec2d at, double reach, const LowerSide& lower_side) const
{
    const Range columns = range(at.x - reach, at.x + reach, column_axis());
    const Range rows = range(at.y - reach, at.y + reach, row_axis());
    double highest = -kUnbounded;
    for (std::size_t i = columns.begin; i < columns.end; ++i) {
        const double dx = origin_.x + static_cast<double>(i) * pitch_ - at.x;
        const float* heights = heights_.data() + i * rows_;
        for (std::size_t j = rows.begin; j < rows.end; ++j) {
            const double dy = origin_.y + static_cast<double>(j) * pitch_ - at.y;
            const double squared = dx * dx + dy * dy;
            const double height = static_cast<double>(heights[j]);
            if (height > highest && squared <= reach * reach) {
                highest = std::max(highest, height - lower_side(squared));
            }
        }
    }
    return highest - sliver_;
}

void StockHeightMap::cut_column(
    std::size_t column, Range rows, const Position& position, double& deepest, Cuts& cuts)
{
    const Vec3d tip = position.tip;
    const Profile& taken = profile_of(position);
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
                cuts.lowered.push_back({column * rows_ + j, heights[j]});
            }
            heights[j] = static_cast<float>(tip.z + left);
        }
    }
}

// The rows of a column where the tool may be lower than before. With q the squared distance from
// the tip, a ball's lower side R - sqrt(R^2 - q) rises by at least (q' - q) / 2R from q to q' > q:
// points whose q has grown by 2R times the tool's descent are no lower. A descending flat end is
// lower everywhere.
StockHeightMap::Range StockHeightMap::maybe_lower(double x, Range rows, Vec3d tip, Vec3d last) const
{
    const Vec2d way{tip.x - last.x, tip.y - last.y};
    const Vec2d middle{last.x + 0.5 * way.x, last.y + 0.5 * way.y};
    const double down = last.z - tip.z;
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
StockHeightMap::Range StockHeightMap::under_last(double x,
                                                 Range rows,
                                                 Vec3d tip,
                                                 const Position& last) const
{
    constexpr double kInside = 1.0 - 1e-9;
    const double foot = kInside * (profile_of(last)).flat;
    const double dx = x - last.tip.x;
    if (dx * dx >= foot * foot || last.tip.z > tip.z + kLevel) {
        return {rows.begin, rows.begin};
    }
    const double half = std::sqrt(foot * foot - dx * dx);
    const double y = last.tip.y;
    const std::size_t begin = range(y - half, y - half, row_axis()).end;
    const std::size_t end = range(y + half, y + half, row_axis()).end;
    const std::size_t from = std::clamp(begin, rows.begin, rows.end);
    return {from, std::clamp(end, from, rows.end)};
}

// The points under the last position are as low as the tool leaves them: rows that it cannot lower
// further are skipped.
void StockHeightMap::cut_at(const Sample& sample, const std::optional<Position>& last, Cuts& cuts)
{
    const Position& position = sample.position;
    const Vec3d tip = position.tip;
    const double squared = profile_of(position).reach;
    const bool onward =
        last && (position.shrunk || !last->shrunk) &&
        elementary::hypot(tip.x - last->tip.x, tip.y - last->tip.y) < std::sqrt(squared);
    double& deepest = cuts.deepest[sample.move];
    const std::size_t end = std::min(sample.columns.end, cuts.columns.end);
    for (std::size_t i = std::max(sample.columns.begin, cuts.columns.begin); i < end; ++i) {
        const double x = origin_.x + static_cast<double>(i) * pitch_;
        const double half = std::sqrt(std::max(0.0, squared - (x - tip.x) * (x - tip.x)));
        Range rows = range(tip.y - half, tip.y + half, row_axis());
        if (onward) {
            rows = maybe_lower(x, rows, tip, last->tip);
            const Range cut = under_last(x, rows, tip, *last);
            cut_column(i, {rows.begin, cut.begin}, position, deepest, cuts);
            rows.begin = cut.end;
        }
        cut_column(i, rows, position, deepest, cuts);
    }
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

std::vector<StockHeightMap::Sample> StockHeightMap::samples_of(const std::vector<Move>& moves,
                                                               bool shrunk) const
{
    const double reach = std::sqrt((shrunk ? probe_profile_ : tool_).reach);
    std::vector<Sample> out;
    for (std::size_t k = 0; k < moves.size(); ++k) {
        const Vec3d from = moves[k].from;
        const Vec3d way = moves[k].to - from;
        if (std::min(from.z, moves[k].to.z) >= top_) {
            continue;
        }
        const int count = std::max(1, static_cast<int>(std::ceil(norm(way) / spacing_)));
        for (int i = 1; i <= count; ++i) {
            const Vec3d tip = from + way * (static_cast<double>(i) / count);
            if (tip.z < top_) {
                out.push_back(
                    {{tip, shrunk}, k, range(tip.x - reach, tip.x + reach, column_axis())});
            }
        }
    }
    return out;
}

void StockHeightMap::cut_samples(const std::vector<Sample>& samples, Cuts& cuts)
{
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const Range under = samples[k].columns;
        if (under.begin < cuts.columns.end && under.end > cuts.columns.begin) {
            cut_at(samples[k], k > 0 ? std::optional{samples[k - 1].position} : last_, cuts);
        }
    }
}

// Each band of columns is cut by all positions in order. A cut looks at no other column, so that the
// bands may be cut at once.
std::vector<double> StockHeightMap::sweep(const std::vector<Move>& moves, bool shrunk)
{
    std::vector<double> deepest(moves.size());
    const std::vector<Sample> samples = samples_of(moves, shrunk);
    if (samples.empty()) {
        return deepest;
    }
    Range all = samples.front().columns;
    for (const Sample& sample : samples) {
        all = {std::min(all.begin, sample.columns.begin), std::max(all.end, sample.columns.end)};
    }
    const std::size_t count = all.end - all.begin;
    std::vector<Cuts> bands;
    const std::size_t many = samples.size() < kManySamples ? 1 : kBands;
    for (std::size_t k = 0; k < many; ++k) {
        bands.push_back(
            {{all.begin + count * k / many, all.begin + count * (k + 1) / many}, deepest});
    }
    parallel::for_each(many, [&](std::size_t k) { cut_samples(samples, bands[k]); });
    for (const Cuts& band : bands) {
        lowered_.insert(lowered_.end(), band.lowered.begin(), band.lowered.end());
        for (std::size_t k = 0; k < moves.size(); ++k) {
            deepest[k] = std::max(deepest[k], band.deepest[k]);
        }
    }
    last_ = samples.back().position;
    return deepest;
}

}  // namespace cusp::clearing
