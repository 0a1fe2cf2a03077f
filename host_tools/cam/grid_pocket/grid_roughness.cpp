// With its axis at c, between tracks, the tool would touch the surface at q, beside c on the rising
// side. The height left at q is the lowest of the tool on the tracks around.
#include "host_tools/cam/grid_pocket/grid_roughness.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/cam/grid_pocket/flat_end_steps.hpp"

namespace cusp::grid_pocket {

using toolpath::Tool;

namespace {

// Limit of exact heights for one roughness.
constexpr int kMostHeights = 20000;

// Squares ranked this much below the highest found are skipped.
constexpr double kRankDoubt = 1.35;
constexpr double kRankDoubtOfSteps = 4;  // of a flat end: a square may rank far below its steps

// A ridge between lattice places may be higher than the highest place by this factor; the flat of a
// bull nose leaves steps between them.
constexpr double kBetween = 1.03;
constexpr double kBetweenSteps = 1.25;

// Height that tools at `tips` leave above the contact of a tool at `here`, with the slope of the
// tip's height there.
double left_by(const Tool& tool, Vec3d here, Vec2d slope, const std::vector<Vec3d>& tips)
{
    const double steep = norm(slope);
    const double secant = std::sqrt(1 + steep * steep);
    const double corner = tool.corner_radius;
    const double aside = steep > 1e-9 ? tool.radius - corner + corner * steep / secant : 0;
    const Vec2d touch = in_plan(here) + slope * (steep > 1e-9 ? aside / steep : 0);
    const double rim = tool.radius * (1 - 1e-12);
    const double z = here.z + profile_height(tool, std::min(aside, rim));
    const Vec3d normal{-slope.x / secant, -slope.y / secant, 1 / secant};
    double least = kUnbounded;
    for (const Vec3d& tip : tips) {
        const double away = norm(in_plan(tip) - touch);
        if (away > tool.radius + kOnTheRim) {
            continue;
        }
        double left = (tip.z + profile_height(tool, std::min(away, rim)) - z) / secant;
        if (corner == tool.radius) {
            // For a ball also along the normal: the lower point where the normal meets the ball on
            // the track. The larger of both heights counts.
            const Vec3d d = tip - here;
            const double along = dot(normal, d);
            const double across = dot(d, d) - along * along;
            if (across < corner * corner) {
                left = std::max(left, corner + along - std::sqrt(corner * corner - across));
            }
        }
        least = std::min(least, left);
    }
    // A contact that no track covers is spurious: the slope was computed across a kink.
    return least < kUnbounded ? std::clamp(least, 0.0, tool.radius) : 0.0;
}

class Roughness {
public:
    Roughness(const CellGrid& grid, const TipSurface& surface, const Tracks& tracks, Tool tool)
        : grid_{grid}, surface_{surface}, tracks_{tracks}, tool_{tool}
    {
        if (tool.corner_radius == 0) {
            steps_.emplace(grid, surface, tracks, tool.radius);
        }
    }

    // Rank of the square whose lower left cell is `c`, by the heights at cells alone.
    double ranked(Cell c)
    {
        const std::array<Cell, 4> cells = corners(c);
        const auto inside =
            std::count_if(cells.begin(), cells.end(), [&](Cell k) { return grid_.inside(k); });
        return inside == 4 ? between_cells(cells) : beside_wall(c, cells);
    }

    // The scallop of the square with exact heights; `evaluations` grows by their number.
    double exact(Cell c, int& evaluations)
    {
        if (steps_) {
            return steps_->left_in(c, evaluations);
        }
        const double reach = std::max(tool_.corner_radius, tool_.radius / 4);
        const auto places = [&](double size) {
            return std::clamp(2 * static_cast<int>(std::ceil(5 * size / reach)), 4, 14);
        };
        nx_ = places(grid_.gx());
        ny_ = places(grid_.gy());
        read_lattice(c, evaluations);
        collect_tracks(c);
        double most = 0;
        Vec2d top{};
        for (int j = 0; j <= ny_; ++j) {
            for (int i = 0; i <= nx_; ++i) {
                if (known(i, j)) {
                    const double left = left_at(place(c, i, j), slopes(i, j), evaluations);
                    top = left > most ? in_plan(place(c, i, j)) : top;
                    most = std::max(most, left);
                }
            }
        }
        return most > 0 ? climb(top, most, evaluations) : 0;
    }

private:
    const CellGrid& grid_;
    const TipSurface& surface_;
    const Tracks& tracks_;
    Tool tool_;
    std::optional<FlatEndSteps> steps_;  // of a flat end
    int nx_{};
    int ny_{};
    std::vector<double> lattice_;
    std::vector<Vec3d> tips_;

