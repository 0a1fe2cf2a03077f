// How long the operations of a program take: the controller's own core runs it.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace cusp::cli {

// s of each operation, on a machine with the default settings, as `cusp sim` counts them. None
// where the controller refuses the program.
//
// program   G-code
// begins    where the operations begin in it, bytes; what is before the first counts as the first's
// progress  gets the share that has run, 0 to 1
std::optional<std::vector<double>> simulated_times(const std::string& program,
                                                   const std::vector<std::size_t>& begins,
                                                   const std::function<void(double)>& progress);

}  // namespace cusp::cli
