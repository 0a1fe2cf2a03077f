// Move: one parsed move, exact. gcode hands it to the planner.
#pragma once

#include <cstddef>
#include <cstdint>

#include "firmware/path/laser_power.hpp"
#include "firmware/path/path.hpp"

namespace cusp::path {

// The kind of speed of a move, and with it the override that scales it.
enum class MoveKind : std::uint8_t {
    kRapid,      // as fast as the limits allow; rapid override
    kFeed,       // at most the feed; feed override
    kFixedFeed,  // at most the feed, which no override scales: jogs, probes, homing, tool setting
};

inline constexpr std::size_t kMoveKinds = 3;

// An end of a path that replaces the programmed one, where both meet.
struct PathLean {
    float slope{0};  // |dP/ds| between their directions
    float length{
        0};  // mm, over which the programmed path is a line from there; 0: they do not meet
};

struct Move {
    MoveKind kind{MoveKind::kFeed};
    Path path{Line{}};
    Position start;  // machine coordinates
    Position end;
    float feed{0};  // mm/s along the path, > 0 but for kRapid
    // Distance by which the tool may leave the path, mm; 0 is the exact path (G61).
    float tolerance{0};
    // Part of the tolerance that is used already: the distance of the path from the programmed one
    // that it replaces, mm.
    float departure{0};
    std::uint32_t line{0};  // of the program, for reports
    LaserPower power;       // off but for feed moves in laser mode
    PathLean start_lean{};
    PathLean end_lean{};
};

// Length of the path in mm, within 1e-9 relative for lines and arcs and 1e-6 for Bezier pieces.
double length(const Move& move) noexcept;

// The part of it that feeds count: without the rotary axis where anything else moves.
double fed_length(const Move& move) noexcept;

}  // namespace cusp::path
