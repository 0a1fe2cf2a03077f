// Times of a program's operations, by running it on the firmware core.
//
//     const auto times = simulated_times(program, {0, second_begin}, {});
//     if (times) {
//         fmt::print("{:.1f} s and {:.1f} s\n", times->at(0).seconds, times->at(1).seconds);
//     }
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "firmware/machine/settings.hpp"

namespace cusp::simulate {

// s, of machine time: a longer program is run in parts of about this length.
inline constexpr double kUsualPart = 400;

struct OperationTime {
    double seconds{};
    double rapid_s{};  // of these, in rapid moves; those of a drill's cycle count as feed
};

// The times of each operation. No value if the controller refuses the program.
//
// program   G-code
// begins    byte offsets of the operations; what precedes the first counts for the first
// progress  receives the fraction that has run, 0 to 1, from one thread at a time
// part      s: of the parts (program_parts.hpp) that run on all cores; a shorter one wastes more on its
//           way to where it begins
// settings  of the machine
//
// The times are the same for any number of threads. Accuracy: equal to those of `cusp sim` where there
// is one part, otherwise within a servo tick for each part that begins with a lift, and 0.3 s for each
// other: there the pieces that replace short lines may be divided otherwise.
std::optional<std::vector<OperationTime>> simulated_times(
    const std::string& program,
    const std::vector<std::size_t>& begins,
    const std::function<void(double)>& progress,
    double part = kUsualPart,
    const machine::Settings& settings = {});

}  // namespace cusp::simulate
