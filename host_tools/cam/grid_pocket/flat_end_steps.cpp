// Squares keep their exact heights: neighbours read them again.
#include "host_tools/cam/grid_pocket/flat_end_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::grid_pocket {

namespace {

constexpr double kPlacesApart = 1.0 / 20;  // radii
constexpr int kDirections = 128;
constexpr std::array<double, 3> kRings{1, 0.6, 0.2};  // radii
constexpr double kOnTheWallPass = 1e-6;               // mm: rounding

int lattice_places(double size, double radius)
{
    constexpr double kARadius = 20;
    return std::clamp(static_cast<int>(std::ceil(kARadius * size / radius)), 1, 14);
}

int parts_of(double length, double radius)
{
    return std::max(1, static_cast<int>(std::ceil(length / (kPlacesApart * radius))));
}

}  // namespace

FlatEndSteps::FlatEndSteps(const CellGrid& grid,
                           const TipSurface& surface,
                           const Tracks& tracks,
                           double radius)
    : grid_{grid},
      surface_{surface},
      tracks_{tracks},
      radius_{radius},
      nx_{lattice_places(grid.gx(), radius)},
      ny_{lattice_places(grid.gy(), radius)},
      step_x_{grid.gx() / nx_},
      step_y_{grid.gy() / ny_},
      sub_x_{parts_of(step_x_, radius)},
      sub_y_{parts_of(step_y_, radius)},
      short_by_{elementary::hypot(step_x_ / sub_x_, step_y_ / sub_y_) / 2 +
                kPi * radius / kDirections}
{
}

// Heights at the corners of the lattice, and the wall pass beside them.
FlatEndSteps::Lattice FlatEndSteps::read(Cell c, Square& out, int& evaluations) const
{
    Lattice lattice{static_cast<std::size_t>(nx_ + 1), {}};
    lattice.z.assign(lattice.columns * static_cast<std::size_t>(ny_ + 1), kNoValue);
    for (int j = 0; j <= ny_; ++j) {
        for (int i = 0; i <= nx_; ++i) {
            const Vec2d p = grid_.centre(c) + Vec2d{step_x_ * i, step_y_ * j};
            const double inside = surface_.to_wall_pass(p);
            if (inside <= -kOnTheWallPass) {
                continue;
            }
            const Cell corner{c.column + i / nx_, c.row + j / ny_};
            if (i % nx_ == 0 && j % ny_ == 0 && grid_.inside(corner)) {
                lattice.at(i, j) = surface_.heights[grid_.index(corner)];
            } else {
                lattice.at(i, j) = surface_.height(p).value_or(kNoValue);
                ++evaluations;
            }
            if (inside < elementary::hypot(step_x_, step_y_)) {
                const Vec2d wall = surface_.on_wall_pass(p);
                if (const auto low = surface_.height(wall)) {
                    out.tips.push_back({wall.x, wall.y, *low});
                    out.places.push_back(out.tips.back());
                }
                ++evaluations;
            }
        }
    }
    return lattice;
}

// Those of the square's own cell: to the east and to the north.
void FlatEndSteps::add_tracks(Cell c, Lattice& lattice, Square& out) const
{
    if (!grid_.inside(c)) {
        return;
    }
    const Vec2d from = grid_.centre(c);
    const auto add = [&](int i, int j, int di, int dj, int parts) {
        const double a = lattice.at(i, j);
        const double b = lattice.at(i + di, j + dj);
        for (int k = 0; k < parts && !std::isnan(a) && !std::isnan(b); ++k) {
            const double part = static_cast<double>(k) / parts;
            out.tips.push_back({from.x + step_x_ * (i + di * part),
                                from.y + step_y_ * (j + dj * part), a + (b - a) * part});
        }
    };
    for (int i = 0; tracks_.east(c) && i < nx_; ++i) {
        add(i, 0, 1, 0, sub_x_);
    }
    for (int j = 0; tracks_.north(c) && j < ny_; ++j) {
        add(0, j, 0, 1, sub_y_);
    }
    if (!std::isnan(lattice.at(0, 0))) {
        out.tips.push_back({from.x, from.y, lattice.at(0, 0)});
    }
}

