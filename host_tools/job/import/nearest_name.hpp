// Which known names a wrong one may have meant.
#pragma once

#include <string>
#include <vector>

namespace cusp::import {

// The known names that fewest letters make of this one, the nearest first; at most `count`.
std::vector<std::string> nearest_names(const std::string& name,
                                       std::vector<std::string> known,
                                       std::size_t count);

}  // namespace cusp::import
