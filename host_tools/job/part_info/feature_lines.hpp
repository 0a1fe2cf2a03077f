// Features of a part in words.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "host_tools/job/job/part_geometry.hpp"

namespace cusp::part_info {

// With up to `digits` decimals, and no zeros at the end.
std::string number(double value, int digits = 4);

// Labels and values, a line each: levels, pockets, holes, corners. At most 40 pockets, and 40 kinds of holes.
std::vector<std::pair<std::string, std::string>> feature_lines(const job::PartFeatures& features);

}  // namespace cusp::part_info
