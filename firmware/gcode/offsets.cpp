// Commands that change offsets or stored positions.
#include "firmware/gcode/line_context.hpp"

namespace cusp::gcode {
namespace {

void keep(MotionPlan& plan, bool through_power_cycle) noexcept
{
    plan.parameters.keep = through_power_cycle;
    plan.add(MotionPlan::Step::kParameters);
}

// Sum of the offsets on an axis, without the one that is being set.
std::int64_t tool_length(const LineContext& line, unsigned axis) noexcept
{
    return axis == 2 ? line.parameters.tool_length_offset_nm : 0;
}

Status set_offset(LineContext& line, MotionPlan& plan) noexcept
{
    Command& command = line.command;
    if (command.axes() == 0) {
        return Error::kGcodeNoAxisWords;
    }
    if (!command.has('P') || !command.has('L')) {
        return Error::kGcodeValueWordMissing;
    }
    if (!is_whole(command.value('P'), kCoordinateSystems)) {
        return Error::kGcodeUnsupportedCoordSys;
    }
    constexpr std::int64_t kFromPosition = 20;
    constexpr std::int64_t kAsWritten = 2;
    const bool whole = is_whole(command.value('L'), kFromPosition);
    const std::int64_t how = whole ? whole_part(command.value('L')) : 0;
    if ((how != kAsWritten && how != kFromPosition) || command.has('R')) {
        return Error::kGcodeUnsupportedCommand;
    }
    command.use('P');
    command.use('L');
    const std::int64_t which = whole_part(command.value('P'));
    const std::size_t system =
        which == 0 ? command.modal.coordinate_system : static_cast<std::size_t>(which - 1);
    Position& offset = line.parameters.work_offsets[system];
    const Position here = line.start.rounded();
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        if (!command.has(axis_letter(axis))) {
            continue;
        }
        const Result<ExactLength> value = length_of(command, axis_letter(axis));
        if (!value) {
            return value.error();
        }
        offset[axis] = how == kAsWritten ? value->rounded()
                                         : here[axis] - line.parameters.coordinate_offset[axis] -
                                               tool_length(line, axis) - value->rounded();
    }
    keep(plan, true);
    return kDone;
}

Status set_coordinate_offset(LineContext& line, MotionPlan& plan) noexcept
{
    const Command& command = line.command;
    if (command.axes() == 0) {
        return Error::kGcodeNoAxisWords;
    }
    const Position here = line.start.rounded();
    const Position& work = line.parameters.work_offsets[command.modal.coordinate_system];
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        if (!command.has(axis_letter(axis))) {
            continue;
        }
        const Result<ExactLength> value = length_of(command, axis_letter(axis));
        if (!value) {
            return value.error();
        }
        line.parameters.coordinate_offset[axis] =
            here[axis] - work[axis] - tool_length(line, axis) - value->rounded();
    }
    keep(plan, false);
    return kDone;
}

// The tool table is empty: G43 H finds a length of 0.
Status set_tool_length(LineContext& line, MotionPlan& plan) noexcept
{
    Command& command = line.command;
    std::int64_t offset = 0;
    if (command.tool_length == ToolLength::kDynamic) {
        if (command.axes() != letter('Z')) {
            return Error::kGcodeG43DynamicAxisError;
        }
        const Result<ExactLength> value = length_of(command, 'Z');
        if (!value) {
            return value.error();
        }
        offset = value->rounded();
    }
    if (command.tool_length == ToolLength::kFromTable) {
        constexpr std::int64_t kMaxTool = 255;
        if (!command.has('H')) {
            return Error::kGcodeValueWordMissing;
        }
        if (!is_whole(command.value('H'), kMaxTool)) {
            return Error::kGcodeMaxValueExceeded;
        }
        command.use('H');
    }
    line.parameters.tool_length_offset_nm = offset;
    keep(plan, false);
    return kDone;
}

}  // namespace

Status plan_offsets(LineContext& line, MotionPlan& plan) noexcept
{
    if (line.command.tool_length != ToolLength::kUnchanged) {
        if (const Status status = set_tool_length(line, plan); !status) {
            return status;
        }
    }
    switch (line.command.non_modal) {
        case NonModal::kSetOffset:
            return set_offset(line, plan);
        case NonModal::kSetCoordinateOffset:
            return set_coordinate_offset(line, plan);
        case NonModal::kClearCoordinateOffset:
            line.parameters.coordinate_offset = {};
            keep(plan, false);
            break;
        case NonModal::kStoreHome:
            line.parameters.home = line.start.rounded();
            keep(plan, true);
            break;
        case NonModal::kStoreSecondHome:
            line.parameters.second_home = line.start.rounded();
            keep(plan, true);
            break;
        case NonModal::kNone:
        case NonModal::kDwell:
        case NonModal::kGoHome:
        case NonModal::kGoSecondHome:
        case NonModal::kMachineCoordinates:
            break;
    }
    return kDone;
}

}  // namespace cusp::gcode
