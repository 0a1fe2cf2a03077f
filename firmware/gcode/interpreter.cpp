// Checks one line in Grbl's order, then sets the state after it.
#include "firmware/gcode/interpreter.hpp"

#include "firmware/base/inch.hpp"

namespace cusp::gcode {
namespace {

constexpr std::int64_t kMaxLineNumber = 10'000'000;
constexpr std::int64_t kMaxTool = 255;
constexpr double kMaxSpindleSpeed = 1e6;  // rpm
constexpr double kMaxDwell = 1e6;         // s
constexpr double kMaxTolerance = 1e3;     // mm

Status check_number(LineContext& line) noexcept
{
    Command& command = line.command;
    if (!command.has('N')) {
        return kDone;
    }
    // N10.5 is line 10, as in Grbl and LinuxCNC.
    const std::int64_t number = whole_part(command.value('N'));
    if (number > kMaxLineNumber) {
        return Error::kGcodeInvalidLineNumber;
    }
    command.use('N');
    line.number = static_cast<std::uint32_t>(number);
    return kDone;
}

Status check_tool_and_spindle(LineContext& line) noexcept
{
    Command& command = line.command;
    if (command.has('S')) {
        const double speed = to_double(command.value('S'));
        if (speed > kMaxSpindleSpeed) {
            return Error::kGcodeMaxValueExceeded;
        }
        command.modal.spindle_speed = static_cast<float>(speed);
        command.use('S');
    }
    if (command.has('T')) {
        const Decimal tool = command.value('T');
        if (to_double(tool) > static_cast<double>(kMaxTool)) {
            return Error::kGcodeMaxValueExceeded;
        }
        if (!is_whole(tool, kMaxTool)) {
            return Error::kGcodeCommandValueNotInteger;
        }
        command.modal.tool = static_cast<std::uint8_t>(whole_part(tool));
        command.use('T');
    }
    if (command.names(Group::kToolChange)) {
        command.modal.in_spindle = command.modal.tool;
    }
    return kDone;
}

Status check_dwell(LineContext& line, MotionPlan& plan) noexcept
{
    Command& command = line.command;
    if (command.non_modal != NonModal::kDwell) {
        return kDone;
    }
    if (!command.has('P')) {
        return Error::kGcodeValueWordMissing;
    }
    plan.dwell.seconds = to_double(command.value('P'));
    if (plan.dwell.seconds > kMaxDwell) {
        return Error::kGcodeMaxValueExceeded;
    }
    command.use('P');
    plan.add(MotionPlan::Step::kDwell);
    return kDone;
}

// True if a P word of the line belongs to another command than G64.
bool motion_takes_p(const Command& command) noexcept
{
    if (command.non_modal == NonModal::kDwell || command.non_modal == NonModal::kSetOffset) {
        return true;
    }
    const Motion motion = command.modal.motion;
    return command.axis_use == AxisUse::kMotion && motion != Motion::kRapid &&
           motion != Motion::kLine && (!is_cycle(motion) || dwells(motion));
}

// True if a Q word of the line belongs to another command than G64.
bool motion_takes_q(const Command& command) noexcept
{
    return command.axis_use == AxisUse::kMotion &&
           (pecks(command.modal.motion) || command.modal.motion == Motion::kNurbs);
}

Status check_path_control(LineContext& line) noexcept
{
    Command& command = line.command;
    if (!command.names(Group::kPathControl) || command.modal.exact_path) {
        return kDone;
    }
    // Q is LinuxCNC's tolerance for merging lines; here the planner merges none.
    if (command.has('Q') && !motion_takes_q(command)) {
        command.use('Q');
    }
    if (!command.has('P')) {
        return kDone;
    }
    if (motion_takes_p(command)) {
        return Error::kGcodeAxisCommandConflict;
    }
    const double tolerance =
        to_double(command.value('P')) * (command.modal.inches ? kMillimetresPerInch : 1);
    if (tolerance > kMaxTolerance) {
        return Error::kGcodeMaxValueExceeded;
    }
    command.use('P');
    command.modal.path_tolerance = static_cast<float>(tolerance);
    command.modal.default_tolerance = false;
    return kDone;
}

void plan_flow(const Command& command, MotionPlan& plan) noexcept
{
    switch (command.flow) {
        case ProgramFlow::kRunning:
            return;
        case ProgramFlow::kPause:
        case ProgramFlow::kOptionalPause:
            plan.flow = Pause{command.flow == ProgramFlow::kOptionalPause};
            break;
        case ProgramFlow::kEnd:
            plan.flow = ProgramEnd{};
            break;
    }
    plan.add(MotionPlan::Step::kFlow);
}

// Plans changes of spindle, coolant and tool, and of the speed while the spindle turns.
void plan_switches(const LineContext& line, const ModalState& before, MotionPlan& plan) noexcept
{
    const Command& command = line.command;
    const ModalState& modal = command.modal;
    if (command.names(Group::kToolChange)) {
        plan.tool_change = {modal.tool, line.number};
        plan.add(MotionPlan::Step::kToolChange);
    }
    const bool turns = modal.spindle != SpindleMode::kOff;
    const bool new_speed = modal.spindle_speed != before.spindle_speed;
    if (command.names(Group::kSpindle) || (turns && new_speed)) {
        plan.spindle = {modal.spindle, modal.spindle_speed};
        plan.add(MotionPlan::Step::kSpindle);
    }
    if (command.names(Group::kCoolant)) {
        plan.coolant = command.coolant;
        plan.add(MotionPlan::Step::kCoolant);
    }
}

// True for a line with a centre and no end: a full circle, also without G2 or G3.
bool is_circle(const Command& command) noexcept
{
    constexpr LetterSet kOffsets = letter('I') | letter('J') | letter('K');
    return is_arc(command.modal.motion) && (command.words & kOffsets) != 0;
}

bool is_jog_group(const Command& command) noexcept
{
    constexpr auto bit = [](Group group) {
        return 1U << static_cast<unsigned>(group);
    };
    constexpr std::uint32_t kAllowed =
        bit(Group::kDistance) | bit(Group::kUnits) | bit(Group::kNonModal);
    const bool non_modal =
        command.non_modal == NonModal::kNone || command.non_modal == NonModal::kMachineCoordinates;
    return (command.groups & ~kAllowed) == 0 && non_modal;
}

}  // namespace

LineContext Interpreter::begin(std::uint32_t number) const noexcept
{
    LineContext line{};
    line.parameters = parameters_;
    line.start = position_;
    line.end = position_;
    line.default_tolerance = default_tolerance_;
    line.number = number;
    return line;
}

Status Interpreter::execute(std::string_view text, std::uint32_t number) noexcept
{
    CUSP_ASSERT(plan_.empty());
    LineContext line = begin(number);
    Status status = read_command(text, modal_, line.command);
    line.command.axis_count = axes_;
    if (status) {
        status = run(line);
    }
    if (!status) {
        plan_.clear();
        if (in_curve()) {
            give_up_curve();
        }
    }
    return status;
}

Status Interpreter::run(LineContext& line) noexcept
{
    Command& command = line.command;
    if (command.is_blank()) {
        return kDone;
    }
    if (const Status status = check_number(line); !status) {
        return status;
    }
    if ((command.words & command.absent_letters()) != 0) {
        rotary_after_ = rotary_;
        if (const Status status = check_rotary(command, rotary_after_, plan_); !status) {
            return status;
        }
    }
    if (in_curve()) {
        return continue_curve(line);
    }
    if (command.axis_use == AxisUse::kNone && (command.axes() != 0 || is_circle(command))) {
        command.axis_use = AxisUse::kMotion;
    }
    if (const Status status = check(line); !status) {
        return status;
    }
    commit(line);
    return kDone;
}

Status Interpreter::check(LineContext& line) noexcept
{
    Command& command = line.command;
    if (const Status status = check_feed(line, modal_.inverse_time); !status) {
        return status;
    }
    if (const Status status = check_tool_and_spindle(line); !status) {
        return status;
    }
    if (const Status status = check_tool_change(line); !status) {
        return status;
    }
    if (const Status status = check_dwell(line, plan_); !status) {
        return status;
    }
    if (const Status status = check_path_control(line); !status) {
        return status;
    }
    if (const Status status = plan_offsets(line, plan_); !status) {
        return status;
    }
    if (command.ends_curve) {
        return Error::kGcodeInvalidTarget;
    }
    const bool moves = command.axis_use == AxisUse::kMotion ||
                       command.non_modal == NonModal::kGoHome ||
                       command.non_modal == NonModal::kGoSecondHome;
    if (moves) {
        if (const Status status = find_target(line); !status) {
            return status;
        }
    }
    if (is_cycle(command.modal.motion)) {
        remember_cycle(line);
    }
    if (const Status status = plan_motion(line, plan_); !status) {
        return status;
    }
    if (const Status status = check_new_curve(line); !status) {
        return status;
    }
    if (command.axis_use != AxisUse::kNone) {
        command.unused &= ~command.axis_letters();
    }
    return command.unused == 0 ? Status{kDone} : Status{Error::kGcodeUnusedWords};
}

Status Interpreter::check_tool_change(const LineContext& line) const noexcept
{
    const Command& command = line.command;
    if (!command.names(Group::kToolChange) || tool_change_rule_ == ToolChangeRule::kFree) {
        return kDone;
    }
    if (tool_change_rule_ == ToolChangeRule::kNotHomed) {
        return Error::kHomingRequired;
    }
    if (tool_change_rule_ == ToolChangeRule::kNoPlace) {
        return Error::kNoToolChangePlace;
    }
    if (!ToolTable::holds(command.modal.tool)) {
        return Error::kGcodeMaxValueExceeded;
    }
    const bool depends =
        command.axis_use != AxisUse::kNone || command.tool_length != ToolLength::kUnchanged ||
        (command.non_modal != NonModal::kNone && command.non_modal != NonModal::kDwell);
    return depends ? Status{Error::kGcodeAxisCommandConflict} : Status{kDone};
}

// Another cycle has words of its own, and the same initial level.
void Interpreter::remember_cycle(LineContext& line) noexcept
{
    drill_after_ = drill_;
    if (line.command.modal.motion != modal_.motion) {
        drill_after_.known = 0;
    }
    line.drill = &drill_after_;
}

void Interpreter::commit_rotary(const Command& command) noexcept
{
    if ((command.words & command.absent_letters()) != 0) {
        rotary_ = rotary_after_;
    }
}

void Interpreter::commit(const LineContext& line) noexcept
{
    plan_switches(line, modal_, plan_);
    plan_flow(line.command, plan_);
    const Motion before = modal_.motion;
    modal_ = line.command.modal;
    commit_rotary(line.command);
    if (line.command.axis_use == AxisUse::kMotion && modal_.motion != Motion::kRapid) {
        rotary_.known |= kRotaryLetters;
    }
    if (plan_.has(MotionPlan::Step::kParameters)) {
        parameters_ = line.parameters;
    }
    if (is_cycle(modal_.motion)) {
        drill_ = drill_after_;
    } else {
        drill_.known = 0;
        drill_.level_axis = kAxisCount;
    }
    if (modal_.motion != before &&
        (modal_.motion == Motion::kUniformNurbs || modal_.motion == Motion::kNurbs)) {
        open_curve(line);
    }
    position_ = line.end;
    if (line.command.flow == ProgramFlow::kEnd) {
        end_program();
    }
}

// Resets modes as Grbl 1.1 does at M2 and M30; units, feed, offsets and the tool stay.
void Interpreter::end_program() noexcept
{
    modal_.motion = Motion::kLine;
    modal_.plane = path::Plane::kXY;
    modal_.incremental = false;
    if (modal_.inverse_time) {
        modal_.inverse_time = false;
        modal_.feed = 0;
    }
    modal_.absolute_centres = false;
    modal_.return_to_clearance = false;
    modal_.exact_path = false;
    modal_.default_tolerance = true;
    modal_.coordinate_system = 0;
    modal_.spindle = SpindleMode::kOff;
    modal_.flood = false;
    modal_.mist = false;
    drill_ = {};
    rotary_ = {};
}

void Interpreter::set_coolant(bool flood, bool mist) noexcept
{
    modal_.flood = flood;
    modal_.mist = mist;
}

Status Interpreter::execute_jog(std::string_view text, std::uint32_t number) noexcept
{
    CUSP_ASSERT(plan_.empty());
    LineContext line = begin(number);
    if (const Status status = read_command(text, modal_, line.command); !status) {
        return status;
    }
    line.command.axis_count = axes_;
    const Status status = run_jog(line);
    if (!status) {
        plan_.clear();
    }
    return status;
}

Status Interpreter::run_jog(LineContext& line) noexcept
{
    Command& command = line.command;
    if (in_curve() || !is_jog_group(command)) {
        return Error::kInvalidJogCommand;
    }
    if ((command.words & command.absent_letters()) != 0) {
        return Error::kGcodeUnsupportedCommand;
    }
    if (const Status status = check_number(line); !status) {
        return status;
    }
    if (command.axes() == 0) {
        return Error::kGcodeNoAxisWords;
    }
    command.axis_use = AxisUse::kMotion;
    command.modal.motion = Motion::kLine;
    command.modal.inverse_time = false;
    command.modal.feed = 0;
    if (const Status status = check_feed(line, false); !status) {
        return status;
    }
    command.unused &= ~command.axis_letters();
    if (command.unused != 0) {
        return Error::kGcodeUnusedWords;
    }
    if (const Status status = find_target(line); !status) {
        return status;
    }
    plan_line(line, path::MoveKind::kFixedFeed, plan_);
    position_ = line.end;
    return kDone;
}

bool Interpreter::next(Action& action) noexcept { return plan_.next(curve_, action); }

void Interpreter::discard() noexcept
{
    plan_.clear();
    if (in_curve()) {
        give_up_curve();
    }
    curve_.abandon();
}

void Interpreter::set_position(Position machine) noexcept
{
    CUSP_ASSERT(plan_.empty());
    if (in_curve()) {
        give_up_curve();
    }
    position_ = to_exact(machine);
}

void Interpreter::take_tool_length(std::int64_t length_nm) noexcept
{
    position_.z.nm += length_nm - parameters_.tool_length_offset_nm;
    parameters_.tool_length_offset_nm = length_nm;
    parameters_.tools.enter(modal_.tool, length_nm);
}

void Interpreter::reset() noexcept
{
    discard();
    const std::uint8_t in_spindle = modal_.in_spindle;
    modal_ = ModalState{};
    modal_.in_spindle = in_spindle;
    parameters_.coordinate_offset = {};
    parameters_.tool_length_offset_nm = 0;
    drill_ = {};
    rotary_ = {};
}

float Interpreter::path_tolerance() const noexcept
{
    return gcode::path_tolerance(modal_, default_tolerance_);
}

}  // namespace cusp::gcode
