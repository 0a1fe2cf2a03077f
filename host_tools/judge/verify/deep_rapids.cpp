// Each tile measures the rapid moves in its own points; a move's depth is the greatest.
#include "host_tools/judge/verify/deep_rapids.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/judge/verify/earlier_programs.hpp"
#include "host_tools/judge/verify/near_positions.hpp"
#include "host_tools/judge/verify/thin_stock.hpp"
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

using RapidsOfMoves = std::map<std::pair<std::size_t, std::uint32_t>, RapidOfRun>;

// Calls visit(first, last) for the positions of each rapid move that ends below `top`.
template <typename Visit>
void visit_low_rapids(const ToolPositions& run, double top, Visit visit)
{
    for (std::size_t k = 1; k < run.tips.size(); ++k) {
        const bool ends =
            k + 1 == run.tips.size() || !run.rapid[k + 1] || run.lines[k + 1] != run.lines[k];
        if (!run.rapid[k] || !ends || run.tips[k].z >= top) {
            continue;
        }
        std::size_t first = k;
        while (first > 1 && run.rapid[first - 1] && run.lines[first - 1] == run.lines[k]) {
            --first;
        }
        visit(first, k);
    }
}

// The way of a level rapid move, or its end.
std::pair<Vec3d, Vec3d> level_way(const ToolPositions& run, std::size_t first, std::size_t last)
{
    const Vec3d end = run.tips[last];
    const Vec3d from = run.tips[first - 1];
    return {from.z == end.z ? from : end, end};
}

// Cuts a run into the stock, and looks at its rapid moves that are not known to be deep.
class ThinWalls {
public:
    ThinWalls(const Job& job, const HeightGrid& grid, const std::vector<ToolPositions>& runs)
        : top_{job.stock_top}, stock_{job, box_of(grid), places_in(runs, top_)}
    {
    }

    void cut(const ToolPositions& run) { cut_between(run, 1, run.tips.size()); }

    void look(const ToolPositions& run, std::size_t number, RapidsOfMoves& found)
    {
        std::size_t done = 1;
        visit_low_rapids(run, top_, [&](std::size_t first, std::size_t last) {
            cut_between(run, done, first);
            done = last + 1;
            const auto [from, to] = level_way(run, first, last);
            const std::pair<std::size_t, std::uint32_t> move{number, run.lines[last]};
            if (found.count(move) == 0) {
                if (const auto standing = stock_.under(run.tool, from, to)) {
                    const auto at_end = stock_.under(run.tool, to, to);
                    found.emplace(move, RapidOfRun{number, run.lines[last], standing->depth,
                                                   standing->tip, at_end ? at_end->depth : 0.0});
                }
            }
            stock_.cut(run.tool, to, to);
        });
        cut_between(run, done, run.tips.size());
    }

private:
    static ThinStock::Place box_of(const HeightGrid& grid)
    {
        const Vec2d low{grid.x0 - grid.pitch / 2, grid.y0 - grid.pitch / 2};
        return {low, low + Vec2d{static_cast<double>(grid.nx), static_cast<double>(grid.ny)} *
                               grid.pitch};
    }

    static std::vector<ThinStock::Place> places_in(const std::vector<ToolPositions>& runs,
                                                   double top)
    {
        std::vector<ThinStock::Place> places;
        for (const ToolPositions& run : runs) {
            const Vec2d beside{run.tool.radius, run.tool.radius};
            visit_low_rapids(run, top, [&](std::size_t first, std::size_t last) {
                const auto [from, to] = level_way(run, first, last);
                places.push_back({Vec2d{std::min(from.x, to.x), std::min(from.y, to.y)} - beside,
                                  Vec2d{std::max(from.x, to.x), std::max(from.y, to.y)} + beside});
            });
        }
        return places;
    }

    void cut_between(const ToolPositions& run, std::size_t begin, std::size_t end)
    {
        for (std::size_t k = begin; k < end; ++k) {
            if (!run.rapid[k]) {
                extend(run, k);
            }
        }
        flush(run);
    }

    // Positions along a line are one cut.
    void extend(const ToolPositions& run, std::size_t k)
    {
        constexpr double kStraight = 1e-9;
        const Vec3d from = run.tips[k - 1];
        const Vec3d to = run.tips[k];
        if (begun_ && is_same(end_, from) && from.z == to.z && begin_.z == to.z) {
            const Vec2d a = in_plan(end_) - in_plan(begin_);
            const Vec2d b = in_plan(to) - in_plan(from);
            if (dot(a, b) > 0 && std::abs(cross(a, b)) <= kStraight * norm(a) * norm(b)) {
                end_ = to;
                return;
            }
        }
        flush(run);
        begin_ = from;
        end_ = to;
        begun_ = true;
    }

    static bool is_same(Vec3d a, Vec3d b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

    void flush(const ToolPositions& run)
    {
        if (begun_) {
            stock_.cut(run.tool, begin_, end_);
        }
        begun_ = false;
    }

    double top_;
    ThinStock stock_;
    bool begun_{false};
    Vec3d begin_{};
    Vec3d end_{};
};

// Walls that the points of the grid miss.
void add_thin_walls(const Job& job,
                    const std::vector<ToolPositions>& runs,
                    double spacing,
                    const HeightGrid& grid,
                    RapidsOfMoves& found)
{
    constexpr double kFiner = 4;  // chords of arcs in programs
    ThinWalls walls{job, grid, runs};
    const std::vector<ToolPositions> earlier = earlier_positions(job, spacing / kFiner);
    for (const ToolPositions& run : earlier) {
        walls.cut(run);
    }
    for (std::size_t r = 0; r < runs.size(); ++r) {
        walls.look(runs[r], r, found);
    }
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
    RapidsOfMoves by_move;
    for (const std::vector<RapidOfRun>& of_tile : found) {
        for (const RapidOfRun& rapid : of_tile) {
            RapidOfRun& known = by_move.try_emplace({rapid.run, rapid.line}, rapid).first->second;
            const double end_depth = std::max(known.end_depth, rapid.end_depth);
            known = rapid.depth > known.depth ? rapid : known;
            known.end_depth = end_depth;
        }
    }
    if (rapids == RapidCut::kAtEnd) {
        add_thin_walls(job, runs, spacing, grid, by_move);
    }
    std::vector<RapidOfRun> out;
    for (const auto& [move, rapid] : by_move) {
        out.push_back(rapid);
    }
    return out;
}

}  // namespace cusp::verify
