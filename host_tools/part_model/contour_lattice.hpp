// Looks at a function over a rectangle of parameters, finer where it is near 0.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "host_tools/nurbs/nurbs.hpp"
#include "host_tools/part_model/cell_chains.hpp"

namespace cusp::part_model {

// Of a place, mm: >= 0 where it belongs to what is outlined. Jumps are allowed, and -infinity.
using DomainMargin = std::function<double(Vec2d)>;

// How many looks along u and along v tell what there is.
struct DomainSamples {
    int u{};
    int v{};
};

// Nodes stand off the rectangle's edge and its middle, where models like to have edges; the
// outermost ones outside it.
class ContourLattice {
public:
    ContourLattice(Vec2d low, Vec2d size, DomainSamples looks, const DomainMargin& margin);

    // -infinity outside the rectangle.
    double margin_at(Vec2d p) const;

    bool may_halve() const;

    // Looks at the middles of cells and sides, but where all around is settled: the margin is
    // farther from 0 than it changes from there to the next cells. Returns whether one of
    // them tells what is new where the outline did not seem to pass.
    bool halve();

    // The sides that the outline crosses.
    std::vector<std::vector<GridSide>> chains() const;

    std::size_t end_of(const GridSide& side) const { return end_node(side, rows()); }
    Vec2d node(std::size_t index) const;
    double value(std::size_t node) const { return values_[node]; }
    bool belongs(std::size_t node) const { return values_[node] >= 0; }

    // The lower node of the cell that a place lies in.
    std::size_t cell_of(Vec2d place) const;

    // Whether a place lies in the cell, or in one beside it that the outline does not seem to
    // cross.
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
