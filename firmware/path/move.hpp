// Move: one parsed move, exact. What gcode hands to the planner.
#pragma once

#include <cstdint>

#include "firmware/path/path.hpp"

namespace cusp::path {

enum class MoveKind : std::uint8_t {
    kRapid,  // as fast as the limits allow; rapid override
    kFeed,   // at most the feed; feed override
};

struct Move {
    MoveKind kind{MoveKind::kFeed};
    Path path{Line{}};
    Position start;  // machine coordinates
    Position end;
    float feed{0};  // mm/s along the path, > 0 for kFeed
    // How far the tool may leave the path, mm; 0 is the exact path (G61).
    float tolerance{0};
    // What of it the path itself has used: it stands for another one that near, mm.
    float departure{0};
    std::uint32_t line{0};  // of the program, for reports
};

// Length of the path in mm, within 1e-9 relative for lines and arcs and 1e-6 for Bezier pieces.
double length(const Move& move) noexcept;

}  // namespace cusp::path
