// Every thread cuts its own band of columns along the whole path.
#include "host_tools/verify/stock_cutting.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/verify/bands.hpp"

namespace cusp::verify {

using toolpath::Tool;

namespace {

// The tool's lower side over its tip, at the square of a radius that lies within it; in a form
// that the compiler can put into vectors.
struct Profile {
    double flat;    // radius of the flat bottom
    double corner;  // radius of the corner
    double reach;   // squared radius of the whole tool

    explicit Profile(const Tool& tool, double less)
        : flat{std::max(0.0, tool.radius - tool.corner_radius)},
          corner{std::max(0.0, tool.corner_radius - less)},
          reach{}
    {
        const double radius = std::max(0.0, tool.radius - less);
        flat = std::max(0.0, radius - corner);
        reach = radius * radius;
    }
    double at(double squared) const
    {
        const double beyond = std::max(0.0, std::sqrt(squared) - flat);
        return corner - std::sqrt(std::max(0.0, corner * corner - beyond * beyond));
    }
};

// A level foot on its way from one position to the next: what it leaves on a slope is as low as its
// rim comes there, between the positions too.
class FootSweep {
public:
    FootSweep(Vec3d from, Vec3d to, double radius) : from_{from}, square_{radius * radius}
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

    // z; infinite where the foot does not come.
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
        return away * away <= square_ && begin <= end ? height : kNowhere;
    }

private:
    static constexpr double kNowhere = 1e300;
    Vec3d from_;
    Vec2d way_{1.0, 0.0};
    double square_;
    double length_{};
    double slope_{0.0};
};

}  // namespace

StockHeightMap::StockHeightMap(const HeightGrid& grid, double top)
    : grid_{grid}, top_{top}, heights_(grid.size(), top)
{
}

CutFigures StockHeightMap::cut_band(const ToolPositions& positions,
                                    double spacing,
                                    std::size_t begin,
                                    std::size_t end,
                                    const Progress& progress)
{
    const Tool& tool = positions.tool;
    const double less = spacing * spacing / (4 * tool.radius) + 0.002;
    const Profile profile{tool, 0};
    const Profile probe{tool, less};
    std::vector<double> row_shift(grid_.ny);
    for (std::size_t j = 0; j < grid_.ny; ++j) {
        row_shift[j] = grid_.shift(j);
    }
    // Rounder corners leave no more between positions than the square of their distance.
    const bool edged = tool.radius > tool.corner_radius && tool.corner_radius < spacing;
    constexpr std::size_t kReport = 4096;
    CutFigures figures;
    for (std::size_t k = 0; k < positions.tips.size(); ++k) {
        if (begin == 0 && k % kReport == 0) {
            progress(static_cast<double>(k) / static_cast<double>(positions.tips.size()));
        }
        const Vec3d tip = positions.tips[k];
        if (tip.z >= top_) {
            continue;
        }
        double deepest = 0;
        const std::size_t first = std::max(begin, grid_.first_column(tip.x - tool.radius));
        const std::size_t last = std::min(end, grid_.end_column(tip.x + tool.radius));
        const std::size_t low = grid_.first_row(tip.y - tool.radius);
        const std::size_t high = grid_.end_row(tip.y + tool.radius);
        for (std::size_t i = first; i < last; ++i) {
            const double column_x = grid_.x0 + static_cast<double>(i) * grid_.pitch - tip.x;
            const double column_y = grid_.y0 + grid_.shift(i) - tip.y;
            double* height = heights_.data() + i * grid_.ny;
            for (std::size_t j = low; j < high; ++j) {
                const double dx = column_x + row_shift[j];
                const double dy = column_y + static_cast<double>(j) * grid_.pitch;
                const double squared = dx * dx + dy * dy;
                const double tracked = height[j] - tip.z - less - probe.at(squared);
                deepest = squared <= probe.reach && tracked > deepest ? tracked : deepest;
                const double lower = tip.z + profile.at(squared);
                height[j] = squared <= profile.reach && lower < height[j] ? lower : height[j];
            }
        }
        if (edged && k > 0 && positions.tips[k - 1].z < top_) {
            sweep_foot(tool, positions.tips[k - 1], tip, begin, end);
        }
        double& worst = positions.rapid[k] ? figures.rapid_cut : figures.cut_depth;
        worst = std::max(worst, deepest);
    }
    return figures;
}

void StockHeightMap::sweep_foot(
    const Tool& tool, Vec3d from, Vec3d to, std::size_t begin, std::size_t end)
{
    const double radius = tool.radius - tool.corner_radius;
    const FootSweep sweep{from, to, radius};
    const std::size_t first = std::max(begin, grid_.first_column(std::min(from.x, to.x) - radius));
    const std::size_t last = std::min(end, grid_.end_column(std::max(from.x, to.x) + radius));
    const std::size_t low = grid_.first_row(std::min(from.y, to.y) - radius);
    const std::size_t high = grid_.end_row(std::max(from.y, to.y) + radius);
    for (std::size_t i = first; i < last; ++i) {
        double* height = heights_.data() + i * grid_.ny;
        for (std::size_t j = low; j < high; ++j) {
            height[j] = std::min(height[j], sweep.lowest(grid_.x(i, j), grid_.y(i, j)));
        }
    }
}

CutFigures StockHeightMap::cut(const ToolPositions& positions,
                               double spacing,
                               const Progress& progress)
{
    std::vector<CutFigures> bands(band_count(grid_.nx));
    for_each_band(grid_.nx, [&](std::size_t begin, std::size_t end, std::size_t band) {
        bands[band] = cut_band(positions, spacing, begin, end, progress);
    });
    CutFigures sum;
    for (const CutFigures& band : bands) {
        sum.rapid_cut = std::max(sum.rapid_cut, band.rapid_cut);
        sum.cut_depth = std::max(sum.cut_depth, band.cut_depth);
    }
    return sum;
}

}  // namespace cusp::verify
