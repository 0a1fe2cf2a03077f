// The motors' drives: what the settings ask of them, and what a fault of one does.
#include "firmware/machine/machine.hpp"

namespace cusp::machine {
namespace {

using drives::FaultKind;

std::string_view text_of(const drives::DriveFault& fault) noexcept
{
    switch (fault.kind) {
        case FaultKind::kSilent:
            return "does not answer. If it is of another kind see $798, if there is none $338";
        case FaultKind::kGarbled:
            return "answers with a wrong checksum";
        case FaultKind::kOtherChip:
            return fault.wanted == drives::DriveKind::kTmc5160 ? "is no TMC5160: see $798 and $338"
                                                               : "is no TMC2209: see $798 and $338";
        case FaultKind::kUnset:
            return "does not keep its settings";
        case FaultKind::kRestarted:
            return "was without power and has lost its settings";
        case FaultKind::kUndervoltage:
            return "had too little voltage";
        case FaultKind::kHot:
            return "is too hot and has switched off";
        case FaultKind::kShort:
            return "has a short at its motor";
    }
    return "";
}

}  // namespace

// The fourth motor has the settings of A, or of the axis whose second motor it is.
void Machine::configure_drives() noexcept
{
    const Settings& settings = stored_.settings;
    std::array<drives::DriveRegisters, drives::kMostDrives> registers;
    unsigned motors = 0;
    for (unsigned drive = 0; drive < drives::kMostDrives; ++drive) {
        const std::optional<unsigned> axis =
            drive < settings.axes() ? std::optional<unsigned>{drive} : settings.second_motor_axis();
        const bool is_set = axis && (settings.whole(Setting::kSetDrives) >> *axis & 1U) != 0 &&
                            (unsigned{board_.drive_wires} >> drive & 1U) != 0;
        if (!is_set) {
            continue;
        }
        motors |= 1U << drive;
        const bool on_bus =
            board_.drive_bus && (settings.whole(Setting::kBusDrives) >> *axis & 1U) != 0;
        registers[drive] = drives::registers_for(
            on_bus ? drives::DriveKind::kTmc5160 : drives::DriveKind::kTmc2209,
            {settings.value(Setting::kMotorCurrent, *axis),
             settings.value(Setting::kHoldCurrent, *axis),
             static_cast<std::uint32_t>(settings.value(Setting::kMicrosteps, *axis)),
             settings.value(Setting::kStealthSpeed, *axis),
             settings.value(Setting::kStepsPerMillimetre, *axis),
             on_bus ? board_.bus_sense_milliohms : board_.sense_milliohms});
    }
    drives_.configure(registers, static_cast<std::uint8_t>(motors));
}

// A line that may move or switch something on waits until they are set.
bool Machine::waits_for_drives() const noexcept
{
    const bool may_move =
        task_ != Task::kListing && task_ != Task::kConfigure && task_ != Task::kFinish;
    return may_move && !drives_.ready();
}

// After an alarm that needs a reset they may be without power: only what follows the reset counts.
bool Machine::protect_drives() noexcept
{
    if (!drives_.fault() || reset_needed_) {
        return false;
    }
    raise(Alarm::kMotorFault);
    return true;
}

// A spindle's drive that fails: motion is stopped softly, as before a soft limit, then the alarm is raised.
bool Machine::protect_spindle() noexcept
{
    const std::optional<vfd::FaultKind> fault = outputs_.vfd().fault();
    if (!fault) {
        return false;
    }
    motion_.hold();
    if (!motion_.at_rest()) {
        return false;
    }
    outputs_.vfd().fault_heard();
    if (state_ != State::kAlarm) {
        raise(Alarm::kSpindle);
    }
    constexpr std::array<std::string_view, 3> kTexts{
        "does not answer", "answers with a wrong checksum", "refuses what it is told"};
    (void)replies_.text("[MSG:Spindle ").text(kTexts[static_cast<std::size_t>(*fault)]);
    (void)replies_.text("]").end_line();
    return true;
}

void Machine::tell_drive_fault(const drives::DriveFault& fault) noexcept
{
    constexpr std::array<std::string_view, drives::kMostDrives> kNames{"X", "Y", "Z",
                                                                       "of the second motor"};
    const bool is_rotary = fault.drive == kLinearAxes && stored_.settings.has_rotary();
    (void)replies_.text("[MSG:Drive ").text(is_rotary ? "A" : kNames[fault.drive]).character(' ');
    (void)replies_.text(text_of(fault)).text("; then reset]").end_line();
}

}  // namespace cusp::machine
