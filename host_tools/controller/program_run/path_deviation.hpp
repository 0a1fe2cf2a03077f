// PathDeviation: distance of the set points from the programmed path.
//
// Computed in double from the parsed moves, independently of planner and interpolator: true
// distances to lines, helices and rational Bezier curves.
#pragma once

#include <cstdint>
#include <deque>

#include "firmware/path/move.hpp"

namespace cusp::program_run {

// The point of a move that is nearest to a given point.
struct PathPlace {
    double distance;  // mm, within 1e-7
    double part;      // the move's parameter there, 0 to 1
};

// For an arc the search starts at the angle of the point; for a helix, in the turn at the point's
// height and its neighbours.
PathPlace nearest_place(const path::Move& move, Position point);

// Follows the set points along the path. If the path approaches itself, only the stretch around
// the position of the last set point counts.
class PathDeviation {
public:
    // Moves in the order of the program. A move of no length is dropped.
    void add_move(const path::Move& move);

    // The set point of the next servo tick. Returns its distance, mm; 0 without motion.
    double add_set_point(Position set_point);

    // The machine has moved by itself (homing, a probe): the path continues with the next move.
    void restart();

    // Greatest distance so far, mm, and the line of the nearest move there.
    double greatest() const { return greatest_; }
    std::uint32_t line() const { return line_; }

private:
    struct Stretch {
        path::Move move;
        double start;  // mm along the path
        double end;
        // Lines only, mm: end minus start, and the square of the length.
        bool straight;
        AxisVecd chord;
        double chord_square;
    };
    void add_stretch(const path::Move& move, double length);
    void add_turns(const path::Move& move, const path::Arc& arc);
    static PathPlace nearest_on(const Stretch& stretch, Position point);
    double reach(Position set_point) const;
    void find_first_near(double place);

    std::deque<Stretch> stretches_;
    std::size_t first_near_{0};  // of stretches_: the first within reach of the last set point
    double end_{0};              // of the path so far, mm
    double place_{0};            // of the last set point
    Position last_{};
    double greatest_tolerance_{0};
    double greatest_{0};
    std::uint32_t line_{0};
};

}  // namespace cusp::program_run
