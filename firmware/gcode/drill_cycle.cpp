// The drilling cycles as a sequence of phases; moves of no length are skipped.
#include "firmware/gcode/drill_cycle.hpp"

#include <algorithm>

namespace cusp::gcode {
namespace {

// A rapid back into the hole ends this far above the depth of the last peck (LinuxCNC's 0.010
// inch).
constexpr std::int64_t kPeckClearanceNm = 254000;

}  // namespace

DrillCycle::DrillCycle(const DrillWords& words, const path::Move& feed_move) noexcept
    : words_{words},
      feed_{feed_move.feed},
      tolerance_{feed_move.tolerance},
      line_{feed_move.line},
      at_{words.start},
      hole_{words.hole},
      depth_nm_{words.clearance_nm},
      left_{words.repeats}
{
    begin_hole();
}

void DrillCycle::begin_hole() noexcept
{
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        hole_[axis] = hole_[axis] + words_.step[axis];
    }
    depth_nm_ = words_.clearance_nm;
    phase_ = Phase::kRise;
}

Position DrillCycle::at_height(std::int64_t nm) const noexcept
{
    Position p = at_;
    p[words_.height_axis] = nm;
    return p;
}

bool DrillCycle::move_to(Position target, path::MoveKind kind, Action& action) noexcept
{
    if (target == at_) {
        return false;
    }
    action = path::Move{kind, path::Line{}, at_, target, feed_, tolerance_, 0, line_};
    at_ = target;
    return true;
}

// Performs the current phase and selects the next; false if the phase has nothing to do.
bool DrillCycle::perform(Action& action) noexcept
{
    constexpr auto kRapid = path::MoveKind::kRapid;
    const std::int64_t height = at_[words_.height_axis];
    switch (phase_) {
        case Phase::kRise:
            phase_ = Phase::kOver;
            return move_to(at_height(std::max(height, words_.clearance_nm)), kRapid, action);
        case Phase::kOver: {
            phase_ = Phase::kApproach;
            Position over = hole_.rounded();
            over[words_.height_axis] = height;
            return move_to(over, kRapid, action);
        }
        case Phase::kApproach:
            phase_ = Phase::kFeed;
            return move_to(at_height(words_.clearance_nm), kRapid, action);
        case Phase::kFeed:
            depth_nm_ = words_.peck_nm > 0 ? std::max(depth_nm_ - words_.peck_nm, words_.bottom_nm)
                                           : words_.bottom_nm;
            phase_ = depth_nm_ > words_.bottom_nm ? Phase::kClear : Phase::kDwell;
            return move_to(at_height(depth_nm_), path::MoveKind::kFeed, action);
        case Phase::kClear:
            phase_ = Phase::kPlunge;
            return move_to(at_height(words_.clearance_nm), kRapid, action);
        case Phase::kPlunge:
            phase_ = Phase::kFeed;
            return move_to(at_height(std::min(depth_nm_ + kPeckClearanceNm, height)), kRapid,
                           action);
        case Phase::kDwell:
            phase_ = Phase::kReturn;
            if (words_.dwell_seconds < 0) {
                return false;
            }
            action = Dwell{words_.dwell_seconds};
            return true;
        case Phase::kReturn:
            break;
    }
    const bool moved = move_to(at_height(words_.return_nm), kRapid, action);
    --left_;
    begin_hole();
    return moved;
}

bool DrillCycle::next(Action& action) noexcept
{
    // At most eight phases of a hole can have nothing to do; the feed of a peck is always a move.
    while (left_ > 0) {
        if (perform(action)) {
            return true;
        }
    }
    return false;
}

}  // namespace cusp::gcode
