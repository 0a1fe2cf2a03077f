// G5.2, G5.3 and G6.2: the lines of a NURBS.
//
// The forms are LinuxCNC's and Fanuc's (docs/gcode.md); the curve itself is in firmware/nurbs.
#include "firmware/gcode/interpreter.hpp"

namespace cusp::gcode {
namespace {

constexpr std::int64_t kMinOrder = 2;
constexpr unsigned kUniformOrder = 3;
constexpr unsigned kKnottedOrder = 4;
constexpr double kMaxWeight = 1e4;
constexpr double kMinWeight = 1e-4;

// The order of a curve from its P or L word.
Result<unsigned> order_of(const Command& command, char upper_case, unsigned otherwise) noexcept
{
    if (!command.has(upper_case)) {
        return otherwise;
    }
    const Decimal order = command.value(upper_case);
    if (!is_whole(order, path::kMaxOrder) || whole_part(order) < kMinOrder) {
        return Error::kGcodeInvalidTarget;
    }
    return static_cast<unsigned>(whole_part(order));
}

Result<double> weight_of(const Command& command, char upper_case) noexcept
{
    if (!command.has(upper_case)) {
        return 1.0;
    }
    const double weight = to_double(command.value(upper_case));
    if (weight < kMinWeight || weight > kMaxWeight) {
        return Error::kGcodeInvalidTarget;
    }
    return weight;
}

// True if the first control point of a G6.2 is the position of the tool, apart from the rounding of
// programs.
bool is_at(const Position& start, const Position& point) noexcept
{
    constexpr std::int64_t kNear = 1000;  // nm
    std::int64_t sum = 0;
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        const std::int64_t difference = point[axis] - start[axis];
        if (difference > kNear || difference < -kNear) {
            return false;
        }
        sum += difference * difference;
    }
    return sum <= kNear * kNear;
}

Status check_uniform(Command& command) noexcept
{
    if (const Result<unsigned> order = order_of(command, 'L', kUniformOrder); !order) {
        return order.error();
    }
    if (const Result<double> weight = weight_of(command, 'P'); !weight) {
        return weight.error();
    }
    command.use('L');
    command.use('P');
    return kDone;
}

Status check_knotted(LineContext& line) noexcept
{
    Command& command = line.command;
    if (!command.has('K')) {
        return Error::kGcodeValueWordMissing;
    }
    if (const Result<unsigned> order = order_of(command, 'P', kKnottedOrder); !order) {
        return order.error();
    }
    if (const Result<double> weight = weight_of(command, 'R'); !weight) {
        return weight.error();
    }
    if (!is_at(line.start.rounded(), line.end.rounded())) {
        return Error::kGcodeInvalidTarget;
    }
    command.use('K');
    command.use('P');
    command.use('R');
    command.use('Q');  // LinuxCNC's choice of method
    return kDone;
}

}  // namespace

bool Interpreter::in_curve() const noexcept
{
    return modal_.motion == Motion::kUniformNurbs || modal_.motion == Motion::kNurbs;
}

Status Interpreter::check_new_curve(LineContext& line) noexcept
{
    Command& command = line.command;
    const Motion motion = command.modal.motion;
    if (motion != Motion::kUniformNurbs && motion != Motion::kNurbs) {
        return kDone;
    }
    if ((command.axes() & kRotaryLetters) != 0) {
        return Error::kGcodeUnsupportedCommand;
    }
    // Inverse time needs the length of the curve, which is not known when it starts.
    if (command.modal.inverse_time) {
        return Error::kGcodeUndefinedFeedRate;
    }
    if (command.flow != ProgramFlow::kRunning) {
        return Error::kGcodeInvalidTarget;
    }
    return motion == Motion::kNurbs ? check_knotted(line) : check_uniform(command);
}

