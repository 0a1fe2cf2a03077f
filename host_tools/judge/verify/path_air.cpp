// Each path is held against the stock before it, then cuts it.
#include "host_tools/judge/verify/path_air.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/geometry/toolpath/toolpath_measure.hpp"
#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/path_positions.hpp"
#include "host_tools/judge/verify/stock_grid.hpp"
#include "host_tools/judge/verify/uncut_stock.hpp"

namespace cusp::verify {

using job::Job;
using toolpath::MoveKind;
using toolpath::Tool;
using toolpath::ToolMove;
using toolpath::Toolpath;

namespace {

// True if the tool at this tip meets the stock; at least one point is looked at.
bool meets(const MachinedStock& stock, const HeightGrid& grid, const Tool& tool, Vec3d tip)
{
    constexpr double kTouches = 1e-3;  // mm
    const double reach = std::max(tool.radius, grid.pitch);
    const auto is_in = [&](std::size_t i, std::size_t j) {
        const double away = norm(Vec2d{grid.x(i, j) - tip.x, grid.y(i, j) - tip.y});
        return away <= reach &&
               stock.heights()[grid.index(i, j)] >
                   tip.z + kTouches + profile_height(tool, std::min(away, tool.radius));
    };
    for (std::size_t i = grid.first_column(tip.x - reach); i < grid.end_column(tip.x + reach);
         ++i) {
        for (std::size_t j = grid.first_row(tip.y - reach); j < grid.end_row(tip.y + reach); ++j) {
            if (is_in(i, j)) {
                return true;
            }
        }
    }
    return false;
}

// Seconds of feed moves, in air and in all.
struct FeedTime {
    double air{};
    double all{};
};

FeedTime feed_time(const MachinedStock& stock,
                   const HeightGrid& grid,
                   const Toolpath& path,
                   const ToolPositions& positions)
{
    FeedTime time;
    for (std::size_t k = 1; k < positions.tips.size(); ++k) {
        const ToolMove& move = path.moves[positions.lines[k]];
        if (move.kind == MoveKind::kRapid) {
            continue;
        }
        const Vec3d from = positions.tips[k - 1];
        const Vec3d to = positions.tips[k];
        const double seconds =
            norm(to - from) / feed_of(path, {move.kind, toolpath::LineTo{to}, move.feed}, from);
        time.all += seconds;
        if (move.kind == MoveKind::kLink || !meets(stock, grid, path.tool, to)) {
            time.air += seconds;
        }
    }
    return time;
}

}  // namespace

std::vector<double> air_shares(const Job& job, const std::vector<const Toolpath*>& paths)
{
    constexpr double kCoarser = 4;
    constexpr double kMostPoints = 4e5;
    const double spacing = kCoarser * position_spacing(job);
    const HeightGrid grid = stock_grid(job, floors_box(job), std::nullopt, kMostPoints);
    MachinedStock stock = UncutStock{job}.on(grid);
    cut_earlier_programs(job, spacing, stock);
    std::vector<double> shares;
    for (const Toolpath* path : paths) {
        const ToolPositions positions = positions_on(*path, spacing);
        const FeedTime time = feed_time(stock, grid, *path, positions);
        shares.push_back(time.all > 0 ? time.air / time.all : 0);
        if (shares.size() < paths.size()) {
            stock.cut(positions, spacing, [](double) {});
        }
    }
    return shares;
}

}  // namespace cusp::verify
