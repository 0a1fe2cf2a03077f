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

constexpr LetterSet kCentreLetters = letter('I') | letter('J') | letter('K');

constexpr char centre_letter(unsigned axis) noexcept { return static_cast<char>('I' + axis); }

// The axes of a plane, in the order in which arcs turn.
struct PlaneAxes {
    unsigned first;
    unsigned second;
};

PlaneAxes axes_of(path::Plane plane) noexcept
{
    switch (plane) {
        case path::Plane::kZX:
            return {2, 0};
        case path::Plane::kYZ:
            return {1, 2};
        case path::Plane::kXY:
            break;
    }
    return {0, 1};
}

// The centre from the start, along an axis of the plane: its word is an offset, or with G90.1 a
// coordinate.
Result<std::int64_t> centre_of(const LineContext& line, unsigned axis) noexcept
{
    const Command& command = line.command;
    if (!command.has(centre_letter(axis))) {
        return std::int64_t{0};
    }
    const Result<ExactLength> value = length_of(command, centre_letter(axis));
    if (!value) {
        return value.error();
    }
    if (!command.modal.absolute_centres) {
        return value->rounded();
    }
    const ExactLength origin{work_offset(command.modal, line.parameters)[axis], 0};
    return (origin + *value).rounded() - line.start[axis].rounded();
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

Result<path::ArcWords> read_radius(Command& command, path::ArcWords words) noexcept
{
    const Result<ExactLength> radius = length_of(command, 'R');
    if (!radius) {
        return radius.error();
    }
    command.use('R');
    return path::with_radius(words, radius->rounded());
}

Result<path::ArcWords> read_centre(LineContext& line, path::ArcWords words, PlaneAxes axes) noexcept
{
    Command& command = line.command;
    const bool first_given = command.has(centre_letter(axes.first));
    const bool second_given = command.has(centre_letter(axes.second));
    const bool absolute = command.modal.absolute_centres;
    if (absolute ? !(first_given && second_given) : !(first_given || second_given)) {
        return Error::kGcodeNoOffsetsInPlane;
    }
    const Result<std::int64_t> first = centre_of(line, axes.first);
    if (!first) {
        return first.error();
    }
    const Result<std::int64_t> second = centre_of(line, axes.second);
    if (!second) {
        return second.error();
    }
    // The word of the third axis, FreeCAD's K0, is ignored, as by Grbl.
    command.unused &= ~kCentreLetters;
    words.first_offset_nm = *first;
    words.second_offset_nm = *second;
    return words;
}

// A centre without an end in the plane is a full circle.
Status check_end(const Command& command, PlaneAxes axes) noexcept
{
    if (command.has(axis_letter(axes.first)) || command.has(axis_letter(axes.second))) {
        return kDone;
    }
    const bool circle = !command.has('R') && (command.has(centre_letter(axes.first)) ||
                                              command.has(centre_letter(axes.second)));
    return circle                ? Status{kDone}
           : command.axes() == 0 ? Status{Error::kGcodeNoAxisWords}
                                 : Status{Error::kGcodeNoAxisWordsInPlane};
}

Status plan_arc(LineContext& line, MotionPlan& plan) noexcept
{
    Command& command = line.command;
    const PlaneAxes axes = axes_of(command.modal.plane);
    if (const Status status = check_end(command, axes); !status) {
        return status;
    }
    path::ArcWords words{};
    words.start = line.start.rounded();
    words.end = line.end.rounded();
    words.plane = command.modal.plane;
    words.clockwise = command.modal.motion == Motion::kArcClockwise;
    words.inches = command.modal.inches;
    if (const Status status = read_turns(command, words); !status) {
        return status;
    }
    const Result<path::ArcWords> centred =
        command.has('R') ? read_radius(command, words) : read_centre(line, words, axes);
    if (!centred) {
        return centred.error();
    }
    const Result<path::Arc> arc = path::make_arc(*centred);
    if (!arc) {
        return arc.error();
    }
    path::Move move = move_pattern(command.modal, line, path::MoveKind::kFeed);
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
    if ((line.command.axes() & kRotaryLetters) != 0) {
        return Error::kGcodeUnsupportedCommand;
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
    const bool all = (command.words & (kLinearLetters | kRotaryLetters)) == 0;
    for (unsigned axis = 0; axis < command.axis_count; ++axis) {
        if (all || command.names_axis(axis)) {
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
        case Motion::kDrillChipBreaking:
        case Motion::kBore:
        case Motion::kBoreStopping:
        case Motion::kBoreWithDwell:
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
        if (!command.names_axis(axis)) {
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
        move.feed = static_cast<float>(path::fed_length(move)) * modal.feed / kSecondsPerMinute;
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
