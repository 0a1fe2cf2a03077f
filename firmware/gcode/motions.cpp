// Targets, feeds and the moves of one line.
#include "firmware/base/inch.hpp"
#include "firmware/gcode/line_context.hpp"

namespace cusp::gcode {
namespace {

constexpr float kSecondsPerMinute = 60.0F;

bool needs_feed(Motion motion) noexcept
{
    return motion != Motion::kNone && motion != Motion::kRapid;
}

bool is_within_reach(const ExactLength& length) noexcept
{
    return length.nm <= kMaxCoordinateNm && length.nm >= -kMaxCoordinateNm;
}

struct PlaneLetters {
    char first;
    char second;
    char first_offset;
    char second_offset;
};

PlaneLetters letters_of(path::Plane plane) noexcept
{
    switch (plane) {
        case path::Plane::kZX:
            return {'Z', 'X', 'K', 'I'};
        case path::Plane::kYZ:
            return {'Y', 'Z', 'J', 'K'};
        case path::Plane::kXY:
            break;
    }
    return {'X', 'Y', 'I', 'J'};
}

Result<std::int64_t> offset_of(Command& command, char upper_case) noexcept
{
    if (!command.has(upper_case)) {
        return std::int64_t{0};
    }
    const Result<ExactLength> value = length_of(command, upper_case);
    if (!value) {
        return value.error();
    }
    command.use(upper_case);
    return value->rounded();
}

Status read_turns(Command& command, path::ArcWords& words) noexcept
{
    constexpr std::int64_t kMaxTurns = 1000;
    words.turns = 1;
    if (!command.has('P')) {
        return kDone;
    }
    const Decimal turns = command.value('P');
    if (!is_whole(turns, kMaxCoordinateNm) || turns.is_zero()) {
        return Error::kGcodeInvalidTarget;
    }
    if (!is_whole(turns, kMaxTurns)) {
        return Error::kGcodeMaxValueExceeded;
    }
    command.use('P');
    words.turns = static_cast<std::int32_t>(whole_part(turns));
    return kDone;
}

Result<path::ArcWords> read_centre(Command& command,
                                   path::ArcWords words,
                                   const PlaneLetters& letters) noexcept
{
    if (command.has('R')) {
        const Result<std::int64_t> radius = offset_of(command, 'R');
        return radius ? path::with_radius(words, *radius) : Result<path::ArcWords>{radius.error()};
    }
    if (!command.has(letters.first_offset) && !command.has(letters.second_offset)) {
        return Error::kGcodeNoOffsetsInPlane;
    }
    const Result<std::int64_t> first = offset_of(command, letters.first_offset);
    if (!first) {
        return first.error();
    }
    const Result<std::int64_t> second = offset_of(command, letters.second_offset);
    if (!second) {
        return second.error();
    }
    words.first_offset_nm = *first;
    words.second_offset_nm = *second;
    return words;
}

Status plan_arc(LineContext& line, MotionPlan& plan) noexcept
{
    Command& command = line.command;
    const PlaneLetters letters = letters_of(command.modal.plane);
    if (command.axes() == 0) {
        return Error::kGcodeNoAxisWords;
    }
    if (!command.has(letters.first) && !command.has(letters.second)) {
        return Error::kGcodeNoAxisWordsInPlane;
    }
    path::ArcWords words{};
    words.start = line.start.rounded();
    words.end = line.end.rounded();
    words.plane = command.modal.plane;
    words.clockwise = command.modal.motion == Motion::kArcClockwise;
    if (const Status status = read_turns(command, words); !status) {
        return status;
    }
    const Result<path::ArcWords> centred = read_centre(command, words, letters);
    if (!centred) {
        return centred.error();
    }
    const Result<path::Arc> arc = path::make_arc(*centred);
    if (!arc) {
        return arc.error();
    }
    path::Move move = move_pattern(line.command.modal, line, path::MoveKind::kFeed);
    move.path = *arc;
    move.start = words.start;
    move.end = words.end;
    set_speed(command.modal, move);
    plan.motion = Moves{move, {}, true, false};
    plan.add(MotionPlan::Step::kMotion);
    return kDone;
}

Status plan_probe(LineContext& line, MotionPlan& plan) noexcept
{
    const Motion motion = line.command.modal.motion;
    if (line.command.axes() == 0) {
        return Error::kGcodeNoAxisWords;
    }
    path::Move move = move_pattern(line.command.modal, line, path::MoveKind::kFixedFeed);
    move.start = line.start.rounded();
    move.end = line.end.rounded();
    if (move.start == move.end) {
        return Error::kGcodeInvalidTarget;
    }
    set_speed(line.command.modal, move);
    move.tolerance = 0;
    plan.motion = Probe{move, motion == Motion::kProbeAway || motion == Motion::kProbeAwayQuietly,
                        motion == Motion::kProbeTowards || motion == Motion::kProbeAway};
    plan.add(MotionPlan::Step::kMotion);
    return kDone;
}

// Plans a move to the point of the axis words, then one to the stored position, of the named axes or
// of all.
void plan_home(LineContext& line, const Position& home, MotionPlan& plan) noexcept
{
    const Command& command = line.command;
    path::Move move = move_pattern(line.command.modal, line, path::MoveKind::kRapid);
    move.start = line.start.rounded();
    move.end = line.end.rounded();
    const Position through = move.end;
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        if (command.axes() == 0 || command.has(axis_letter(axis))) {
            line.end[axis] = {home[axis], 0};
        }
    }
    const Position end = line.end.rounded();
    plan.motion = Moves{move, end, move.start != through, through != end};
    plan.add(MotionPlan::Step::kMotion);
}

Status plan_motion_mode(LineContext& line, MotionPlan& plan) noexcept
{
    const bool has_axes = line.command.axes() != 0;
    switch (line.command.modal.motion) {
        case Motion::kNone:
            return has_axes ? Status{Error::kGcodeAxisWordsExist} : Status{kDone};
        case Motion::kRapid:
            plan_line(line, path::MoveKind::kRapid, plan);
            return kDone;
        case Motion::kLine:
            plan_line(line, path::MoveKind::kFeed, plan);
            return kDone;
        case Motion::kArcClockwise:
        case Motion::kArcCounterClockwise:
            return plan_arc(line, plan);
        case Motion::kProbeTowards:
        case Motion::kProbeTowardsQuietly:
        case Motion::kProbeAway:
        case Motion::kProbeAwayQuietly:
            return plan_probe(line, plan);
        case Motion::kDrill:
        case Motion::kDrillWithDwell:
        case Motion::kDrillPecking:
            return plan_drilling(line, plan);
        case Motion::kUniformNurbs:
        case Motion::kNurbs:
            break;
    }
    return kDone;
}

}  // namespace

