// Positions far from a window are left out; the tool is lifted over what they cut.
#include "host_tools/judge/verify/engagement_windows.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/machined_stock.hpp"
#include "host_tools/judge/verify/near_positions.hpp"
#include "host_tools/judge/verify/uncut_stock.hpp"

namespace cusp::verify {

using job::Job;

namespace {

constexpr double kPitchesPerRadius = 150;
constexpr double kMostWindowCells = 4e6;  // of a window
constexpr double kWorthwhile = 0.7;    // pitches of the height map: a coarser window shows no more
constexpr double kWindowTile = 4.0;    // radii
constexpr double kBeside = 4.0;        // pitches
constexpr double kLift = 1.0;          // mm over the stock
constexpr std::size_t kMostLooks = 2;  // at all positions, together
constexpr double kConfirmed = 0.8;     // of the way over the limit

using Tile = std::pair<long, long>;

struct Window {
    Vec2d low;
    Vec2d high;
    double pitch;
};

class EngagementWindows {
public:
    EngagementWindows(const Job& job,
                      const HeightGrid& grid,
                      const std::vector<ToolPositions>& runs,
                      std::vector<EngagementRun>& found)
        : job_{job}, uncut_{job}, grid_{grid}, runs_{runs}, found_{found}
    {
        for (const ToolPositions& run : runs) {
            least_ = std::min(least_, run.tool.radius);
            positions_ += run.tips.size();
        }
    }

    void look(double spacing)
    {
        const std::map<Tile, double> way = way_over();
        if (way.empty()) {
            return;
        }
        std::vector<std::pair<Tile, double>> tiles{way.begin(), way.end()};
        std::stable_sort(tiles.begin(), tiles.end(),
                         [](const auto& a, const auto& b) { return a.second > b.second; });
        const std::vector<ToolPositions> earlier = earlier_positions(job_, spacing);
        std::size_t looked_at = 0;
        for (const auto& [tile, over] : tiles) {
            const Window window = window_of(tile);
            if (looked_at > kMostLooks * positions_ || window.pitch > kWorthwhile * grid_.pitch) {
                return;
            }
            const double left = cut(tile, window, earlier, spacing, looked_at);
            if (tile == tiles.front().first && left > kConfirmed * over) {
                return;
            }
        }
    }

private:
    Tile tile_of(Vec3d tip) const
    {
        const double size = kWindowTile * least_;
        return {std::lround(std::floor(tip.x / size)), std::lround(std::floor(tip.y / size))};
    }

    bool is_over(std::size_t run, std::size_t k) const
    {
        return found_[run].kinds[k] == StepKind::kCut &&
               static_cast<double>(found_[run].angles[k]) > found_[run].counts_over;
    }

    double way(std::size_t run, std::size_t k) const
    {
        return k > 0 ? norm(runs_[run].tips[k] - runs_[run].tips[k - 1]) : 0.0;
    }

    std::map<Tile, double> way_over() const
    {
        std::map<Tile, double> out;
        for (std::size_t run = 0; run < runs_.size(); ++run) {
            for (std::size_t k = 0; k < found_[run].kinds.size(); ++k) {
                if (is_over(run, k)) {
                    out[tile_of(runs_[run].tips[k])] += way(run, k);
                }
            }
        }
        return out;
    }

    // The last run that is over its limit in the tile; later ones do not matter there.
    std::size_t last_over(const Tile& tile) const
    {
        std::size_t last = 0;
        for (std::size_t run = 0; run < runs_.size(); ++run) {
            for (std::size_t k = 0; k < found_[run].kinds.size() && last < run; ++k) {
                last = is_over(run, k) && tile_of(runs_[run].tips[k]) == tile ? run : last;
            }
        }
        return last;
    }