    static std::array<Cell, 4> corners(Cell c)
    {
        return {c, Cell{c.column + 1, c.row}, Cell{c.column, c.row + 1},
                Cell{c.column + 1, c.row + 1}};
    }

    double height(Cell c) const { return surface_.heights[grid_.index(c)]; }
    Vec3d tip(Cell c) const
    {
        const Vec2d at = grid_.centre(c);
        return {at.x, at.y, height(c)};
    }

    bool track(Cell a, bool east) const
    {
        const Cell b = east ? Cell{a.column + 1, a.row} : Cell{a.column, a.row + 1};
        return grid_.inside(a) && grid_.inside(b) && (east ? tracks_.east(a) : tracks_.north(a));
    }

    // At the middle of the square and of its sides, with the height as a paraboloid.
    double between_cells(const std::array<Cell, 4>& cells)
    {
        const double gx = grid_.gx();
        const double gy = grid_.gy();
        const std::array<double, 4> z{height(cells[0]), height(cells[1]), height(cells[2]),
                                      height(cells[3])};
        const double bend_x = bend(cells, 1, 0);
        const double bend_y = bend(cells, 0, 1);
        const Vec2d origin = grid_.centre(cells[0]);
        const auto flat = [&](double s, double t) {
            return (z[0] * (1 - s) + z[1] * s) * (1 - t) + (z[2] * (1 - s) + z[3] * s) * t;
        };
        tips_.clear();
        for (const Cell c : cells) {
            tips_.push_back(tip(c));
        }
        const auto foot = [&](bool cut, double s, double t) {
            if (cut) {
                tips_.push_back({origin.x + s * gx, origin.y + t * gy, flat(s, t)});
            }
        };
        foot(track(cells[0], true), 0.5, 0);
        foot(track(cells[2], true), 0.5, 1);
        foot(track(cells[0], false), 0, 0.5);
        foot(track(cells[1], false), 1, 0.5);
        double most = 0;
        for (const double s : {0.0, 0.5, 1.0}) {
            for (const double t : {0.0, 0.5, 1.0}) {
                const double h = flat(s, t) - bend_x * s * (1 - s) / 2 - bend_y * t * (1 - t) / 2;
                const Vec2d slope{
                    ((z[1] - z[0]) * (1 - t) + (z[3] - z[2]) * t + bend_x * (s - 0.5)) / gx,
                    ((z[2] - z[0]) * (1 - s) + (z[3] - z[1]) * s + bend_y * (t - 0.5)) / gy};
                most = std::max(
                    most, left_by(tool_, {origin.x + s * gx, origin.y + t * gy, h}, slope, tips_));
            }
        }
        return most;
    }

    // Mean second difference over the square's cells along an axis.
    double bend(const std::array<Cell, 4>& cells, int dx, int dy) const
    {
        double sum = 0;
        int count = 0;
        for (const Cell c : cells) {
            const Cell before{c.column - dx, c.row - dy};
            const Cell after{c.column + dx, c.row + dy};
            if (grid_.inside(before) && grid_.inside(after)) {
                sum += height(before) - 2 * height(c) + height(after);
                ++count;
            }
        }
        return count > 0 ? sum / count : 0;
    }

    // By the distance to the next track in plan, scaled by the slope between the square's cells.
    double beside_wall(Cell c, const std::array<Cell, 4>& cells) const
    {
        const double middle =
            surface_.to_wall_pass((grid_.centre(c) + grid_.centre(cells[3])) * 0.5);
        const double half = elementary::hypot(grid_.gx(), grid_.gy()) / 2;
        if (middle < -half) {
            return 0;
        }
        double farthest = 0;
        for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) {
            for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
                const Vec2d p = grid_.centre(c) + Vec2d{s * grid_.gx(), t * grid_.gy()};
                const double wall = surface_.to_wall_pass(p);
                if (wall > 0) {
                    farthest = std::max(farthest, std::min(wall, to_tracks(p, cells)));
                }
            }
        }
        // Between the samples the distance may be larger by this much.
        farthest += half / 6;
        const double steep = steepest(cells);
        const double reach = tool_.corner_radius > 0 ? tool_.corner_radius : tool_.radius;
        const double way = std::min(farthest * elementary::hypot(1.0, steep), reach);
        return reach - std::sqrt(reach * reach - way * way) +
               (tool_.corner_radius < tool_.radius ? steep * farthest : 0);
    }

    double steepest(const std::array<Cell, 4>& cells) const
    {
        double slope = 0;
        for (const Cell a : cells) {
            for (const Cell b : cells) {
                if (grid_.inside(a) && grid_.inside(b) && a != b) {
                    slope = std::max(slope, std::abs(height(a) - height(b)) /
                                                norm(grid_.centre(a) - grid_.centre(b)));
                }
            }
        }
        return slope;
    }

