// Each tile measures the rapid moves in its own points; a move's depth is the greatest.
#include "host_tools/judge/verify/deep_rapids.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/near_positions.hpp"
#include "host_tools/judge/verify/uncut_stock.hpp"

namespace cusp::verify {

using job::Job;

namespace {

constexpr std::size_t kTilePoints = 1024;  // along an edge, at most
constexpr std::size_t kMargin = 4;         // points beside it, which a look at level ground needs
constexpr double kLiftOver = 1.0;          // mm over the stock

using PlacesOfRuns = std::vector<std::vector<std::size_t>>;

struct RapidTile {
    HeightGrid grid;
    PlacesOfRuns earlier;  // of the positions that reach it
    PlacesOfRuns own;
};

class Tiles {
public:
    Tiles(const HeightGrid& grid, double top)
        : grid_{grid}, top_{top}, nx_{count(grid.nx)}, ny_{count(grid.ny)}, numbers_(nx_ * ny_)
    {
    }

    // From now on there are the tiles that rapid moves of these runs reach below the stock's top.
    void choose(const std::vector<ToolPositions>& runs)
    {
        for (const ToolPositions& run : runs) {
            for (std::size_t k = 0; k < run.tips.size(); ++k) {
                if (run.rapid[k] && run.tips[k].z < top_) {
                    visit(run, k, [&](std::size_t tile) { numbers_[tile] = 1; });
                }
            }
        }
        for (std::size_t tile = 0; tile < numbers_.size(); ++tile) {
            if (numbers_[tile] > 0) {
                tiles_.push_back({piece(tile / ny_, tile % ny_), {}, {}});
                numbers_[tile] = tiles_.size();
            }
        }
    }

    // Notes which positions reach which tile.
    void share(const std::vector<ToolPositions>& runs, PlacesOfRuns RapidTile::*places)
    {
        for (RapidTile& tile : tiles_) {
            (tile.*places).resize(runs.size());
        }
        for (std::size_t r = 0; r < runs.size(); ++r) {
            for (std::size_t k = 0; k < runs[r].tips.size(); ++k) {
                visit(runs[r], k, [&](std::size_t tile) {
                    if (numbers_[tile] > 0) {
                        (tiles_[numbers_[tile] - 1].*places)[r].push_back(k);
                    }
                });
            }
        }
    }

    const std::vector<RapidTile>& all() const { return tiles_; }

private:
    static std::size_t count(std::size_t points) { return (points - 1) / kTilePoints + 1; }

    template <class Visit>
    void visit(const ToolPositions& run, std::size_t k, Visit visit) const
    {
        // with the sweep from the position before
        const Vec3d tip = run.tips[k];
        const double reach = run.tool.radius + kMargin * grid_.pitch;
        const std::size_t i0 = grid_.first_column(tip.x - reach);
        const std::size_t i1 = grid_.end_column(tip.x + reach);
        const std::size_t j0 = grid_.first_row(tip.y - reach);
        const std::size_t j1 = grid_.end_row(tip.y + reach);
        if (i0 >= i1 || j0 >= j1) {
            return;
        }
        for (std::size_t i = i0 * nx_ / grid_.nx; i <= (i1 - 1) * nx_ / grid_.nx; ++i) {
            for (std::size_t j = j0 * ny_ / grid_.ny; j <= (j1 - 1) * ny_ / grid_.ny; ++j) {
                visit(i * ny_ + j);
            }
        }
    }

    HeightGrid piece(std::size_t i, std::size_t j) const
    {
        const auto range = [](std::size_t k, std::size_t tiles, std::size_t points) {
            const std::size_t begin = (k * points + tiles - 1) / tiles;
            const std::size_t end = ((k + 1) * points + tiles - 1) / tiles;
            return std::pair{begin - std::min(begin, kMargin), std::min(points, end + kMargin)};
        };
        const auto [i0, i1] = range(i, nx_, grid_.nx);
        const auto [j0, j1] = range(j, ny_, grid_.ny);
        return {grid_.x0 + static_cast<double>(i0) * grid_.pitch,
                grid_.y0 + static_cast<double>(j0) * grid_.pitch,
                grid_.pitch,
                i1 - i0,
                j1 - j0,
                grid_.shifted};
    }

    const HeightGrid& grid_;
    double top_;
    std::size_t nx_;
    std::size_t ny_;
    std::vector<std::size_t> numbers_;  // of each tile in tiles_, from 1; 0: it has none
    std::vector<RapidTile> tiles_;
};

std::vector<ToolPositions> near_runs(const std::vector<ToolPositions>& runs,
                                     const PlacesOfRuns& places,
                                     double high)
{
    std::vector<ToolPositions> out;
    for (std::size_t r = 0; r < runs.size(); ++r) {
        out.push_back(near_positions(runs[r], places[r], high).positions);
    }
    return out;
}

}  // namespace

std::vector<RapidOfRun> deep_rapids(const Job& job,
                                    const std::vector<ToolPositions>& runs,
                                    double spacing,
                                    const HeightGrid& grid,
                                    RapidCut rapids)
{
    Tiles tiles{grid, job.stock_top};
    tiles.choose(runs);
    if (tiles.all().empty()) {
        return {};
    }
    const std::vector<ToolPositions> earlier = earlier_positions(job, spacing);
    tiles.share(earlier, &RapidTile::earlier);
    tiles.share(runs, &RapidTile::own);
    const UncutStock uncut{job};
    const double high = job.stock_top + kLiftOver;
    std::vector<std::vector<RapidOfRun>> found(tiles.all().size());
    parallel::for_each(found.size(), [&](std::size_t t) {
        const RapidTile& tile = tiles.all()[t];
        const std::vector<ToolPositions> own = near_runs(runs, tile.own, high);
        MachinedStock stock = uncut.on(tile.grid);
        if (!stock.look_at_rapids_alone(own, rapids)) {
            return;
        }
        for (const ToolPositions& run : near_runs(earlier, tile.earlier, high)) {
            stock.cut(run, spacing, [](double) {});
        }
        for (std::size_t r = 0; r < own.size(); ++r) {
            for (const DeepRapid& deep : stock.cut(own[r], spacing, [](double) {}).deep_rapids) {
                found[t].push_back({r, own[r].lines[deep.end], deep.depth,
                                    own[r].tips[deep.position], deep.end_depth});
            }
        }
    });
    std::map<std::pair<std::size_t, std::uint32_t>, RapidOfRun> by_move;
    for (const std::vector<RapidOfRun>& of_tile : found) {
        for (const RapidOfRun& rapid : of_tile) {
            RapidOfRun& known = by_move.try_emplace({rapid.run, rapid.line}, rapid).first->second;
            const double end_depth = std::max(known.end_depth, rapid.end_depth);
            known = rapid.depth > known.depth ? rapid : known;
            known.end_depth = end_depth;
        }
    }
    std::vector<RapidOfRun> out;
    for (const auto& [move, rapid] : by_move) {
        out.push_back(rapid);
    }
    return out;
}

}  // namespace cusp::verify
