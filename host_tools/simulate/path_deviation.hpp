// PathDeviation: how far the set points leave the programmed path.
//
// Computed in double from the moves as parsed, apart from everything that plans and interpolates
// them: true distances to lines, helices and rational Bezier curves.
#pragma once

#include <array>
#include <cstdint>
#include <deque>

#include "firmware/path/move.hpp"

namespace cusp::host {

// Distance in mm from a point to a move, within 1e-7 mm. The nearest point of an arc is sought
// where the angle says, for a helix in the turn that the height says and its neighbours.
double distance_to_move(const path::Move& move, Position point);

class PathDeviation {
public:
    // Moves in the order of the program; the lines rise. A move of no length is dropped.
    void add_move(const path::Move& move);

    // The set point of the next servo tick.
    //
    //   executing_line  of the move that the tool is on. Filters delay and blend: the moves of the
    //                   last kFilterTicks ticks and those that follow count as near.
    void add_set_point(Position set_point, std::uint32_t executing_line);

    // Greatest distance so far, mm, and the line executing there.
    double greatest() const { return greatest_; }
    std::uint32_t line() const { return line_; }

private:
    static constexpr std::size_t kFilterTicks = 32;
    static constexpr std::size_t kMovesAhead = 3;

    std::deque<path::Move> moves_;
    // Index into moves_ of the last move of the line that was executing, one a tick, newest last.
    std::deque<std::uint64_t> recent_;
    std::uint64_t first_index_{0};  // of moves_.front(), counted from the start of the program
    std::uint64_t current_{0};
    Position last_{};
    double greatest_{0};
    std::uint32_t line_{0};
};

}  // namespace cusp::host
