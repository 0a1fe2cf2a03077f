// Each thread cuts its own band of columns along the whole path.
#include "host_tools/verify/machined_stock.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "host_tools/nurbs/plan_vector.hpp"
#include "host_tools/verify/bands.hpp"
#include "host_tools/verify/engagement_trace.hpp"
#include "host_tools/verify/tool_contact.hpp"

namespace cusp::verify {

using toolpath::Tool;

namespace {

// The tool's lower side above its tip, by the squared distance from the axis.
struct Profile {
    double flat;    // radius of the flat bottom
    double corner;  // radius of the corner
    double reach;   // squared radius of the whole tool
    double rise;    // of a cone, mm a mm outward; 0: none
    double join;    // mm: from the flat to where the corner ends
    double joined;  // mm: the height there

    explicit Profile(const Tool& tool, double shrink)
        : flat{},
          corner{std::max(0.0, tool.corner_radius - shrink)},
          reach{},
          rise{},
          join{corner},
          joined{corner}
    {
        const double radius = std::max(0.0, tool.radius - shrink);
        flat = std::max(0.0, radius - corner);
        reach = radius * radius;
        if (is_conical(tool)) {
            flat = std::max(0.0, tool.tip_radius - shrink);
            rise = 1 / std::tan(tool.tip_angle / 2);
            join = corner * std::cos(tool.tip_angle / 2);
            joined = corner * (1 - std::sin(tool.tip_angle / 2));
        }
    }
    double at(double squared) const
    {
        const double beyond = std::max(0.0, std::sqrt(squared) - flat);
        const double round = corner - std::sqrt(std::max(0.0, corner * corner - beyond * beyond));
        return beyond <= join ? round : joined + rise * (beyond - join);
    }
    // A lower bound of at(squared) is steepness() * squared: a ball lies above its parabola.
    double steepness() const
    {
        return flat > 0 || corner <= 0 || rise > 0 ? 0.0 : 1 / (2 * corner);
    }
};

// Half of the chord that a line cuts from a circle at a distance from its middle; 0 outside.
double half_chord(double squared_radius, double distance)
{
    return std::sqrt(std::max(0.0, squared_radius - distance * distance));
}

// The flat bottom of a tool moving from one position to the next: on a slope its rim cuts lower
// between the positions too.
class FlatSweep {
public:
    FlatSweep(Vec3d from, Vec3d to, double radius) : from_{from}, square_{radius * radius}
    {
        const double x = to.x - from.x;
        const double y = to.y - from.y;
        length_ = std::sqrt(x * x + y * y);
        constexpr double kShortest = 1e-9;
        if (length_ < kShortest) {
            length_ = 0.0;
            from_.z = std::min(from.z, to.z);
            return;
        }
        way_ = {x / length_, y / length_};
        slope_ = (to.z - from.z) / length_;
    }

    // z; kUnbounded where the flat bottom does not pass.
    double lowest(double x, double y) const
    {
        const double dx = x - from_.x;
        const double dy = y - from_.y;
        const double along = dx * way_.x + dy * way_.y;
        const double away = dy * way_.x - dx * way_.y;
        const double half = std::sqrt(std::max(0.0, square_ - away * away));
        const double begin = std::max(0.0, along - half);
        const double end = std::min(length_, along + half);
        const double height = from_.z + slope_ * (slope_ > 0.0 ? begin : end);
        return away * away <= square_ && begin <= end ? height : kUnbounded;
    }

private:
    Vec3d from_;
    Vec2d way_{1.0, 0.0};
    double square_;
    double length_{};
    double slope_{0.0};
};

// A cone, with a flat or a ball at its tip, moving from one position to the next. The height over a point is a convex
// function of the position, since the tool's profile is one of the distance: the lowest is where its slope is 0.
class ConeSweep {
public:
    ConeSweep(const Tool& tool, Vec3d from, Vec3d to)
        : from_{from}, profile_{tool, 0}, square_{tool.radius * tool.radius}
    {
        constexpr double kShortest = 1e-9;
        const Vec2d along = in_plan(to) - in_plan(from);
        length_ = norm(along);
        if (length_ < kShortest) {
            length_ = 0;
            from_.z = std::min(from.z, to.z);
            return;
        }
        way_ = along * (1.0 / length_);
        slope_ = (to.z - from.z) / length_;
    }

