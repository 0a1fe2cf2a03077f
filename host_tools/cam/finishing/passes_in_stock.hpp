// Leaves out what passes would do over the stock's top, in air.
#pragma once

#include <vector>

#include "host_tools/cam/finishing/pass_links.hpp"

namespace cusp::finishing {

// The parts of passes that go below `top`, the height of the stock. A tool whose tip is not below it
// removes nothing: what stays cuts the same, and a proof of the scallop by all passes holds.
//
// top      mm
// linked   mm: parts over the stock no longer than this stay, since a link would be as long
//
// A pass that is one curve stays whole unless all of it is over the stock.
std::vector<SurfacePass> passes_in_stock(const std::vector<SurfacePass>& passes,
                                         double top,
                                         double linked);

}  // namespace cusp::finishing
