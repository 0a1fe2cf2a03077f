// The actions of a line in their order.
#include "firmware/gcode/motion_plan.hpp"

namespace cusp::gcode {
namespace {

bool next_of(Moves& moves, Action& action) noexcept
{
    if (moves.first_left) {
        moves.first_left = false;
        action = moves.first;
        return true;
    }
    if (moves.then_left) {
        moves.then_left = false;
        path::Move move = moves.first;
        move.kind = path::MoveKind::kRapid;
        move.path = path::Line{};
        move.start = moves.first.end;
        move.end = moves.then;
        action = move;
        return true;
    }
    return false;
}

bool next_piece(const CurveMoves& moves, nurbs::PieceStream& curve, Action& action) noexcept
{
    nurbs::Piece piece{};
    const Position start = curve.position();
    if (!curve.next(piece)) {
        return false;
    }
    path::Move move = moves.pattern;
    move.kind = path::MoveKind::kFeed;
    move.path = piece.bezier;
    move.start = start;
    move.end = piece.end;
    action = move;
    return true;
}

}  // namespace

bool MotionPlan::next_motion(nurbs::PieceStream& curve, Action& action) noexcept
{
    if (auto* moves = std::get_if<Moves>(&motion)) {
        return next_of(*moves, action);
    }
    if (auto* drill = std::get_if<DrillCycle>(&motion)) {
        return drill->next(action);
    }
    if (const auto* pieces = std::get_if<CurveMoves>(&motion)) {
        return next_piece(*pieces, curve, action);
    }
    if (const auto* probe = std::get_if<Probe>(&motion)) {
        action = *probe;
        motion = std::monostate{};
        return true;
    }
    return false;
}

bool MotionPlan::next(nurbs::PieceStream& curve, Action& action) noexcept
{
    for (unsigned i = 0; i < static_cast<unsigned>(Step::kEnd); ++i) {
        const std::uint32_t bit = 1U << i;
        if ((steps_ & bit) == 0) {
            continue;
        }
        const auto step = static_cast<Step>(i);
        if (step == Step::kMotion && next_motion(curve, action)) {
            return true;
        }
        steps_ &= ~bit;
        switch (step) {
            case Step::kRotaryIgnored:
                action = RotaryIgnored{};
                return true;
            case Step::kToolChange:
                action = tool_change;
                return true;
            case Step::kSpindle:
                action = spindle;
                return true;
            case Step::kCoolant:
                action = coolant;
                return true;
            case Step::kDwell:
                action = dwell;
                return true;
            case Step::kParameters:
                action = parameters;
                return true;
            case Step::kFlow:
                if (const auto* pause = std::get_if<Pause>(&flow)) {
                    action = *pause;
                } else {
                    action = ProgramEnd{};
                }
                return true;
            case Step::kMotion:
            case Step::kEnd:
                break;
        }
    }
    return false;
}

}  // namespace cusp::gcode
