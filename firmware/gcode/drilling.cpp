// Converts the words of drilling and boring cycles to machine coordinates.
#include <algorithm>

#include "firmware/gcode/line_context.hpp"

namespace cusp::gcode {
namespace {

constexpr unsigned normal_axis(path::Plane plane) noexcept
{
    switch (plane) {
        case path::Plane::kZX:
            return 1;
        case path::Plane::kYZ:
            return 0;
        case path::Plane::kXY:
            break;
    }
    return 2;
}

// Stores a length word of the line; without one, the stored length is used.
Status remember(LineContext& line, char upper_case, ExactLength& kept) noexcept
{
    Command& command = line.command;
    if (command.has(upper_case)) {
        const Result<ExactLength> value = length_of(command, upper_case);
        if (!value) {
            return value.error();
        }
        command.use(upper_case);
        kept = *value;
        line.drill->known |= letter(upper_case);
    }
    return (line.drill->known & letter(upper_case)) != 0 ? Status{kDone}
                                                         : Status{Error::kGcodeValueWordMissing};
}

Status read_dwell(LineContext& line, DrillWords& words) noexcept
{
    Command& command = line.command;
    words.dwell_seconds = -1;
    if (!dwells(command.modal.motion)) {
        return kDone;
    }
    if (command.has('P')) {
        line.drill->dwell_seconds = to_double(command.value('P'));
        line.drill->known |= letter('P');
        command.use('P');
    }
    if ((line.drill->known & letter('P')) == 0) {
        return Error::kGcodeValueWordMissing;
    }
    words.dwell_seconds = line.drill->dwell_seconds;
    return kDone;
}

Status read_peck(LineContext& line, DrillWords& words) noexcept
{
    if (!pecks(line.command.modal.motion)) {
        return kDone;
    }
    if (const Status status = remember(line, 'Q', line.drill->peck); !status) {
        return status;
    }
    words.peck_nm = line.drill->peck.rounded();
    return words.peck_nm > 0 ? Status{kDone} : Status{Error::kGcodeInvalidTarget};
}

Status read_repeats(Command& command, DrillWords& words) noexcept
{
    constexpr std::int64_t kMaxRepeats = 9999;
    words.repeats = 1;
    if (!command.has('L')) {
        return kDone;
    }
    if (command.value('L').is_zero() || !is_whole(command.value('L'), kMaxRepeats)) {
        return Error::kGcodeInvalidTarget;
    }
    command.use('L');
    words.repeats = static_cast<std::uint32_t>(whole_part(command.value('L')));
    return kDone;
}

// The holes: in G91 each is one step from the one before, in G90 all are at the same place.
void read_holes(LineContext& line, DrillWords& words) noexcept
{
    words.start = line.start.rounded();
    words.hole = line.command.modal.incremental ? line.start : line.end;
    if (!line.command.modal.incremental) {
        return;
    }
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        if (axis == words.height_axis || !line.command.names_axis(axis)) {
            continue;
        }
        words.step[axis] = *length_of(line.command, axis_letter(axis));
        for (std::uint32_t i = 1; i < words.repeats; ++i) {
            line.end[axis] = line.end[axis] + words.step[axis];
        }
    }
}

// The initial level, in machine coordinates: where the tool was before the first of the cycles.
ExactLength initial_level(LineContext& line, unsigned axis, std::int64_t origin) noexcept
{
    DrillMemory& drill = *line.drill;
    if (drill.level_axis != axis) {
        drill.level_axis = static_cast<std::uint8_t>(axis);
        drill.level = line.start[axis] + ExactLength{-origin, 0};
    }
    return ExactLength{origin, 0} + drill.level;
}

// The tool goes up to R first, then across. With G98 it rises to the initial level on the way, unless it
// is above R already. LinuxCNC goes up to R on the way across where R is below the initial level.
void read_travel(const LineContext& line, std::int64_t level, DrillWords& words) noexcept
{
    const std::int64_t clearance = words.clearance_nm;
    const std::int64_t here = line.start[words.height_axis].rounded();
    const bool low = line.command.modal.return_to_clearance;
    words.first_nm = level < clearance ? clearance : std::max(here, clearance);
    words.over_nm = low || here > clearance ? words.first_nm : std::max(words.first_nm, level);
    words.return_nm = low ? clearance : std::max(level, clearance);
}

Status read_heights(LineContext& line, DrillWords& words) noexcept
{
    const unsigned axis = words.height_axis;
    if (const Status status = remember(line, 'R', line.drill->clearance); !status) {
        return status;
    }
    if (const Status status = remember(line, axis_letter(axis), line.drill->bottom); !status) {
        return status;
    }
    // In G91 R counts from the initial level and the depth from R (LinuxCNC).
    const bool incremental = line.command.modal.incremental;
    const ExactLength origin{work_offset(line.command.modal, line.parameters)[axis], 0};
    const ExactLength level = initial_level(line, axis, origin.nm);
    const ExactLength clearance = (incremental ? level : origin) + line.drill->clearance;
    const ExactLength bottom = (incremental ? clearance : origin) + line.drill->bottom;
    words.clearance_nm = clearance.rounded();
    words.bottom_nm = bottom.rounded();
    read_travel(line, level.rounded(), words);
    const bool within = words.clearance_nm <= kMaxCoordinateNm &&
                        words.over_nm <= kMaxCoordinateNm && words.bottom_nm >= -kMaxCoordinateNm;
    if (!within) {
        return Error::kGcodeMaxValueExceeded;
    }
    return words.bottom_nm <= words.clearance_nm ? Status{kDone}
                                                 : Status{Error::kGcodeInvalidTarget};
}

// G86 stops the spindle in the hole, so that it must turn.
Status read_spindle(const ModalState& modal, DrillWords& words) noexcept
{
    words.spindle = {modal.spindle, modal.spindle_speed};
    return modal.motion == Motion::kBoreStopping && modal.spindle == SpindleMode::kOff
               ? Status{Error::kGcodeInvalidTarget}
               : Status{kDone};
}

}  // namespace

Status plan_drilling(LineContext& line, MotionPlan& plan) noexcept
{
    const Command& command = line.command;
    if (command.axes() == 0) {
        return Error::kGcodeNoAxisWords;
    }
    if (command.modal.inverse_time) {
        return Error::kGcodeUndefinedFeedRate;
    }
    DrillWords words{};
    words.height_axis = normal_axis(command.modal.plane);
    words.cycle = command.modal.motion;
    Status status = read_spindle(command.modal, words);
    if (status) {
        status = read_dwell(line, words);
    }
    if (status) {
        status = read_peck(line, words);
    }
    if (status) {
        status = read_heights(line, words);
    }
    if (status) {
        status = read_repeats(line.command, words);
    }
    if (!status) {
        return status;
    }
    read_holes(line, words);
    line.end[words.height_axis] = {words.return_nm, 0};
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        if (line.end[axis].nm > kMaxCoordinateNm || line.end[axis].nm < -kMaxCoordinateNm) {
            return Error::kGcodeMaxValueExceeded;
        }
    }
    plan.motion = DrillCycle{words, move_pattern(command.modal, line, path::MoveKind::kFeed)};
    plan.add(MotionPlan::Step::kMotion);
    return kDone;
}

}  // namespace cusp::gcode
