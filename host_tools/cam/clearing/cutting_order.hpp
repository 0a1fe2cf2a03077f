// The order of the loops of a pocket.
#pragma once

#include <vector>

namespace cusp::clearing {

// The order in which the nodes of a tree are cut: every node after its children, the child with the
// deepest tree first, the later one among equals. parents[i] < i is the parent of i; -1 for a root.
// Source: Suh & Lee 1990, "Determination of cutting order"; their figure 2.20 is the test.
std::vector<int> cutting_order(const std::vector<int>& parents);

}  // namespace cusp::clearing
