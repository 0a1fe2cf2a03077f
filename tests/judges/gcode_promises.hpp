// Postconditions of the interpreter for any text, checked line by line; used by a property test and
// a fuzz target.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "firmware/gcode/interpreter.hpp"
#include "firmware/nurbs/arc_length_table.hpp"

namespace cusp {

// Returns the text of the violated postcondition, or nullptr.
class GcodePromises {
public:
    const char* run(std::string_view line)
    {
        const Position before = interpreter_.position();
        const gcode::ModalState modal = interpreter_.modal();
        const Status status = interpreter_.execute(line, ++number_);
        gcode::Action action;
        bool acted = false;
        while (interpreter_.next(action)) {
            acted = true;
            if (const auto* move = std::get_if<path::Move>(&action)) {
                if (const char* broken = check(*move)) {
                    return broken;
                }
            }
            if (const auto* probe = std::get_if<gcode::Probe>(&action)) {
                at_ = probe->move.end;
            }
        }
        if (!status) {
            return check_refusal(before, modal, acted);
        }
        const bool in_curve = interpreter_.modal().motion == gcode::Motion::kUniformNurbs ||
                              interpreter_.modal().motion == gcode::Motion::kNurbs;
        return in_curve || at_ == interpreter_.position() ? nullptr
                                                          : "the moves do not end at position()";
    }

private:
    const char* check(const path::Move& move)
    {
        if (move.start != at_) {
            return "a move does not start where the one before ended";
        }
        at_ = move.end;
        if (move.kind != path::MoveKind::kRapid && !(move.feed >= 0 && move.feed < 1e12F)) {
            return "a feed is no speed";
        }
        const double length = path::length(move);
        if (!(length >= 0) || !(length < 1e12)) {
            return "a move has no length";
        }
        if (const auto* piece = std::get_if<path::BezierPiece>(&move.path)) {
            nurbs::ArcLengthTable table;
            if (!nurbs::make_arc_length_table(*piece, table)) {
                return "a piece has no table";
            }
        }
        return nullptr;
    }

    const char* check_refusal(Position before, const gcode::ModalState& modal, bool acted)
    {
        const bool was_in_curve =
            modal.motion == gcode::Motion::kUniformNurbs || modal.motion == gcode::Motion::kNurbs;
        if (acted) {
            return "a refused line had an effect";
        }
        if (was_in_curve) {
            return at_ == interpreter_.position() ? nullptr : "a cancelled curve ends elsewhere";
        }
        const gcode::ModalState& now = interpreter_.modal();
        const bool same = now.motion == modal.motion && now.feed == modal.feed &&
                          now.inches == modal.inches && now.incremental == modal.incremental &&
                          now.coordinate_system == modal.coordinate_system &&
                          now.spindle == modal.spindle && now.tool == modal.tool;
        return same && before == interpreter_.position() ? nullptr
                                                         : "a refused line changed the state";
    }

    gcode::Interpreter interpreter_;
    Position at_;
    std::uint32_t number_{0};
};

}  // namespace cusp
