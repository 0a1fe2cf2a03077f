// The begin and the end of a probe's move.
#include "firmware/machine/probe_command.hpp"

#include "firmware/machine/report_units.hpp"
#include "firmware/machine/travel.hpp"

namespace cusp::machine {

ActionProgress ProbeCommand::begin(const gcode::Probe& probe) noexcept
{
    Motion& motion = core_.motion;
    alarm_ = Alarm::kNone;
    has_moved_ = false;
    if (!core_.wait_settled() || !motion.has_room()) {
        return ActionProgress::kWaits;
    }
    const bool on = (motion.inputs().raw() & kProbe) != 0;
    if (on != probe.away) {
        alarm_ = Alarm::kProbeInitial;
        return ActionProgress::kLineOver;
    }
    const Settings& settings = core_.settings();
    if (settings.on(Setting::kSoftLimits) && !may_travel(probe.move, settings)) {
        alarm_ = Alarm::kSoftLimit;
        return ActionProgress::kAlarm;
    }
    motion.watch({kProbe, probe.away, false});
    motion.push(probe.move);
    motion.close();
    core_.system.enter(State::kRun);
    needs_contact_ = probe.alarm;
    return ActionProgress::kDone;
}

ActionProgress ProbeCommand::step() noexcept
{
    Motion& motion = core_.motion;
    const bool found = motion.contact().has_value();
    if (found ? !motion.at_rest() : !motion.settled()) {
        return ActionProgress::kWaits;
    }
    core_.last_probe = {found ? *motion.contact() : motion.position(), found};
    has_moved_ = true;
    motion.abandon();
    core_.resynchronise();
    if (!found && needs_contact_) {
        alarm_ = Alarm::kProbeContact;
    }
    return ActionProgress::kLineOver;
}

void ProbeCommand::tell() noexcept
{
    if (has_moved_) {
        write_probe(core_.last_probe, place_form(core_.settings()), core_.replies);
        has_moved_ = false;
    }
}

}  // namespace cusp::machine
