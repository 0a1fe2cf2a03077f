// Times of a program's operations, by running it on the firmware core.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace cusp::cli {

// s of each operation, on a machine with the default settings, equal to those of `cusp sim`. No
// value where the controller refuses the program.
//
// program   G-code
// begins    byte offsets of the operations; what precedes the first counts for the first
// progress  receives the fraction that has run, 0 to 1
std::optional<std::vector<double>> simulated_times(const std::string& program,
                                                   const std::vector<std::size_t>& begins,
                                                   const std::function<void(double)>& progress);

}  // namespace cusp::cli