    // z; kUnbounded where the tool does not pass.
    double lowest(double x, double y) const
    {
        const Vec2d d{x - from_.x, y - from_.y};
        const double along = dot(d, way_);
        const double away = d.y * way_.x - d.x * way_.y;
        const double half = half_chord(square_, away);
        const double begin = std::max(0.0, along - half);
        const double end = std::min(length_, along + half);
        if (away * away > square_ || begin > end) {
            return kUnbounded;
        }
        const double at = std::clamp(along - behind(std::abs(away)), begin, end);
        const double squared = (along - at) * (along - at) + away * away;
        return from_.z + slope_ * at + profile_.at(squared);
    }

private:
    // mm along the way, from the position that cuts a point lowest to the point: where the profile is as steep as the
    // way. The first of flat, ball and flank on which it is.
    double behind(double away) const
    {
        if (slope_ == 0.0) {
            return 0.0;
        }
        const double steep = std::abs(slope_);
        const double side = slope_ > 0 ? 1.0 : -1.0;
        const double ball = steep * half_chord(profile_.corner * profile_.corner, away) /
                            std::sqrt(1 + steep * steep);
        if (profile_.corner > 0 && ball * ball + away * away <= profile_.join * profile_.join) {
            return side * ball;
        }
        if (steep >= profile_.rise) {
            return side * kUnbounded;
        }
        const double q = steep / profile_.rise;
        const double flank = q * away / std::sqrt(1 - q * q);
        return side * std::max(flank, half_chord(profile_.flat * profile_.flat, away));
    }

    Vec3d from_;
    Profile profile_;
    double square_;
    Vec2d way_{1.0, 0.0};
    double length_{};
    double slope_{0.0};
};

}  // namespace

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
    const bool is_cylinder = flat_radius(tool) >= tool.radius && !is_conical(tool);
    CutFigures figures;
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
        const bool goes_on = is_cylinder && k > 0 && positions.tips[k - 1].z <= tip.z;
        const double depth =
            cut_at(tool, tip, shrink, goes_on ? &positions.tips[k - 1] : nullptr, begin, end);
        if (trace != nullptr && depth > 0) {
            trace->add_cut(k, band);
        }
        if (edged && k > 0 && positions.tips[k - 1].z < top_) {
            sweep_flat(tool, positions.tips[k - 1], tip, begin, end);
        }
        if (is_conical(tool) && k > 0 && positions.tips[k - 1].z < top_) {
            sweep_cone(tool, positions.tips[k - 1], tip, begin, end);
        }
        double& worst = positions.rapid[k] ? figures.rapid_cut : figures.cut_depth;
        worst = std::max(worst, depth);
    }
    return figures;
}