    double to_tracks(Vec2d p, const std::array<Cell, 4>& cells) const
    {
        double least = kUnbounded;
        for (const Cell a : cells) {
            if (!grid_.inside(a)) {
                continue;
            }
            const Vec2d d = p - grid_.centre(a);
            least = std::min(least, norm(d));
            if (track(a, true) && d.x >= 0 && d.x <= grid_.gx()) {
                least = std::min(least, std::abs(d.y));
            }
            if (track(a, false) && d.y >= 0 && d.y <= grid_.gy()) {
                least = std::min(least, std::abs(d.x));
            }
        }
        return least;
    }

    std::size_t index(int i, int j) const
    {
        return static_cast<std::size_t>(j) * static_cast<std::size_t>(nx_ + 1) +
               static_cast<std::size_t>(i);
    }
    bool known(int i, int j) const
    {
        return i >= 0 && j >= 0 && i <= nx_ && j <= ny_ && !std::isnan(lattice_[index(i, j)]);
    }
    Vec2d spot(Cell c, int i, int j) const
    {
        return grid_.centre(c) + Vec2d{grid_.gx() * i / nx_, grid_.gy() * j / ny_};
    }
    Vec3d place(Cell c, int i, int j) const
    {
        const Vec2d at = spot(c, i, j);
        return {at.x, at.y, lattice_[index(i, j)]};
    }

    void read_lattice(Cell c, int& evaluations)
    {
        lattice_.assign(static_cast<std::size_t>((nx_ + 1) * (ny_ + 1)), kNoValue);
        for (int j = 0; j <= ny_; ++j) {
            for (int i = 0; i <= nx_; ++i) {
                const Vec2d at = spot(c, i, j);
                if (surface_.to_wall_pass(at) > -1e-6) {
                    lattice_[index(i, j)] = surface_.height(at).value_or(kNoValue);
                    ++evaluations;
                }
            }
        }
    }

    // Slopes of the tip's height: the central difference and, where the tool touches on two sides
    // and the slope jumps, those on each side.
    std::array<Vec2d, 5> slopes(int i, int j) const
    {
        const auto step = [&](int di, int dj, double length) {
            return known(i + di, j + dj) && known(i, j)
                       ? std::optional<double>{(lattice_[index(i + di, j + dj)] -
                                                lattice_[index(i, j)]) /
                                               length}
                       : std::nullopt;
        };
        const double sx = grid_.gx() / nx_;
        const double sy = grid_.gy() / ny_;
        const auto right = step(1, 0, sx);
        const auto left = step(-1, 0, -sx);
        const auto up = step(0, 1, sy);
        const auto down = step(0, -1, -sy);
        const double x1 = right ? *right : left.value_or(0);
        const double x0 = left ? *left : x1;
        const double y1 = up ? *up : down.value_or(0);
        const double y0 = down ? *down : y1;
        return {Vec2d{(x0 + x1) / 2, (y0 + y1) / 2}, Vec2d{x0, y0}, Vec2d{x0, y1}, Vec2d{x1, y0},
                Vec2d{x1, y1}};
    }

    // Cells of the square and around it, and the lattice places on its tracks.
    void collect_tracks(Cell c)
    {
        tips_.clear();
        for (int row = c.row - 1; row <= c.row + 2; ++row) {
            for (int column = c.column - 1; column <= c.column + 2; ++column) {
                if (grid_.inside({column, row})) {
                    tips_.push_back(tip({column, row}));
                }
            }
        }
        const auto add = [&](int i, int j) {
            if (known(i, j)) {
                tips_.push_back(place(c, i, j));
            }
        };
        for (int i = 1; i < nx_; ++i) {
            if (track(c, true)) {
                add(i, 0);
            }
            if (track({c.column, c.row + 1}, true)) {
                add(i, ny_);
            }
        }
        for (int j = 1; j < ny_; ++j) {
            if (track(c, false)) {
                add(0, j);
            }
            if (track({c.column + 1, c.row}, false)) {
                add(nx_, j);
            }
        }
    }

