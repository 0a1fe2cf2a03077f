// Each looked-at position lowers the places under the tool to its lower side.
#include "host_tools/clearing/standing_metal.hpp"

#include <algorithm>
#include <cmath>

namespace cusp::host {
namespace {

constexpr double kNoMetal = -1e300;
constexpr double kSpacingShare = 1.0 / 10;  // of the radius
constexpr double kMostPlaces = 4e6;
constexpr double kLeastSliver = 2e-3;  // mm
constexpr double kHeights = 256;       // of the tool's lower side

}  // namespace

double StandingMetal::Profile::at(double squared) const
{
    const double beyond = std::max(0.0, std::sqrt(squared) - flat);
    return corner - std::sqrt(std::max(0.0, corner * corner - beyond * beyond));
}

StandingMetal::StandingMetal(const Box2d& box, const Tool& tool, double top, double share)
    : origin_{box.x0, box.y0},
      pitch_{std::max(tool.radius * share,
                      std::sqrt((box.x1 - box.x0) * (box.y1 - box.y0) / kMostPlaces))},
      columns_{static_cast<std::size_t>((box.x1 - box.x0) / pitch_) + 1},
      rows_{static_cast<std::size_t>((box.y1 - box.y0) / pitch_) + 1},
      top_{top},
      heights_(columns_ * rows_, static_cast<float>(top))
{
    use(tool);
}

void StandingMetal::use(const Tool& tool)
{
    spacing_ = tool.radius * kSpacingShare;
    sliver_ = spacing_ * spacing_ / (4 * tool.radius) + kLeastSliver;
    tool_ = {tool.radius - tool.corner_radius, tool.corner_radius, tool.radius * tool.radius};
    const double radius = tool.radius - sliver_;
    const double corner = std::max(0.0, tool.corner_radius - sliver_);
    feeler_ = {radius - corner, corner, radius * radius};
    for (std::size_t i = 0; i < at_least_.size(); ++i) {
        at_least_[i] = tool_.at(tool_.reach * static_cast<double>(i) / kHeights);
    }
}

StandingMetal::Range StandingMetal::range(
    double low, double high, double origin, double pitch, std::size_t count)
{
    const auto place = [&](double at) {
        return static_cast<std::size_t>(
            std::clamp((at - origin) / pitch, 0.0, static_cast<double>(count)));
    };
    return {place(low), std::min(place(high) + 1, count)};
}

double StandingMetal::touch(Vec2d at, double share) const
{
    const double reach = share * std::sqrt(feeler_.reach);
    const Range columns = range(at.x - reach, at.x + reach, origin_.x, pitch_, columns_);
    const Range rows = range(at.y - reach, at.y + reach, origin_.y, pitch_, rows_);
    double highest = kNoMetal;
    for (std::size_t i = columns.begin; i < columns.end; ++i) {
        const double dx = origin_.x + static_cast<double>(i) * pitch_ - at.x;
        const float* heights = heights_.data() + i * rows_;
        for (std::size_t j = rows.begin; j < rows.end; ++j) {
            const double dy = origin_.y + static_cast<double>(j) * pitch_ - at.y;
            const double squared = dx * dx + dy * dy;
            const double z = static_cast<double>(heights[j]) - feeler_.at(squared);
            highest = squared <= reach * reach && z > highest ? z : highest;
        }
    }
    return highest - sliver_;
}

double StandingMetal::cut_at(Vec3d tip, const Profile& taken)
{
    const double reach = std::sqrt(taken.reach);
    const Range columns = range(tip.x - reach, tip.x + reach, origin_.x, pitch_, columns_);
    const double scale = kHeights / tool_.reach;
    double deepest = 0;
    for (std::size_t i = columns.begin; i < columns.end; ++i) {
        const double dx = origin_.x + static_cast<double>(i) * pitch_ - tip.x;
        const double half = std::sqrt(std::max(0.0, taken.reach - dx * dx));
        const Range rows = range(tip.y - half, tip.y + half, origin_.y, pitch_, rows_);
        float* heights = heights_.data() + i * rows_;
        for (std::size_t j = rows.begin; j < rows.end; ++j) {
            const double dy = origin_.y + static_cast<double>(j) * pitch_ - tip.y;
            const double squared = dx * dx + dy * dy;
            const double over = static_cast<double>(heights[j]) - tip.z;
            if (squared > taken.reach ||
                over <= at_least_[static_cast<std::size_t>(squared * scale)]) {
                continue;
            }
            const double felt = over - sliver_ - feeler_.at(squared);
            deepest = squared <= feeler_.reach && felt > deepest ? felt : deepest;
            const double left = taken.at(squared);
            heights[j] = left < over ? static_cast<float>(tip.z + left) : heights[j];
        }
    }
    return deepest;
}

double StandingMetal::sweep(Vec3d from, Vec3d to, const Profile& taken)
{
    if (std::min(from.z, to.z) >= top_) {
        return 0;
    }
    const int count = std::max(1, static_cast<int>(std::ceil(norm(to - from) / spacing_)));
    double deepest = 0;
    for (int i = 1; i <= count; ++i) {
        const Vec3d tip = from + (to - from) * (static_cast<double>(i) / count);
        deepest = tip.z < top_ ? std::max(deepest, cut_at(tip, taken)) : deepest;
    }
    return deepest;
}

}  // namespace cusp::host
