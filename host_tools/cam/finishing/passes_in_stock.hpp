// Leaves out what passes would do in air, as over the stock's top.
#pragma once

#include <functional>
#include <vector>

#include "host_tools/cam/finishing/pass_links.hpp"

namespace cusp::finishing {

// True if the tool removes nothing while its tip goes straight from `a` to `b`.
using IsIdle = std::function<bool(Vec3d a, Vec3d b)>;

// The parts of passes that are not idle: what stays cuts the same, and a proof of the scallop by all
// passes holds.
//
// linked   mm: idle parts no longer than this stay, since a link would be as long
//
// A pass that is one curve stays whole unless all of its points are idle.
std::vector<SurfacePass> passes_in_stock(const std::vector<SurfacePass>& passes,
                                         const IsIdle& is_idle,
                                         double linked);

// The pass with points where long lines begin and cease to be idle, to half a millimetre.
SurfacePass divided_where_idle(const SurfacePass& pass, const IsIdle& is_idle);

}  // namespace cusp::finishing