    template <class Slopes>
    double left_at(Vec3d here, const Slopes& slopes, int& evaluations)
    {
        const std::size_t cells = tips_.size();
        const double wall = surface_.to_wall_pass(in_plan(here));
        if (wall < tool_.radius) {
            // The wall pass beside the place, and slightly to either side, for bull noses.
            const Vec2d foot = surface_.on_wall_pass(in_plan(here));
            for (const Vec2d shift :
                 {Vec2d{0, 0}, Vec2d{0.3, 0}, Vec2d{-0.3, 0}, Vec2d{0, 0.3}, Vec2d{0, -0.3}}) {
                const Vec2d on = surface_.on_wall_pass(foot + shift * tool_.radius);
                if (const auto z = surface_.height(on)) {
                    tips_.push_back({on.x, on.y, *z});
                }
                ++evaluations;
            }
        }
        double most = 0;
        for (const Vec2d slope : slopes) {
            most = std::max(most, left_by(tool_, here, slope, tips_));
        }
        if (tool_.corner_radius < tool_.radius) {
            most = std::max(most, left_around(here));
        }
        tips_.resize(cells);
        return most;
    }

    // For the rim of a flat, which may touch the surface in several places. The result is at
    // least the height that can be reached, so no place counts for too much.
    double left_around(Vec3d here) const
    {
        constexpr int kPlaces = 24;
        const double rim = tool_.radius - tool_.corner_radius;
        double most = 0;
        for (int k = 0; k < kPlaces; ++k) {
            const double angle = 2 * kPi * k / kPlaces;
            const Vec2d touch =
                in_plan(here) + Vec2d{elementary::cos(angle), elementary::sin(angle)} * rim;
            double least = kUnbounded;
            for (const Vec3d& tip : tips_) {
                const double away = norm(in_plan(tip) - touch);
                if (away <= tool_.radius + kOnTheRim) {
                    least = std::min(
                        least,
                        tip.z - here.z +
                            profile_height(tool_, std::min(away, rim + 0.9 * tool_.corner_radius)));
                }
            }
            most = least < kUnbounded ? std::max(most, least) : most;
        }
        return most;
    }

    // Pattern search from the highest lattice place to the top of the ridge.
    double climb(Vec2d top, double height, int& evaluations)
    {
        Vec2d step{grid_.gx() / nx_ / 2, grid_.gy() / ny_ / 2};
        for (int round = 0; round < 3; ++round, step = step * 0.5) {
            const Vec2d around = top;
            for (const Vec2d way : {Vec2d{1, 0}, Vec2d{-1, 0}, Vec2d{0, 1}, Vec2d{0, -1}}) {
                const Vec2d at = around + Vec2d{way.x * step.x, way.y * step.y};
                const double left = left_exactly(at, evaluations);
                top = left > height ? at : top;
                height = std::max(height, left);
            }
        }
        return height;
    }

    double left_exactly(Vec2d at, int& evaluations)
    {
        if (surface_.to_wall_pass(at) < 0) {
            return 0;
        }
        const double e = tool_.radius * 1e-3;
        evaluations += 3;
        const auto z = surface_.height(at);
        const auto x = surface_.height(at + Vec2d{e, 0});
        const auto y = surface_.height(at + Vec2d{0, e});
        if (!z || !x || !y) {
            return 0;
        }
        const Vec2d slope{(*x - *z) / e, (*y - *z) / e};
        return left_at({at.x, at.y, *z}, std::array<Vec2d, 1>{slope}, evaluations);
    }
};

struct Ranked {
    double rank;
    Cell cell;
};

}  // namespace

void Tracks::add(Cell a, Cell b)
{
    const Cell low{std::min(a.column, b.column), std::min(a.row, b.row)};
    bits_[grid_.index(low)] |= static_cast<std::uint8_t>(a.row == b.row ? 1U : 2U);
}

double grid_roughness(const CellGrid& grid,
                      const TipSurface& surface,
                      const Tracks& tracks,
                      const Tool& tool)
{
    Roughness roughness{grid, surface, tracks, tool};
    std::vector<Ranked> squares;
    for (int row = -1; row < grid.rows(); ++row) {
        for (int column = -1; column < grid.columns(); ++column) {
            const double rank = roughness.ranked({column, row});
            if (rank > 0) {
                squares.push_back({rank, {column, row}});
            }
        }
    }
    std::sort(squares.begin(), squares.end(),
              [](const Ranked& a, const Ranked& b) { return a.rank > b.rank; });
    const double between = tool.corner_radius == 0            ? 1
                           : tool.corner_radius < tool.radius ? kBetweenSteps
                                                              : kBetween;
    const double doubt = tool.corner_radius == 0 ? kRankDoubtOfSteps : kRankDoubt;
    double most = 0;
    double ratio = 1;
    int evaluations = 0;
    for (const Ranked& square : squares) {
        if (square.rank * doubt < most) {
            break;
        }
        if (evaluations > kMostHeights) {
            return between * std::max(most, square.rank * std::min(ratio, kRankDoubt));
        }
        const double exact = roughness.exact(square.cell, evaluations);
        ratio = std::max(ratio, exact / square.rank);
        most = std::max(most, exact);
    }
    return between * most;
}

}  // namespace cusp::grid_pocket
