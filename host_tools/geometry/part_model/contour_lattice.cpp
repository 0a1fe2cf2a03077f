// Nodes that are not evaluated take the value of a neighbour: only the sign matters.
#include "host_tools/geometry/part_model/contour_lattice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace cusp::part_model {
namespace {

constexpr double kShift = 0.0137;  // of a cell
constexpr std::size_t kMostCells = std::size_t{1} << 22;

}  // namespace

ContourLattice::ContourLattice(Vec2d low,
                               Vec2d size,
                               DomainSamples samples,
                               const DomainMargin& margin)
    : margin_{margin},
      low_{low},
      size_{size},
      pitch_{size.x / samples.u, size.y / samples.v},
      u_cells_{static_cast<std::size_t>(samples.u) + 1},
      v_cells_{static_cast<std::size_t>(samples.v) + 1}
{
    origin_ = low_ - (0.5 - kShift) * pitch_;
    values_.resize((u_cells_ + 1) * rows());
    for (std::size_t n = 0; n < values_.size(); ++n) {
        values_[n] = margin_at(node(n));
    }
}

double ContourLattice::margin_at(Vec2d p) const
{
    const Vec2d high = low_ + size_;
    const bool within = p.x >= low_.x && p.x <= high.x && p.y >= low_.y && p.y <= high.y;
    return within ? margin_(p) : -kInfinite;
}

Vec2d ContourLattice::node(std::size_t index) const
{
    return {origin_.x + static_cast<double>(index / rows()) * pitch_.x,
            origin_.y + static_cast<double>(index % rows()) * pitch_.y};
}

std::size_t ContourLattice::cell_of(Vec2d p) const
{
    const auto at = [](double x, double origin, double pitch, std::size_t cells) {
        return static_cast<std::size_t>(
            std::clamp((x - origin) / pitch, 0.0, static_cast<double>(cells) - 0.5));
    };
    return at(p.x, origin_.x, pitch_.x, u_cells_) * rows() + at(p.y, origin_.y, pitch_.y, v_cells_);
}

bool ContourLattice::may_reach(std::size_t cell, Vec2d place) const
{
    const std::size_t other = cell_of(place);
    const auto apart = [](std::size_t a, std::size_t b) {
        return a > b ? a - b : b - a;
    };
    return cell == other || (apart(cell / rows(), other / rows()) <= 1 &&
                             apart(cell % rows(), other % rows()) <= 1 && !is_crossed(other));
}

bool ContourLattice::is_crossed(std::size_t cell) const
{
    const bool low = belongs(cell);
    return belongs(cell + 1) != low || belongs(cell + rows()) != low ||
           belongs(cell + rows() + 1) != low;
}

// The cells around are examined as well: across a valley or a ridge all four corners have the same
// sign.
bool ContourLattice::is_settled(std::size_t lower_node) const
{
    const std::size_t column = lower_node / rows();
    const std::size_t row = lower_node % rows();
    double nearest = kInfinite;
    double lowest = kInfinite;
    double highest = -kInfinite;
    bool jumps = false;
    bool alike = true;
    for (std::size_t i = column - (column > 0); i <= std::min(column + 2, u_cells_); ++i) {
        for (std::size_t j = row - (row > 0); j <= std::min(row + 2, v_cells_); ++j) {
            const double value = values_[i * rows() + j];
            alike = alike && (value >= 0) == (values_[lower_node] >= 0);
            if (!std::isfinite(value)) {
                jumps = true;
                continue;
            }
            lowest = std::min(lowest, value);
            highest = std::max(highest, value);
            nearest = std::min(nearest, std::abs(value));
        }
    }
    const bool far = lowest > highest || nearest >= highest - lowest;
    return alike && far && !(jumps && lowest <= highest);
}

bool ContourLattice::may_halve() const { return u_cells_ * v_cells_ <= kMostCells / 4; }

bool ContourLattice::halve()
{
    const std::size_t coarse_rows = rows();
    const std::size_t coarse_u = u_cells_;
    const std::size_t coarse_v = v_cells_;
    // Flags of cells, at the index of their lower node.
    std::vector<char> settled(values_.size(), 1);
    std::vector<char> crossed(values_.size(), 0);
    for (std::size_t i = 0; i < coarse_u; ++i) {
        for (std::size_t j = 0; j < coarse_v; ++j) {
            const std::size_t n = i * coarse_rows + j;
            settled[n] = is_settled(n) ? 1 : 0;
            crossed[n] = is_crossed(n) ? 1 : 0;
        }
    }
    const std::vector<double> coarse = std::exchange(values_, {});
    u_cells_ *= 2;
    v_cells_ *= 2;
    pitch_ = 0.5 * pitch_;
    values_.resize((u_cells_ + 1) * rows());

    bool is_new = false;
    for (std::size_t i = 0; i <= u_cells_; ++i) {
        for (std::size_t j = 0; j <= v_cells_; ++j) {
            const std::size_t around = (i / 2) * coarse_rows + j / 2;
            double& value = values_[i * rows() + j];
            value = coarse[around];
            // A node on a side belongs to the cells on both sides of it.
            const bool left = i % 2 == 1 || i == 0 || settled[around - coarse_rows] != 0;
            const bool below = j % 2 == 1 || j == 0 || settled[around - 1] != 0;
            const bool own = i / 2 == coarse_u || j / 2 == coarse_v || settled[around] != 0;
            if ((i % 2 == 0 && j % 2 == 0) || (left && below && own)) {
                continue;
            }
            value = margin_at(node(i * rows() + j));
            const auto passed = [&](bool beside, std::size_t cell) {
                return beside && crossed[cell] != 0;
            };
            const bool expected =
                passed(i / 2 < coarse_u && j / 2 < coarse_v, around) ||
                passed(i % 2 == 0 && i > 0 && j / 2 < coarse_v, around - coarse_rows) ||
                passed(j % 2 == 0 && j > 0 && i / 2 < coarse_u, around - 1);
            is_new = is_new || (!expected && (value >= 0) != (coarse[around] >= 0));
        }
    }
    return is_new;
}

std::vector<std::vector<GridSide>> ContourLattice::chains() const
{
    CellChains cells;
    const auto crossed = [&](const GridSide& side) {
        return belongs(side.first) != belongs(end_of(side));
    };
    for (std::size_t i = 0; i < u_cells_; ++i) {
        for (std::size_t j = 0; j < v_cells_; ++j) {
            cells.join(i * rows() + j, rows(), crossed);
        }
    }
    return cells.chains();
}

}  // namespace cusp::part_model
