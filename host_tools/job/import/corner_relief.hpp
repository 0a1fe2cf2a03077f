// Reliefs at inner corners of loops, so that a part with square corners fits: the loop goes round where the tool reaches
// into the corner.
//
//     std::size_t left_out = 0;
//     loop = with_reliefs(loop, true, {ReliefKind::kDogbone, 3.0}, left_out);
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "host_tools/job/job/job.hpp"

namespace cusp::import {

enum class ReliefKind : std::uint8_t {
    kDogbone,  // along the middle of the corner, until the tool touches its point
    kTBone     // along the longer of its sides
};

struct CornerRelief {
    ReliefKind kind;
    double tool_radius;  // mm; a relief is 0.05 mm wider
};

// mm: reliefs are so much wider than the tool.
inline constexpr double kReliefRoom = 0.05;

// The loop with reliefs at corners of 10 to 170 degrees between straight sides.
//
// loop         closed, counter-clockwise
// tool_inside  else it cuts outside the loop
// left_out     grows by the number of corners whose sides are too short
job::Loop with_reliefs(const job::Loop& loop,
                       bool tool_inside,
                       const CornerRelief& relief,
                       std::size_t& left_out);

// Gives all loops of the operation their reliefs. Returns the number of corners that are left out.
std::size_t add_reliefs(const CornerRelief& relief, job::Operation& operation);

}  // namespace cusp::import
