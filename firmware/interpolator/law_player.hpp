// LawPlayer: travel along the path by a time law, in closed form.
//
// Within a cell u = x'/2 is linear in the travel, so with k = x''/2
//
//   s(t) = v t + u t^2/2 + k v t^3/6 + k u t^4/24 + k^2 v t^5/120 + ...
//
// The speed is the root of x at the place reached, anew in each tick: nothing drifts.
// Source: docs/numerics.md, "The time law". Held by tests/unit/interpolator/law_player_test.cpp.
#pragma once

#include <cstdint>

#include "firmware/planner/law_cell.hpp"

namespace cusp::interpolator {

// Context: servo tick.
class LawPlayer {
public:
    // The cell that is played from now on. Precondition: needs_cell().
    void play(const planner::LawCell& cell) noexcept;

    // The last cell that was given; a kStop before the first.
    const planner::LawCell& cell() const noexcept { return cell_; }

    // True if the cell before is played to its end, or none was given.
    bool needs_cell() const noexcept { return finished_; }

    // Goes on for `left` seconds, at most to the end of the cell, and lowers `left` by the time that
    // this takes. Returns the path units gone. Precondition: !needs_cell().
    std::uint32_t advance(float& left) noexcept;

    // Time to the end of an element, s.
    float time_left() const noexcept { return finished_ ? 0.0F : duration_ - elapsed_; }
    // Precondition: a kStop is played.
    float time_to_rest() const noexcept { return duration_ - elapsed_; }
    // Part of the cell that is left.
    float part_left() const noexcept
    {
        return finished_
                   ? 0.0F
                   : static_cast<float>(cell_.travel - gone_) / static_cast<float>(cell_.travel);
    }
    bool stops() const noexcept { return !finished_ && cell_.piece == planner::LawPiece::kStop; }

    // Along the path, now.
    float speed() const noexcept;

private:
    std::uint32_t go_to(float place) noexcept;
    std::uint32_t advance_element(float& left) noexcept;
    std::uint32_t go_to_end() noexcept;

    planner::LawCell cell_{{}, 0, planner::LawPiece::kStop};
    float length_{0};    // mm
    float place_{0};     // mm from its start
    float duration_{0};  // s, of an element
    float elapsed_{0};
    std::uint32_t gone_{0};  // path units from its start
    bool finished_{true};
};

}  // namespace cusp::interpolator
