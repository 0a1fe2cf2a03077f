// Interprets a program up to a line.
#include "host_tools/controller/stream/resume_point.hpp"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <sstream>

#include "firmware/gcode/command.hpp"
#include "firmware/gcode/interpreter.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/controller/dialect/program_lines.hpp"
#include "host_tools/controller/stream/program_check.hpp"

namespace cusp::stream {

using dialect::ProgramLines;

namespace {

using gcode::Motion;

bool is_curve(Motion motion) { return motion == Motion::kUniformNurbs || motion == Motion::kNurbs; }

// True if a line can be the first after this state.
bool can_be_first(const gcode::ModalState& before, const std::string& text)
{
    gcode::Command command;
    if (is_curve(before.motion) || text.front() == '$' ||
        !gcode::read_command(text, before, command)) {
        return false;
    }
    const bool plain = before.motion == Motion::kRapid || before.motion == Motion::kLine ||
                       before.motion == Motion::kNone;
    const bool names_motion = command.names(gcode::Group::kMotion);
    return plain || (names_motion &&
                     !(gcode::is_cycle(before.motion) && gcode::is_cycle(command.modal.motion)));
}

class Reading {
public:
    Reading(const std::string& program, const TransferStart& start)
        : program_{program}, touches_off_{start.touches_off}, axes_{start.axes}
    {
        interpreter_.set_axes(axes_);
        interpreter_.set_default_tolerance(start.default_tolerance);
        interpreter_.reset();
        interpreter_.set_parameters(start.parameters);
        interpreter_.set_position(start.machine);
        // One word at a time: words without meaning alone are refused and change nothing.
        std::istringstream words{start.modal};
        std::string word;
        while (words >> word) {
            run(word, 0);
        }
        interpreter_.set_position(start.machine);
        highest_z_nm_ = start.machine.z;
    }

    bool can_begin_at(const std::string& text) const
    {
        return can_be_first(interpreter_.modal(), text);
    }

    ResumePoint point(std::uint64_t line) const
    {
        return {line,        interpreter_.modal(),    interpreter_.parameters(),
                axes_,       interpreter_.position(), highest_z_nm_,
                plunge_feed_};
    }

    // Returns whether the line pauses for the user: no resume point lies before it.
    bool run(const std::string& text, std::uint64_t line)
    {
        if (text.front() == '$') {
            if (text.rfind("$H", 0) == 0 || text.rfind("$J", 0) == 0) {
                refuse(line, text + " moves the machine");
            }
            return false;
        }
        bool stops = false;
        if (interpreter_.execute(text, 0)) {
            gcode::Action action;
            while (interpreter_.next(action)) {
                take(action, line);
                stops = stops || std::holds_alternative<gcode::Pause>(action) ||
                        std::holds_alternative<gcode::ToolChange>(action);
            }
        }
        return stops;
    }

private:
    void take(const gcode::Action& action, std::uint64_t line)
    {
        if (std::holds_alternative<gcode::Probe>(action)) {
            refuse(line, "a probe");
        }
        if (touches_off_ && std::holds_alternative<gcode::ToolChange>(action)) {
            refuse(line, "a tool that was touched off");
        }
        const auto* move = std::get_if<path::Move>(&action);
        if (move == nullptr) {
            return;
        }
        highest_z_nm_ = std::max({highest_z_nm_, move->start.z, move->end.z});
        const Position by = move->end - move->start;
        if (move->kind == path::MoveKind::kFeed && by.x == 0 && by.y == 0 && by.z < 0) {
            constexpr float kSecondsPerMinute = 60.0F;
            plunge_feed_ = move->feed * kSecondsPerMinute;
        }
    }

    [[noreturn]] void refuse(std::uint64_t line, const std::string& what) const
    {
        throw InputError{fmt::format(
            "{}:{}: {}: what follows depends on where that ended, so it can't be resumed", program_,
            line, what)};
    }

    std::string program_;
    bool touches_off_;
    unsigned axes_;
    gcode::Interpreter interpreter_;
    std::int64_t highest_z_nm_{0};
    std::optional<float> plunge_feed_;
};

}  // namespace

ResumePoint find_resume_point(const std::string& program, const TransferRecord& record)
{
    ProgramLines lines{program};
    Reading reading{program, record.start};
    ProgramCheck check;
    std::optional<ResumePoint> point;
    while (const auto line = lines.next()) {
        if (record.checked_line != 0 && check.lines() == record.checked_line &&
            check.crc() != record.crc) {
            break;
        }
        if (reading.can_begin_at(line->text) && (!point || line->number < record.executed_line)) {
            point = reading.point(line->number);
        }
        if (line->number >= record.executed_line) {
            if (!point) {
                throw InputError{
                    fmt::format("{}:{}: no line can be begun at", program, line->number)};
            }
            return *point;
        }
        check.add(*line);
        if (reading.run(line->text, line->number)) {
            point.reset();
        }
    }
    if (record.checked_line != 0) {
        throw InputError{fmt::format("{}: is not the program that was sent up to line {}", program,
                                     record.checked_line)};
    }
    throw InputError{fmt::format("{}: has no line {}", program, record.executed_line)};
}

}  // namespace cusp::stream
