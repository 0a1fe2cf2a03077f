// The slices of the main loop; alarms and resets, and the messages about them.
#include "firmware/machine/machine.hpp"

namespace cusp::machine {
namespace {

// Room for the longest output of one slice.
constexpr std::uint32_t kReplyRoom = 256;

// What is said of a store that was not read as it was written; empty if it was.
std::string_view store_fault(LogState loaded) noexcept
{
    switch (loaded) {
        case LogState::kEmpty:
        case LogState::kGood:
            break;
        case LogState::kInterrupted:
            return "Settings: an interrupted write was dropped";
        case LogState::kDamaged:
            return "Settings damaged: an older set is in force";
        case LogState::kLost:
            return "Settings lost: defaults in force, $RST=* stores them";
    }
    return {};
}

}  // namespace

Machine::Machine(planner::PathQueue& queue,
                 const Settings* factory,
                 const BoardLimits& board) noexcept
    : core_{queue, factory, board}
{
}

void Machine::start(LogState loaded) noexcept
{
    const bool mended = core_.keeper.mend();
    configure();
    drives_.drives().restart(core_.motion.ticks());
    core_.interpreter.set_parameters(core_.keeper.stored().parameters);
    core_.interpreter.reset();
    const bool damaged = mended || loaded == LogState::kDamaged || loaded == LogState::kLost;
    if (damaged || core_.settings().on(Setting::kHoming)) {
        core_.system.enter(State::kAlarm);
    }
    say_hello();
    if (const std::string_view fault = store_fault(loaded); !fault.empty()) {
        if (loaded != LogState::kInterrupted) {
            core_.lines.answer(Error::kSettingReadFail);
        }
        core_.message(fault);
    }
    if (mended) {
        core_.lines.answer(Error::kSettingReadFail);
        core_.message("Settings damaged: some are defaults, see $$");
    }
}

void Machine::configure() noexcept
{
    const Settings& settings = core_.settings();
    core_.motion.configure(settings);
    drives_.configure(settings, core_.keeper.board());
    core_.outputs.configure();
    core_.interpreter.set_default_tolerance(settings.value(Setting::kPathTolerance));
    core_.interpreter.set_axes(settings.axes());
}

bool Machine::idle() const noexcept
{
    return !line_.waits() && core_.lines.empty() && core_.motion.settled() &&
           line_.startup().all_run() && !core_.system.is(State::kHold) &&
           !core_.system.is(State::kDoor);
}

bool Machine::poll() noexcept
{
    const bool can_answer = core_.replies.room() >= kReplyRoom;
    // A stop does not wait for a step of the plan.
    if (!requests_.cut()) {
        core_.motion.work(can_answer && (!core_.lines.empty() || line_.pushes()));
    }
    guard_limits();
    // Without room for answers a stop acts in the tick meanwhile.
    const bool worked = can_answer && step();
    const bool plans = core_.motion.take_changes();
    return worked || plans;
}

bool Machine::step() noexcept
{
    const bool handled = handle_events();
    const bool followed = follow_motion();
    if (handled || followed) {
        return true;
    }
    if (cycle_.suspended()) {
        return false;
    }
    return step_line();
}

bool Machine::step_line() noexcept
{
    switch (line_.step(drives_.drives().ready())) {
        case LineEvent::kNothing:
            return false;
        case LineEvent::kWorked:
            break;
        case LineEvent::kAlarm:
            raise(line_.alarm());
            break;
        case LineEvent::kProbeAlarm:
            enter_alarm(line_.alarm());
            line_.finish_probe();
            break;
        case LineEvent::kConfigure:
            configure();
            break;
        case LineEvent::kReset:
            reset();
            break;
    }
    return true;
}

void Machine::end_slice() noexcept
{
    core_.motion.stops().want(requests_.brake(), requests_.cut(), requests_.halt());
    core_.motion.stops().confirm();
}

// Hard limits guard every state in which something may move, from the moment that no switch is
// closed: a person must be able to drive off one.
void Machine::guard_limits() noexcept
{
    const SystemState& system = core_.system;
    const bool moves = !system.is(State::kAlarm) && !line_.homes() && !system.is(State::kSleep) &&
                       !system.is(State::kCheck);
    if (!moves || !core_.settings().on(Setting::kHardLimits)) {
        core_.motion.guard_limits(false);
    } else if (!core_.limit_on()) {
        core_.motion.guard_limits(true);
    }
}

bool Machine::follow_motion() noexcept
{
    if (!core_.outputs.follow()) {
        raise(Alarm::kSpindle);
        return true;
    }
    return cycle_.follow(line_.waits(), line_.homes());
}

// Discards all moves and lines in progress; the machine stays at its position.
void Machine::drop_all() noexcept
{
    core_.motion.abandon();
    core_.motion.drive(Motors::kBoth);
    core_.motion.guard_limits(false);
    core_.interpreter.discard();
    line_.drop();
    cycle_.forget();
    core_.lines.forget_lost_lines();
    core_.outputs.switch_off();
}

void Machine::raise(Alarm alarm) noexcept
{
    const bool answers = line_.owes_answer();
    enter_alarm(alarm);
    if (answers) {
        core_.lines.answer(alarm == Alarm::kSoftLimit ? Error::kTravelExceeded
                                                      : Error::kSystemGcLock);
        core_.lines.next();
    }
}

void Machine::enter_alarm(Alarm alarm) noexcept
{
    drop_all();
    core_.system.raise(alarm);
    core_.resynchronise();
    (void)core_.replies.text("ALARM:").number(static_cast<std::uint32_t>(alarm)).end_line();
    if (alarm == Alarm::kHardLimit || alarm == Alarm::kSoftLimit) {
        core_.message("Reset to continue");
    } else if (alarm == Alarm::kEmergencyStop || alarm == Alarm::kMotorFault) {
        drives_.tell_alarm(alarm, core_.settings(), core_.replies);
    }
}

void Machine::frame_missed() noexcept
{
    requests_.add(kRequestUnderrun);
    core_.motion.lose_frames();
}

void Machine::store_done(bool written) noexcept
{
    core_.keeper.store_done(written);
    if (!written) {
        core_.message("Settings could not be stored: they hold until power-off");
    }
}

void Machine::reset() noexcept
{
    const bool moving = !core_.motion.at_rest();
    const Alarm aborted = line_.homes() ? Alarm::kHomingReset
                          : moving      ? Alarm::kAbortInMotion
                                        : Alarm::kNone;
    drop_all();
    if (core_.system.reset_needed()) {
        drives_.drives().restart(core_.motion.ticks());  // they may have been without power
    }
    core_.system.reset(aborted);
    core_.outputs.vfd().restart();
    core_.lines.forget_cancel();
    requests_.drop(kRequestHold | kRequestStart | kRequestDoor | kRequestJogCancel);
    core_.outputs.reset_overrides();
    core_.interpreter.reset();
    core_.interpreter.set_parameters(core_.keeper.stored().parameters);
    line_.forget_tool_reference();
    core_.resynchronise();
    if (aborted != Alarm::kNone) {
        (void)core_.replies.text("ALARM:").number(static_cast<std::uint32_t>(aborted)).end_line();
    }
    say_hello();
}

// Sends the banner, then enters the lock, reports an open door, or runs the startup lines.
void Machine::say_hello() noexcept
{
    core_.reporter = StatusReporter{};
    (void)core_.replies.text("\r\nGrbl 1.1h ['$' for help]").end_line();
    // Buttons pressed before are over; an open door is not.
    constexpr std::uint16_t kButtons = kResetButton | kHoldButton | kStartButton | kDoor;
    core_.motion.stops().handle(kButtons);
    if (core_.input_on(kDoor)) {
        requests_.add(kRequestDoor);
    }
    if (core_.settings().on(Setting::kHardLimits) && core_.limit_on()) {
        core_.system.enter(State::kAlarm);
        core_.message("Check Limits");
    }
    if (core_.system.is(State::kAlarm)) {
        core_.message("'$H'|'$X' to unlock");
        return;
    }
    core_.system.clear_alarm();
    line_.run_startup_lines();
}

OutputLevels Machine::outputs() const noexcept
{
    const bool stopped = core_.system.is(State::kSleep) ||
                         core_.system.alarm() == Alarm::kEmergencyStop ||
                         !drives_.drives().may_have_current();
    return core_.outputs.levels(stopped);
}

}  // namespace cusp::machine
