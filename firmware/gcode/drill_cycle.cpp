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
    action = path::Move{kind, path::Line{}, at_, target, feed_, tolerance_, 0, line_, {}};
    at_ = target;
    return true;
}

// Performs the current phase; false if it has nothing to do.
bool DrillCycle::perform(Action& action) noexcept
{
    constexpr auto kRapid = path::MoveKind::kRapid;
    constexpr auto kCut = path::MoveKind::kFeed;
    switch (phase_) {
        case Phase::kRise:
            return move_to(at_height(words_.first_nm), kRapid, action);
        case Phase::kOver: {
            Position over = hole_.rounded();
            over[words_.height_axis] = words_.over_nm;
            return move_to(over, kRapid, action);
        }
        case Phase::kApproach:
        case Phase::kClear:
            return move_to(at_height(words_.clearance_nm), kRapid, action);
        case Phase::kFeed:
            depth_nm_ = words_.peck_nm > 0 ? std::max(depth_nm_ - words_.peck_nm, words_.bottom_nm)
                                           : words_.bottom_nm;
            return move_to(at_height(depth_nm_), kCut, action);
        case Phase::kPlunge:
            return move_to(at_height(std::min(depth_nm_ + kPeckClearanceNm, words_.clearance_nm)),
                           kRapid, action);
        case Phase::kDwell:
            action = Dwell{words_.dwell_seconds};
            return words_.dwell_seconds >= 0;
        case Phase::kStop:
            action = Spindle{SpindleMode::kOff, words_.spindle.speed};
            return words_.cycle == Motion::kBoreStopping;
        case Phase::kFeedOut:
            if (words_.cycle != Motion::kBore && words_.cycle != Motion::kBoreWithDwell) {
                return false;
            }
            return move_to(
                at_height(words_.cycle == Motion::kBore ? words_.clearance_nm : words_.return_nm),
                kCut, action);
        case Phase::kReturn:
            return move_to(at_height(words_.return_nm), kRapid, action);
        case Phase::kStart:
            break;
    }
    words_.first_nm = words_.return_nm;
    words_.over_nm = words_.return_nm;
    --left_;
    begin_hole();
    action = words_.spindle;
    return words_.cycle == Motion::kBoreStopping;
}

DrillCycle::Phase DrillCycle::following() const noexcept
{
    switch (phase_) {
        case Phase::kRise:
            return Phase::kOver;
        case Phase::kOver:
            return Phase::kApproach;
        case Phase::kApproach:
        case Phase::kPlunge:
            return Phase::kFeed;
        case Phase::kFeed:
            if (depth_nm_ <= words_.bottom_nm) {
                return Phase::kDwell;
            }
            return words_.cycle == Motion::kDrillChipBreaking ? Phase::kPlunge : Phase::kClear;
        case Phase::kClear:
            return Phase::kPlunge;
        case Phase::kDwell:
            return Phase::kStop;
        case Phase::kStop:
            return Phase::kFeedOut;
        case Phase::kFeedOut:
            return Phase::kReturn;
        case Phase::kReturn:
            return Phase::kStart;
        case Phase::kStart:
            break;
    }
    return Phase::kRise;
}

bool DrillCycle::next(Action& action) noexcept
{
    // At most eleven phases of a hole can have nothing to do; the feed of a peck is always a move.
    while (left_ > 0) {
        const bool done = perform(action);
        phase_ = following();
        if (done) {
            return true;
        }
    }
    return false;
}

}  // namespace cusp::gcode