float path_tolerance(const ModalState& modal, float default_tolerance) noexcept
{
    if (modal.exact_path) {
        return 0;
    }
    return modal.default_tolerance ? default_tolerance : modal.path_tolerance;
}

Status check_feed(LineContext& line, bool was_inverse_time) noexcept
{
    constexpr double kMaxFeed = 1e9;
    Command& command = line.command;
    ModalState& modal = command.modal;
    const bool moves = command.axis_use == AxisUse::kMotion && needs_feed(modal.motion);
    if (modal.inverse_time || was_inverse_time) {
        modal.feed = 0;
    }
    if (command.has('F')) {
        const bool per_length = !modal.inverse_time && modal.inches;
        const double feed = to_double(command.value('F')) * (per_length ? kMillimetresPerInch : 1);
        if (feed > kMaxFeed) {
            return Error::kGcodeMaxValueExceeded;
        }
        modal.feed = static_cast<float>(feed);
    }
    command.use('F');
    if (moves && !(modal.feed > 0)) {
        return Error::kGcodeUndefinedFeedRate;
    }
    return kDone;
}

Status find_target(LineContext& line) noexcept
{
    const Command& command = line.command;
    const Position offset = work_offset(command.modal, line.parameters);
    const bool machine = command.non_modal == NonModal::kMachineCoordinates;
    line.end = line.start;
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        if (!command.has(axis_letter(axis))) {
            continue;
        }
        const Result<ExactLength> value = length_of(command, axis_letter(axis));
        if (!value) {
            return value.error();
        }
        ExactLength origin{machine ? 0 : offset[axis], 0};
        if (command.modal.incremental && !machine) {
            origin = line.start[axis];
        }
        line.end[axis] = origin + *value;
        if (!is_within_reach(line.end[axis])) {
            return Error::kGcodeMaxValueExceeded;
        }
    }
    return kDone;
}

path::Move move_pattern(const ModalState& modal,
                        const LineContext& line,
                        path::MoveKind kind) noexcept
{
    path::Move move;
    move.kind = kind;
    move.feed = modal.feed / kSecondsPerMinute;
    move.tolerance = path_tolerance(modal, line.default_tolerance);
    move.line = line.number;
    return move;
}

void set_speed(const ModalState& modal, path::Move& move) noexcept
{
    if (modal.inverse_time) {
        move.feed = static_cast<float>(path::length(move)) * modal.feed / kSecondsPerMinute;
    }
}

void plan_line(const LineContext& line, path::MoveKind kind, MotionPlan& plan) noexcept
{
    path::Move move = move_pattern(line.command.modal, line, kind);
    move.start = line.start.rounded();
    move.end = line.end.rounded();
    if (move.start == move.end) {
        return;
    }
    if (kind != path::MoveKind::kRapid) {
        set_speed(line.command.modal, move);
    }
    plan.motion = Moves{move, {}, true, false};
    plan.add(MotionPlan::Step::kMotion);
}

Status plan_motion(LineContext& line, MotionPlan& plan) noexcept
{
    const Command& command = line.command;
    const Motion motion = command.modal.motion;
    if (command.non_modal == NonModal::kMachineCoordinates && motion != Motion::kRapid &&
        motion != Motion::kLine) {
        return Error::kGcodeG53InvalidMotionMode;
    }
    if (command.non_modal == NonModal::kGoHome || command.non_modal == NonModal::kGoSecondHome) {
        const bool first = command.non_modal == NonModal::kGoHome;
        plan_home(line, first ? line.parameters.home : line.parameters.second_home, plan);
        return kDone;
    }
    return command.axis_use == AxisUse::kMotion ? plan_motion_mode(line, plan) : Status{kDone};
}

}  // namespace cusp::gcode