    Window window_of(const Tile& tile) const
    {
        double widest = least_;
        for (std::size_t run = 0; run < runs_.size(); ++run) {
            widest = found_[run].counts_over < kUnbounded ? std::max(widest, runs_[run].tool.radius)
                                                          : widest;
        }
        const double size = kWindowTile * least_;
        const double beyond = widest + kBeside * grid_.pitch;
        const Vec2d corner{static_cast<double>(tile.first) * size,
                           static_cast<double>(tile.second) * size};
        // Outside the height map there is no stock.
        const Vec2d low{std::max(corner.x - beyond, grid_.x0 - grid_.pitch / 2),
                        std::max(corner.y - beyond, grid_.y0 - grid_.pitch / 2)};
        const auto end = [&](double first, std::size_t count) {
            return first + (static_cast<double>(count) - 0.5) * grid_.pitch;
        };
        const Vec2d high{std::min(corner.x + size + beyond, end(grid_.x0, grid_.nx)),
                         std::min(corner.y + size + beyond, end(grid_.y0, grid_.ny))};
        const double area = std::max(0.0, high.x - low.x) * std::max(0.0, high.y - low.y);
        return {low, high,
                std::max(least_ / kPitchesPerRadius, std::sqrt(area / kMostWindowCells))};
    }

    NearPositions near_run(const ToolPositions& run, const Window& window) const
    {
        const double reach = run.tool.radius + kBeside * grid_.pitch;
        std::vector<std::size_t> places;
        for (std::size_t k = 0; k < run.tips.size(); ++k) {
            const Vec3d tip = run.tips[k];
            if (tip.x >= window.low.x - reach && tip.x <= window.high.x + reach &&
                tip.y >= window.low.y - reach && tip.y <= window.high.y + reach) {
                places.push_back(k);
            }
        }
        NearPositions out = near_positions(run, places, job_.stock_top + kLift);
        for (std::size_t i = 1; i < out.places.size(); ++i) {  // not cut on its way there
            out.positions.rapid[i] = out.positions.rapid[i] || out.places[i - 1] == kNoPlace;
        }
        return out;
    }

    // Returns the mm that are left over the limit.
    double cut(const Tile& tile,
               const Window& window,
               const std::vector<ToolPositions>& earlier,
               double spacing,
               std::size_t& looked_at)
    {
        const auto count = [&](double length) {
            return std::max<std::size_t>(1, static_cast<std::size_t>(length / window.pitch));
        };
        const HeightGrid fine{
            window.low.x + window.pitch / 2,     window.low.y + window.pitch / 2,     window.pitch,
            count(window.high.x - window.low.x), count(window.high.y - window.low.y), true};
        MachinedStock stock = uncut_.on(fine);
        for (const ToolPositions& run : earlier) {
            stock.cut(near_run(run, window).positions, spacing, [](double) {});
        }
        double left = 0;
        const std::size_t last = last_over(tile);
        for (std::size_t run = 0; run <= last; ++run) {
            const NearPositions near = near_run(runs_[run], window);
            looked_at += near.places.size();
            EngagementTrace trace{fine, near.positions};
            stock.cut(
                near.positions, spacing, [](double) {}, &trace);
            const EngagementRun closer = trace.finish();
            for (std::size_t i = 0; i < near.places.size(); ++i) {
                const std::size_t k = near.places[i];
                if (k == kNoPlace || found_[run].kinds[k] != StepKind::kCut ||
                    tile_of(runs_[run].tips[k]) != tile) {
                    continue;
                }
                found_[run].angles[k] = closer.angles[i];
                left += is_over(run, k) ? way(run, k) : 0.0;
            }
        }
        return left;
    }

    const Job& job_;
    UncutStock uncut_;
    const HeightGrid& grid_;
    const std::vector<ToolPositions>& runs_;
    std::vector<EngagementRun>& found_;
    double least_{kUnbounded};  // mm: radius of the smallest tool
    std::size_t positions_{0};
};

}  // namespace

void look_closer(const Job& job,
                 const HeightGrid& grid,
                 double spacing,
                 const std::vector<ToolPositions>& runs,
                 std::vector<EngagementRun>& found)
{
    EngagementWindows{job, grid, runs, found}.look(spacing);
}

}  // namespace cusp::verify
