// Commands that change offsets or stored positions.
#include "firmware/gcode/line_context.hpp"

namespace cusp::gcode {
namespace {

void keep(MotionPlan& plan, bool through_power_cycle, std::uint8_t tool = 0) noexcept
{
    plan.parameters = {through_power_cycle, tool};
    plan.add(MotionPlan::Step::kParameters);
}

// Sum of the offsets on an axis, without the one that is being set.
std::int64_t tool_length(const LineContext& line, unsigned axis) noexcept
{
    return axis == 2 ? line.parameters.tool_length_offset_nm : 0;
}

// True if a line names an axis, a rotary one too.
bool names_axes(const Command& command) noexcept
{
    return (command.words & (kLinearLetters | kRotaryLetters)) != 0;
}

bool is_same(Decimal a, Decimal b) noexcept { return to_double(a) == to_double(b); }

// The meaning of G10's L word.
enum class G10Value : std::uint8_t {
    kToolLength = 1,
    kOffset = 2,
    kToolLengthHere = 10,
    kToolLengthAtSetter = 11,
    kOffsetHere = 20,
};

Status read_tool_number(Command& command, char upper_case, std::uint8_t& tool) noexcept
{
    constexpr std::int64_t kMaxNumber = 255;
    const Decimal number = command.value(upper_case);
    if (to_double(number) > static_cast<double>(kMaxNumber)) {
        return Error::kGcodeMaxValueExceeded;
    }
    if (!is_whole(number, kMaxNumber)) {
        return Error::kGcodeCommandValueNotInteger;
    }
    command.use(upper_case);
    tool = static_cast<std::uint8_t>(whole_part(number));
    return kDone;
}

// The tool length for which the tip is now at the Z of the line: in the coordinate system in force
// with G92, or in G59.3 without it.
std::int64_t length_from_here(const LineContext& line, G10Value how, std::int64_t z) noexcept
{
    constexpr std::size_t kSetter = kCoordinateSystems - 1;
    const Parameters& parameters = line.parameters;
    const std::int64_t origin =
        how == G10Value::kToolLengthAtSetter
            ? parameters.work_offsets[kSetter].z
            : parameters.work_offsets[line.command.modal.coordinate_system].z +
                  parameters.coordinate_offset.z;
    return line.start.rounded().z - origin - z;
}

Status set_table_entry(LineContext& line, G10Value how, MotionPlan& plan) noexcept
{
    Command& command = line.command;
    std::uint8_t tool = 0;
    if (const Status status = read_tool_number(command, 'P', tool); !status) {
        return status;
    }
    if (!ToolTable::holds(tool)) {
        return Error::kGcodeMaxValueExceeded;
    }
    command.use('L');
    if (!names_axes(command)) {
        return kDone;  // R alone
    }
    if (command.axes() != letter('Z')) {
        return Error::kGcodeG43DynamicAxisError;
    }
    const Result<ExactLength> z = length_of(command, 'Z');
    if (!z) {
        return z.error();
    }
    const std::int64_t length =
        how == G10Value::kToolLength ? z->rounded() : length_from_here(line, how, z->rounded());
    if (!fits_tool_table(length)) {
        return Error::kGcodeMaxValueExceeded;
    }
    line.parameters.tools.enter(tool, length);
    keep(plan, true, tool);
    return kDone;
}

Status set_work_offset(LineContext& line, G10Value how, MotionPlan& plan) noexcept
{
    Command& command = line.command;
    command.use('P');
    command.use('L');
    const std::int64_t which = whole_part(command.value('P'));
    const std::size_t system =
        which == 0 ? command.modal.coordinate_system : static_cast<std::size_t>(which - 1);
    Position& offset = line.parameters.work_offsets[system];
    const Position here = line.start.rounded();
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        if (!command.names_axis(axis)) {
            continue;
        }
        const Result<ExactLength> value = length_of(command, axis_letter(axis));
        if (!value) {
            return value.error();
        }
        offset[axis] = how == G10Value::kOffset
                           ? value->rounded()
                           : here[axis] - line.parameters.coordinate_offset[axis] -
                                 tool_length(line, axis) - value->rounded();
    }
    keep(plan, true);
    return kDone;
}

Status set_offset(LineContext& line, MotionPlan& plan) noexcept
{
    Command& command = line.command;
    if (!names_axes(command) && !command.has('R')) {
        return Error::kGcodeNoAxisWords;
    }
    if (!command.has('P') || !command.has('L')) {
        return Error::kGcodeValueWordMissing;
    }
    constexpr auto kGreatest = static_cast<std::int64_t>(G10Value::kOffsetHere);
    const bool whole = is_whole(command.value('L'), kGreatest);
    const auto how = static_cast<G10Value>(whole ? whole_part(command.value('L')) : 0);
    const bool of_tool = how == G10Value::kToolLength || how == G10Value::kToolLengthHere ||
                         how == G10Value::kToolLengthAtSetter;
    if (!of_tool && !is_whole(command.value('P'), kCoordinateSystems)) {
        return Error::kGcodeUnsupportedCoordSys;
    }
    if (!of_tool && how != G10Value::kOffset && how != G10Value::kOffsetHere) {
        return Error::kGcodeUnsupportedCommand;
    }
    // R is a tool's radius, which nothing asks for without G41 and G42, or turns a coordinate system:
    // by nothing, or not here.
    if (command.has('R')) {
        if (!of_tool && (how != G10Value::kOffset || !command.value('R').is_zero())) {
            return Error::kGcodeUnsupportedCommand;
        }
        command.use('R');
    }
    return of_tool ? set_table_entry(line, how, plan) : set_work_offset(line, how, plan);
}

// G92: the tool is at the words. G52: the words are the offset itself; one offset serves both, as in
// LinuxCNC.
Status set_coordinate_offset(LineContext& line, MotionPlan& plan) noexcept
{
    const Command& command = line.command;
    if (!names_axes(command)) {
        return Error::kGcodeNoAxisWords;
    }
    const bool local = command.non_modal == NonModal::kSetLocalOffset;
    const Position here = line.start.rounded();
    const Position& work = line.parameters.work_offsets[command.modal.coordinate_system];
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        if (!command.names_axis(axis)) {
            continue;
        }
        const Result<ExactLength> value = length_of(command, axis_letter(axis));
        if (!value) {
            return value.error();
        }
        line.parameters.coordinate_offset[axis] =
            local ? value->rounded()
                  : here[axis] - work[axis] - tool_length(line, axis) - value->rounded();
    }
    keep(plan, false);
    return kDone;
}