// Over 60 lines: the loops over rows share what holds for a column, and are vectorised with it.
double MachinedStock::cut_at(const Tool& tool,
                             Vec3d tip,
                             double shrink,
                             const Vec3d* before,
                             std::size_t begin,
                             std::size_t end)
{
    // Rows that are compared together: most are below the tool.
    constexpr std::size_t kRun = 16;
    const Profile profile{tool, 0};
    const Profile probe{tool, shrink};
    const double steepness = profile.steepness();
    const double* row_x = row_x_.data();
    const double* row_y = row_y_.data();
    double deepest = 0;
    const std::size_t last = std::min(end, grid_.end_column(tip.x + tool.radius));
    for (std::size_t i = std::max(begin, grid_.first_column(tip.x - tool.radius)); i < last; ++i) {
        const double x = grid_.x0 + static_cast<double>(i) * grid_.pitch;
        const double column_x = x - tip.x;
        const double column_y = grid_.shift(i) - tip.y;
        const auto squared_at = [=](std::size_t j) {
            const double dx = column_x + row_x[j];
            const double dy = column_y + row_y[j];
            return dx * dx + dy * dy;
        };
        double* height = heights_.data() + i * grid_.ny;
        const auto cut_rows = [&](std::size_t first, std::size_t high) {
            for (std::size_t j0 = first; j0 < high; j0 += kRun) {
                const std::size_t j1 = std::min(high, j0 + kRun);
                double over = 0;
#pragma omp simd reduction(max : over)
                for (std::size_t j = j0; j < j1; ++j) {
                    const double squared = squared_at(j);
                    over = std::max(over, std::min(profile.reach - squared,
                                                   height[j] - tip.z - steepness * squared));
                }
                if (over <= 0) {
                    continue;
                }
#pragma omp simd reduction(max : deepest)
                for (std::size_t j = j0; j < j1; ++j) {
                    const double squared = squared_at(j);
                    const double tracked = height[j] - tip.z - shrink - probe.at(squared);
                    deepest = std::max(deepest, squared <= probe.reach ? tracked : 0.0);
                    const double lower = tip.z + profile.at(squared);
                    height[j] = squared <= profile.reach ? std::min(lower, height[j]) : height[j];
                }
            }
        };
        const double max_error = grid_.pitch / 2;
        const double half =
            half_chord(profile.reach, std::max(0.0, std::abs(column_x) - max_error));
        const std::size_t first = grid_.first_row(tip.y - half);
        const std::size_t high = grid_.end_row(tip.y + half);
        if (before == nullptr) {
            cut_rows(first, high);
            continue;
        }
        const double inner = half_chord(profile.reach, std::abs(x - before->x) + max_error);
        const std::size_t done = grid_.end_row(before->y - inner);
        const std::size_t open = std::max(done, grid_.first_row(before->y + inner));
        cut_rows(first, std::min(done, high));
        cut_rows(std::max(open, first), high);
    }
    return deepest;
}

// Only a crescent beside the lower of the two end positions is still uncut.
void MachinedStock::sweep_flat(
    const Tool& tool, Vec3d from, Vec3d to, std::size_t begin, std::size_t end)
{
    const double radius = flat_radius(tool);
    const double squared = radius * radius;
    const double max_error = grid_.pitch / 2;
    const FlatSweep sweep{from, to, radius};
    const Vec3d lower = from.z < to.z ? from : to;
    const auto [x_low, x_high] = std::minmax(from.x, to.x);
    const auto [y_low, y_high] = std::minmax(from.y, to.y);
    const std::size_t last = std::min(end, grid_.end_column(x_high + radius));
    for (std::size_t i = std::max(begin, grid_.first_column(x_low - radius)); i < last; ++i) {
        const double x = grid_.x0 + static_cast<double>(i) * grid_.pitch;
        const double outer =
            half_chord(squared, std::max({0.0, x_low - x - max_error, x - x_high - max_error}));
        const double inner = half_chord(squared, std::abs(x - lower.x) + max_error);
        const std::size_t high = grid_.end_row(y_high + outer);
        const std::size_t done = grid_.end_row(lower.y - inner);
        const std::size_t open = std::max(done, grid_.first_row(lower.y + inner));
        const double shift = grid_.shift(i);
        const auto cut_rows = [&](std::size_t first, std::size_t stop) {
            for (std::size_t j = first; j < stop; ++j) {
                double& height = heights_[grid_.index(i, j)];
                if (height > lower.z) {
                    height = std::min(height, sweep.lowest(x + row_x_[j], row_y_[j] + shift));
                }
            }
        };
        cut_rows(grid_.first_row(y_low - outer), std::min(done, high));
        cut_rows(open, high);
    }
}

// Exact on straight moves: where a cone goes down or up, a point is cut lowest from a position ahead of the nearest.
void MachinedStock::sweep_cone(
    const Tool& tool, Vec3d from, Vec3d to, std::size_t begin, std::size_t end)
{
    const double rise = 1 / std::tan(tool.tip_angle / 2);
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
    for_each_band(grid_.nx, [&](std::size_t begin, std::size_t end, std::size_t band) {
        bands[band] = cut_band(positions, spacing, trace, contact, band, begin, end);
        const std::lock_guard lock{guard};
        progress(static_cast<double>(++done) / static_cast<double>(kBands));
    });
    CutFigures sum;
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