void FlatEndSteps::add_places(Cell c, Lattice& lattice, Square& out) const
{
    const Vec2d from = grid_.centre(c);
    for (int j = 0; j < ny_; ++j) {
        for (int i = 0; i < nx_; ++i) {
            const std::array<double, 4> h{lattice.at(i, j), lattice.at(i + 1, j),
                                          lattice.at(i, j + 1), lattice.at(i + 1, j + 1)};
            if (std::any_of(h.begin(), h.end(), [](double v) { return std::isnan(v); })) {
                continue;
            }
            for (int k = 0; k < sub_x_ * sub_y_; ++k) {
                const double s = (k % sub_x_ + 0.5) / sub_x_;
                const double t = (k / sub_x_ + 0.5) / sub_y_;
                out.places.push_back(
                    {from.x + step_x_ * (i + s), from.y + step_y_ * (j + t),
                     (h[0] * (1 - s) + h[1] * s) * (1 - t) + (h[2] * (1 - s) + h[3] * s) * t});
            }
        }
    }
}

FlatEndSteps::Square FlatEndSteps::made(Cell c, int& evaluations) const
{
    Square out;
    Lattice lattice = read(c, out, evaluations);
    add_tracks(c, lattice, out);
    add_places(c, lattice, out);
    return out;
}

const FlatEndSteps::Square& FlatEndSteps::square(Cell c, int& evaluations)
{
    const std::pair<int, int> key{c.column, c.row};
    const auto found = squares_.find(key);
    return found != squares_.end() ? found->second
                                   : squares_.emplace(key, made(c, evaluations)).first->second;
}

// All that reach a disc about a place of the square.
void FlatEndSteps::collect_tips(Cell c, int& evaluations)
{
    tips_.clear();
    const int across = 1 + static_cast<int>(2 * radius_ / grid_.gx());
    const int up = 1 + static_cast<int>(2 * radius_ / grid_.gy());
    for (int row = c.row - up; row <= c.row + up; ++row) {
        for (int column = c.column - across; column <= c.column + across; ++column) {
            if (column >= -1 && row >= -1 && column < grid_.columns() && row < grid_.rows()) {
                const Square& around = square({column, row}, evaluations);
                tips_.insert(tips_.end(), around.tips.begin(), around.tips.end());
            }
        }
    }
    std::sort(tips_.begin(), tips_.end(), [](Vec3d a, Vec3d b) { return a.z < b.z; });
}

// The lowest tip whose disc holds all places around; beside walls, where none does, the place alone.
std::optional<double> FlatEndSteps::cut_down_to(Vec2d q, const std::vector<Vec3d>& near) const
{
    for (const double reach : {radius_ - short_by_, radius_ + kOnTheRim}) {
        for (const Vec3d& tip : near) {
            const Vec2d off = in_plan(tip) - q;
            if (dot(off, off) <= reach * reach) {
                return tip.z;
            }
        }
    }
    return std::nullopt;
}

double FlatEndSteps::left_about(Vec3d place) const
{
    static const auto kAround = [] {
        std::array<Vec2d, kDirections> out{};
        for (std::size_t k = 0; k < kDirections; ++k) {
            const double angle = 2 * kPi * static_cast<double>(k) / kDirections;
            out[k] = {elementary::cos(angle), elementary::sin(angle)};
        }
        return out;
    }();
    std::vector<Vec3d> near;
    for (const Vec3d& tip : tips_) {
        const Vec2d off = in_plan(tip) - in_plan(place);
        if (dot(off, off) <= 4 * radius_ * radius_) {
            near.push_back(tip);
        }
    }
    double most = 0;
    for (const double ring : kRings) {
        for (const Vec2d way : kAround) {
            const auto low = cut_down_to(in_plan(place) + way * (ring * radius_), near);
            most = std::max(most, low ? *low - place.z : 0);
        }
    }
    return most;
}

double FlatEndSteps::left_in(Cell c, int& evaluations)
{
    collect_tips(c, evaluations);
    double most = 0;
    for (const Vec3d& place : square(c, evaluations).places) {
        if (!tips_.empty() && tips_.back().z - place.z > most) {
            most = std::max(most, left_about(place));
        }
    }
    return most;
}

}  // namespace cusp::grid_pocket