// G43, with H or of the tool in the spindle: while the table is empty every length is 0. After the
// first entry, tools without an entry are refused.
Result<std::int64_t> length_from_table(Command& command, const ToolTable& tools) noexcept
{
    constexpr std::int64_t kMaxTool = 255;
    unsigned tool = command.modal.in_spindle;
    if (command.has('H')) {
        if (!is_whole(command.value('H'), kMaxTool)) {
            return Error::kGcodeMaxValueExceeded;
        }
        command.use('H');
        tool = static_cast<unsigned>(whole_part(command.value('H')));
    }
    if (tools.empty() || tool == 0) {
        return std::int64_t{0};
    }
    if (!ToolTable::holds(tool) || !tools.has(tool)) {
        return Error::kGcodeMaxValueExceeded;
    }
    return tools.length_nm(tool);
}

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
        const Result<std::int64_t> length = length_from_table(command, line.parameters.tools);
        if (!length) {
            return length.error();
        }
        offset = *length;
    }
    line.parameters.tool_length_offset_nm = offset;
    keep(plan, false);
    return kDone;
}

}  // namespace

Status check_rotary(Command& command, RotaryAxes& rotary, MotionPlan& plan) noexcept
{
    // Words that are no positions: of offsets, and steps.
    const bool relative = command.modal.incremental || command.non_modal == NonModal::kSetOffset ||
                          command.non_modal == NonModal::kSetLocalOffset;
    for (unsigned i = 0; i < rotary.at.size(); ++i) {
        const char axis = static_cast<char>('A' + i);
        if (!command.has(axis) || (command.absent_letters() & letter(axis)) == 0) {
            continue;
        }
        const Decimal word = command.value(axis);
        if (!relative && (rotary.known & letter(axis)) == 0) {
            rotary.at[i] = word;
            rotary.known |= letter(axis);
        }
        if (!is_same(word, relative ? Decimal{} : rotary.at[i])) {
            return Error::kGcodeUnsupportedCommand;
        }
        command.use(axis);
    }
    if (!rotary.noted) {
        rotary.noted = true;
        plan.add(MotionPlan::Step::kRotaryIgnored);
    }
    return kDone;
}

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
        case NonModal::kSetLocalOffset:
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
