// Pieces whose ends meet, joined to closed and open chains.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::import {

// Curves in order; each starts at the end of the one before.
using CurveChain = std::vector<nurbs::Curve>;

// A place where more than two ends meet, so that more than one way continues.
struct Junction {
    Vec2d at;
    std::size_t ends;
};

struct ChainResult {
    std::vector<CurveChain> closed, open;
    std::size_t bridged{};             // gaps over `counted` that were joined
    double widest_gap{};               // mm, of those
    std::optional<Junction> junction;  // the first one
};

// Chains begin at ends that meet no other, in the order of the pieces, and then at those left over.
// At a junction a chain continues to the nearest end, and of those that are as near (up to
// `counted`) along the straightest way, then to the first. If it comes to a place that it has been
// at, the loop from there is taken off as a closed chain: so loops that touch at a corner are two.
//
// pieces   each open; in order
// meets    mm: largest distance of ends that meet
// counted  mm: ends no farther apart are at one place
ChainResult join_chains(const std::vector<CurveChain>& pieces, double meets, double counted);

}  // namespace cusp::import
