// Fields of the status report, as Grbl 1.1 orders them.
#include "firmware/machine/status_report.hpp"

#include "firmware/machine/report_units.hpp"

namespace cusp::machine {
namespace {

using protocol::ReplyQueue;

constexpr unsigned kReportMachinePosition = 1;
constexpr unsigned kReportBufferState = 2;

std::string_view name_of(State state) noexcept
{
    switch (state) {
        case State::kIdle:
            return "Idle";
        case State::kRun:
            return "Run";
        case State::kHold:
            return "Hold";
        case State::kJog:
            return "Jog";
        case State::kAlarm:
            return "Alarm";
        case State::kDoor:
            return "Door";
        case State::kCheck:
            return "Check";
        case State::kHome:
            return "Home";
        case State::kSleep:
            return "Sleep";
    }
    return "";
}

bool busy(State state) noexcept
{
    return state == State::kHome || state == State::kRun || state == State::kHold ||
           state == State::kJog || state == State::kDoor;
}

void write_state(const StatusFields& status, ReplyQueue& out) noexcept
{
    (void)out.text(name_of(status.state));
    if (status.state == State::kHold || status.state == State::kDoor) {
        (void)out.character(':').number(status.substate);
    }
}

void write_pins(std::uint16_t inputs, ReplyQueue& out) noexcept
{
    struct Pin {
        InputBit bit;
        char letter;
    };
    constexpr std::array<Pin, 11> kPins{{{kProbe, 'P'},
                                         {kLimitX, 'X'},
                                         {kLimitY, 'Y'},
                                         {kLimitZ, 'Z'},
                                         {kFourthLimit, 'A'},
                                         {kDoor, 'D'},
                                         {kHoldButton, 'H'},
                                         {kResetButton, 'R'},
                                         {kStartButton, 'S'},
                                         {kEmergencyStop, 'E'},
                                         {kMotorFault, 'M'}}};
    if ((inputs & ~unsigned{kAtSpeed}) == 0) {
        return;
    }
    (void)out.text("|Pn:");
    for (const Pin& pin : kPins) {
        if ((inputs & pin.bit) != 0) {
            (void)out.character(pin.letter);
        }
    }
}

void write_accessories(const Accessories& accessories, ReplyQueue& out) noexcept
{
    const bool any = accessories.spindle_on() || accessories.flood_on() || accessories.mist_on();
    if (!any) {
        return;
    }
    (void)out.text("|A:");
    if (accessories.spindle_on()) {
        const bool clockwise = accessories.spindle == gcode::SpindleMode::kClockwise;
        (void)out.character(clockwise ? 'S' : 'C');
    }
    if (accessories.flood_on()) {
        (void)out.character('F');
    }
    if (accessories.mist_on()) {
        (void)out.character('M');
    }
}

void write_overrides(const Overrides& overrides, ReplyQueue& out) noexcept
{
    (void)out.text("|Ov:").number(overrides.feed).character(',').number(overrides.rapid);
    (void)out.character(',').number(overrides.spindle);
}

void write_motion(const StatusFields& status, const Settings& settings, ReplyQueue& out) noexcept
{
    const unsigned mask = settings.whole(Setting::kStatusReport);
    const bool inches = settings.on(Setting::kReportInches);
    const bool machine = (mask & kReportMachinePosition) != 0;
    (void)out.text(machine ? "|MPos:" : "|WPos:");
    write_position(out, machine ? status.position : status.position - status.work_offset,
                   place_form(settings));
    if ((mask & kReportBufferState) != 0) {
        (void)out.text("|Bf:").number(status.free_blocks).character(',').number(status.free_bytes);
    }
    if (status.line > 0) {
        (void)out.text("|Ln:").number(status.line);
    }
    const float feed = inches ? status.feed / kMillimetresPerInch : status.feed;
    (void)out.text("|FS:").decimal(protocol::scaled(feed, inches ? 1 : 0), inches ? 1 : 0);
    (void)out.character(',').decimal(protocol::scaled(status.spindle, 0), 0);
}

}  // namespace

void StatusReporter::write(const StatusFields& status,
                           const Settings& settings,
                           ReplyQueue& out) noexcept
{
    constexpr std::uint32_t kWorkOffsetBusy = 30;
    constexpr std::uint32_t kOverridesBusy = 20;
    constexpr std::uint32_t kIdle = 10;
    (void)out.character('<');
    write_state(status, out);
    write_motion(status, settings, out);
    write_pins(status.inputs, out);
    if (until_work_offset_ > 0) {
        --until_work_offset_;
    } else {
        until_work_offset_ = (busy(status.state) ? kWorkOffsetBusy : kIdle) - 1;
        if (until_overrides_ == 0) {
            until_overrides_ = 1;  // with the next report
        }
        (void)out.text("|WCO:");
        write_position(out, status.work_offset, place_form(settings));
    }
    if (until_overrides_ > 0) {
        --until_overrides_;
    } else {
        until_overrides_ = (busy(status.state) ? kOverridesBusy : kIdle) - 1;
        write_overrides(status.overrides, out);
        write_accessories(status.accessories, out);
    }
    (void)out.character('>');
}

}  // namespace cusp::machine
