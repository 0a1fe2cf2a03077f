// A ball at a track leaves t = R + n.d - sqrt(R^2 - |d across n|^2) over the place where the ball
// at c touches, d from c to the track, n the normal there: the lower of the two points where the
// normal through the contact meets the ball at the track.
#include "host_tools/grid_pocket/grid_roughness.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace cusp::host {
namespace {

// The heights around one square of four cells, in mm over its lower left cell.
struct Square {
    double gx;
    double gy;
    std::array<double, 4> z;  // lower left, lower right, upper left, upper right
    double bend_x;            // second derivatives of the tip's height
    double bend_y;
    // Sides run along: bottom, top, left, right.
    std::array<bool, 4> track;

    double height(double s, double t) const
    {
        const double plane =
            (z[0] * (1 - s) + z[1] * s) * (1 - t) + (z[2] * (1 - s) + z[3] * s) * t;
        return plane - bend_x * gx * gx * s * (1 - s) / 2 - bend_y * gy * gy * t * (1 - t) / 2;
    }

    Vec3d normal(double s, double t) const
    {
        const double zx =
            ((z[1] - z[0]) * (1 - t) + (z[3] - z[2]) * t) / gx + bend_x * gx * (s - 0.5);
        const double zy =
            ((z[2] - z[0]) * (1 - s) + (z[3] - z[1]) * s) / gy + bend_y * gy * (t - 0.5);
        const Vec3d n{-zx, -zy, 1};
        return n / norm(n);
    }
};

double left_by(double radius, Vec3d n, Vec3d d)
{
    const double along = dot(n, d);
    const double across = dot(d, d) - along * along;
    return across < radius * radius ? radius + along - std::sqrt(radius * radius - across) : radius;
}

// Least that any track of the square leaves at (s, t), both in [0, 1].
double left_at(const Square& q, double radius, double s, double t)
{
    const Vec3d here{s * q.gx, t * q.gy, q.height(s, t)};
    const Vec3d n = q.normal(s, t);
    double least = radius;
    const auto look = [&](double a, double b) {
        // Tracks run straight between their cells.
        const double z =
            (q.z[0] * (1 - a) + q.z[1] * a) * (1 - b) + (q.z[2] * (1 - a) + q.z[3] * a) * b;
        least = std::min(least, left_by(radius, n, Vec3d{a * q.gx, b * q.gy, z} - here));
    };
    for (const double a : {0.0, 1.0}) {
        look(a, 0);
        look(a, 1);
    }
    for (const double shift : {-0.15, 0.0, 0.15}) {
        const double a = std::clamp(s + shift, 0.0, 1.0);
        const double b = std::clamp(t + shift, 0.0, 1.0);
        if (q.track[0]) {
            look(a, 0);
        }
        if (q.track[1]) {
            look(a, 1);
        }
        if (q.track[2]) {
            look(0, b);
        }
        if (q.track[3]) {
            look(1, b);
        }
    }
    return least;
}

double left_in(const Square& q, double radius)
{
    double most = 0;
    for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
            most = std::max(most, left_at(q, radius, s, t));
        }
    }
    return most;
}

class Roughness {
public:
    Roughness(const CellGrid& grid,
              const std::vector<double>& heights,
              const Tracks& tracks,
              double radius,
              const std::function<double(Vec2d)>& to_wall_pass)
        : grid_{grid},
          heights_{heights},
          tracks_{tracks},
          radius_{radius},
          to_wall_pass_{to_wall_pass}
    {
    }

    double of_square(Cell c) const
    {
        const std::array<Cell, 4> cells{c, Cell{c.column + 1, c.row}, Cell{c.column, c.row + 1},
                                        Cell{c.column + 1, c.row + 1}};
        const auto inside =
            std::count_if(cells.begin(), cells.end(), [&](Cell k) { return grid_.inside(k); });
        if (inside == 0) {
            return 0;
        }
        if (inside < 4) {
            return beside_wall(c, cells);
        }
        Square q{grid_.gx(), grid_.gy(), {}, 0, 0, {}};
        for (std::size_t i = 0; i < 4; ++i) {
            q.z[i] = height(cells[i]);
        }
        q.bend_x = bend(cells, 1, 0) / (q.gx * q.gx);
        q.bend_y = bend(cells, 0, 1) / (q.gy * q.gy);
        q.track = {tracks_.east(cells[0]), tracks_.east(cells[2]), tracks_.north(cells[0]),
                   tracks_.north(cells[1])};
        return left_in(q, radius_);
    }

private:
    const CellGrid& grid_;
    const std::vector<double>& heights_;
    const Tracks& tracks_;
    double radius_;
    const std::function<double(Vec2d)>& to_wall_pass_;

    double height(Cell c) const { return heights_[grid_.index(c)]; }

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

    // Distances in plan, stretched by the steepest slope between the square's cells.
    double beside_wall(Cell c, const std::array<Cell, 4>& cells) const
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
        double farthest = 0;
        for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) {
            for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
                const Vec2d p = grid_.centre(c) + Vec2d{s * grid_.gx(), t * grid_.gy()};
                const double wall = to_wall_pass_(p);
                if (wall > 0) {
                    farthest = std::max(farthest, std::min(wall, to_tracks(p, cells)));
                }
            }
        }
        const double half = farthest * std::hypot(1.0, slope);
        return half < radius_ ? radius_ - std::sqrt(radius_ * radius_ - half * half) : radius_;
    }

    double to_tracks(Vec2d p, const std::array<Cell, 4>& cells) const
    {
        double least = 1e300;
        for (const Cell a : cells) {
            if (!grid_.inside(a)) {
                continue;
            }
            const Vec2d d = p - grid_.centre(a);
            least = std::min(least, norm(d));
            if (tracks_.east(a) && d.x >= 0 && d.x <= grid_.gx()) {
                least = std::min(least, std::abs(d.y));
            }
            if (tracks_.north(a) && d.y >= 0 && d.y <= grid_.gy()) {
                least = std::min(least, std::abs(d.x));
            }
        }
        return least;
    }
};

}  // namespace

void Tracks::add(Cell a, Cell b)
{
    const Cell low{std::min(a.column, b.column), std::min(a.row, b.row)};
    bits_[grid_.index(low)] |= static_cast<std::uint8_t>(a.row == b.row ? 1U : 2U);
}

double grid_roughness(const CellGrid& grid,
                      const std::vector<double>& heights,
                      const Tracks& tracks,
                      const Tool& tool,
                      const std::function<double(Vec2d)>& to_wall_pass)
{
    // A flat cutter has no corner to leave ridges: its radius stands for steps on slopes.
    const double corner = tool.corner_radius > 0 ? tool.corner_radius : tool.radius;
    const Roughness roughness{grid, heights, tracks, corner, to_wall_pass};
    double most = 0;
    for (int row = -1; row < grid.rows(); ++row) {
        for (int column = -1; column < grid.columns(); ++column) {
            most = std::max(most, roughness.of_square({column, row}));
        }
    }
    return most;
}

}  // namespace cusp::host
