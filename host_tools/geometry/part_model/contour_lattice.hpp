// Samples of a function over a rectangle of parameters, refined where it is near 0.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/geometry/part_model/cell_chains.hpp"

namespace cusp::part_model {

// The margin of a point in (u, v), mm: >= 0 inside the contour. It may jump, and be -kInfinite.
using DomainMargin = std::function<double(Vec2d)>;

// Numbers of samples along u and v that resolve the shape.
struct DomainSamples {
    int u{};
    int v{};
};

// Nodes avoid the rectangle's sides and middle, where models often have edges; the outermost nodes
// are outside it.
class ContourLattice {
public:
    ContourLattice(Vec2d low, Vec2d size, DomainSamples samples, const DomainMargin& margin);

    // -kInfinite outside the rectangle.
    double margin_at(Vec2d p) const;

    bool may_halve() const;

    // Halves the pitch. Nodes are evaluated unless all around is settled: the margin is farther
    // from 0 than it changes to the next cells. Returns whether a sample changed sign in a cell
    // that the contour did not seem to cross.
    bool halve();

    // The sides that the contour crosses.
    std::vector<std::vector<GridSide>> chains() const;

    std::size_t end_of(const GridSide& side) const { return end_node(side, rows()); }
    Vec2d node(std::size_t index) const;
    double value(std::size_t node) const { return values_[node]; }
    bool belongs(std::size_t node) const { return values_[node] >= 0; }

    // The lower node of the cell that holds a point.
    std::size_t cell_of(Vec2d place) const;

    // True if a point lies in the cell, or in a neighbour that the contour does not seem to cross.
    bool may_reach(std::size_t cell, Vec2d place) const;

private:
    std::size_t rows() const { return v_cells_ + 1; }
    bool is_settled(std::size_t lower_node) const;
    bool is_crossed(std::size_t lower_node) const;

    const DomainMargin& margin_;
    Vec2d low_;
    Vec2d size_;
    Vec2d origin_;
    Vec2d pitch_;
    std::size_t u_cells_;
    std::size_t v_cells_;
    std::vector<double> values_;  // column by column
};

}  // namespace cusp::part_model
