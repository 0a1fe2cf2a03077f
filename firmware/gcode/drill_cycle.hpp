// G73, G81 to G83, G85, G86 and G89: the moves of drilling and boring cycles, one at a time.
#pragma once

#include <cstdint>

#include "firmware/base/axis.hpp"
#include "firmware/gcode/action.hpp"
#include "firmware/gcode/decimal.hpp"

namespace cusp::gcode {

// A cycle in machine coordinates. Heights are along the axis square to the plane.
struct DrillWords {
    Position start;
    ExactPosition hole;         // one step before the first hole
    PerAxis<ExactLength> step;  // from each hole to the next
    unsigned height_axis;       // 2 in G17, 1 in G18, 0 in G19
    std::int64_t clearance_nm;  // R
    std::int64_t bottom_nm;     // <= clearance_nm
    std::int64_t return_nm;     // where each hole ends: >= clearance_nm
    std::int64_t first_nm;      // where the tool goes before it leaves its place
    std::int64_t over_nm;       // where it arrives over the first hole
    std::int64_t peck_nm;       // > 0 with G73 and G83; 0: straight to the bottom
    double dwell_seconds;       // < 0: none
    Motion cycle;
    Spindle spindle;        // G86: started again after each hole
    std::uint32_t repeats;  // >= 1
};

// For each hole: rapid over it, rapid to R, feed to the bottom, dwell (G82, G86, G89), out. Between
// pecks a rapid to R and back to a little above the last depth (G83), or up by that little alone
// (G73). Out: at the feed to R (G85), or all the way (G89); with the spindle at rest, which starts
// again above (G86); else at the rapid.
class DrillCycle {
public:
    DrillCycle() = default;

    // `feed_move` holds feed, tolerance and line of the cycle's moves.
    DrillCycle(const DrillWords& words, const path::Move& feed_move) noexcept;

    // The next move or dwell: false at the end.
    bool next(Action& action) noexcept;

private:
    enum class Phase : std::uint8_t {
        kRise,
        kOver,
        kApproach,
        kFeed,
        kDwell,
        kStop,
        kClear,
        kPlunge,
        kFeedOut,
        kReturn,
        kStart
    };

    bool move_to(Position target, path::MoveKind kind, Action& action) noexcept;
    Position at_height(std::int64_t nm) const noexcept;
    bool perform(Action& action) noexcept;
    Phase following() const noexcept;
    void begin_hole() noexcept;

    DrillWords words_{};
    float feed_{0};       // mm/s
    float tolerance_{0};  // mm
    std::uint32_t line_{0};
    Position at_;
    ExactPosition hole_;
    std::int64_t depth_nm_{0};
    std::uint32_t left_{0};
    Phase phase_{Phase::kRise};
};

}  // namespace cusp::gcode