// Cannot fail: everything has been checked.
void Interpreter::open_curve(const LineContext& line) noexcept
{
    const Command& command = line.command;
    const Position start = line.start.rounded();
    if (command.modal.motion == Motion::kNurbs) {
        const unsigned order = *order_of(command, 'P', kKnottedOrder);
        curve_.open(nurbs::KnotSource::kExplicit, order, {start, *weight_of(command, 'R')});
        const Status first = curve_.add_knot(to_double(command.value('K')));
        CUSP_ASSERT(static_cast<bool>(first));
        return;
    }
    const unsigned order = *order_of(command, 'L', kUniformOrder);
    const double weight = *weight_of(command, 'P');
    if (command.axes() == 0) {
        curve_.open(nurbs::KnotSource::kUniform, order, {start, weight});
        return;
    }
    curve_.open(nurbs::KnotSource::kUniform, order, {start, 1.0});
    curve_.add_point({line.end.rounded(), weight});
    plan_pieces(line);
}

Status Interpreter::continue_curve(LineContext& line) noexcept
{
    Command& command = line.command;
    const bool uniform = modal_.motion == Motion::kUniformNurbs;
    const bool names_curve =
        command.names(Group::kMotion) &&
        (uniform ? command.ends_curve : command.modal.motion == Motion::kNurbs);
    const std::uint32_t allowed = names_curve ? 1U << static_cast<unsigned>(Group::kMotion) : 0;
    // Any other G or M word would leave the curve without its end; so would a new G6.2 with a point.
    if (command.groups != allowed || (names_curve && command.axes() != 0)) {
        return Error::kGcodeInvalidTarget;
    }
    if (command.unused == 0 && !names_curve) {
        return kDone;
    }
    if ((command.axes() & kRotaryLetters) != 0) {
        return Error::kGcodeUnsupportedCommand;
    }
    command.axis_use = AxisUse::kMotion;
    if (const Status status = find_target(line); !status) {
        return status;
    }
    const Status status = uniform ? continue_uniform(line) : continue_knotted(line);
    if (!status) {
        return status;
    }
    position_ = line.end;
    commit_rotary(line.command);
    plan_pieces(line);
    if (!curve_.is_open()) {
        modal_.motion = Motion::kNone;
    }
    return kDone;
}

Status Interpreter::continue_uniform(LineContext& line) noexcept
{
    Command& command = line.command;
    if (command.ends_curve) {
        return command.unused == 0 ? curve_.close() : Status{Error::kGcodeUnusedWords};
    }
    if (command.axes() == 0) {
        return Error::kGcodeNoAxisWords;
    }
    const Result<double> weight = weight_of(command, 'P');
    if (!weight) {
        return weight.error();
    }
    command.use('P');
    if ((command.unused & ~kLinearLetters) != 0) {
        return Error::kGcodeUnusedWords;
    }
    curve_.add_point({line.end.rounded(), *weight});
    return kDone;
}

Status Interpreter::continue_knotted(LineContext& line) noexcept
{
    Command& command = line.command;
    if (!command.has('K')) {
        return Error::kGcodeValueWordMissing;
    }
    const Result<double> weight = weight_of(command, 'R');
    if (!weight) {
        return weight.error();
    }
    command.use('K');
    const bool point = command.axes() != 0;
    if (point) {
        command.use('R');
    }
    if ((command.unused & ~kLinearLetters) != 0) {
        return Error::kGcodeUnusedWords;
    }
    if (point) {
        if (!curve_.accepts_points()) {
            return Error::kGcodeInvalidTarget;
        }
        curve_.add_point({line.end.rounded(), *weight});
    }
    return curve_.add_knot(to_double(command.value('K')));
}

void Interpreter::plan_pieces(const LineContext& line) noexcept
{
    plan_.motion = CurveMoves{move_pattern(modal_, line, path::MoveKind::kFeed)};
    plan_.add(MotionPlan::Step::kMotion);
}

void Interpreter::give_up_curve() noexcept
{
    curve_.abandon();
    modal_.motion = Motion::kNone;
    position_ = to_exact(curve_.position());
}

}  // namespace cusp::gcode
