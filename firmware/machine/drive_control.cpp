// The registers of the drives, and the words for their faults.
#include "firmware/machine/drive_control.hpp"

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
void DriveControl::configure(const Settings& settings, const BoardLimits& board) noexcept
{
    std::array<drives::DriveRegisters, drives::kMostDrives> registers;
    unsigned motors = 0;
    for (unsigned drive = 0; drive < drives::kMostDrives; ++drive) {
        const std::optional<unsigned> axis =
            drive < settings.axes() ? std::optional<unsigned>{drive} : settings.second_motor_axis();
        const bool is_set = axis && (settings.whole(Setting::kSetDrives) >> *axis & 1U) != 0 &&
                            (unsigned{board.drive_wires} >> drive & 1U) != 0;
        if (!is_set) {
            continue;
        }
        motors |= 1U << drive;
        const bool on_bus =
            board.drive_bus && (settings.whole(Setting::kBusDrives) >> *axis & 1U) != 0;
        registers[drive] = drives::registers_for(
            on_bus ? drives::DriveKind::kTmc5160 : drives::DriveKind::kTmc2209,
            {settings.value(Setting::kMotorCurrent, *axis),
             settings.value(Setting::kHoldCurrent, *axis),
             static_cast<std::uint32_t>(settings.value(Setting::kMicrosteps, *axis)),
             settings.value(Setting::kStealthSpeed, *axis),
             settings.value(Setting::kStepsPerMillimetre, *axis),
             on_bus ? board.bus_sense_milliohms : board.sense_milliohms});
    }
    drives_.configure(registers, static_cast<std::uint8_t>(motors));
}

void DriveControl::tell_alarm(Alarm alarm,
                              const Settings& settings,
                              protocol::ReplyQueue& out) const noexcept
{
    const std::optional<drives::DriveFault> fault = drives_.fault();
    if (fault && alarm == Alarm::kMotorFault) {
        tell_fault(*fault, settings, out);
        return;
    }
    // The first that a bare board says: its inputs are open.
    (void)out.text("[MSG:")
        .text(alarm == Alarm::kMotorFault
                  ? "Motor fault: clear it, then reset. No such wire: close the input to ground or "
                    "add 256 to $14"
                  : "Emergency stop: clear it, then reset. No such wire: close the input to ground "
                    "or add 64 to $14; 331 if no control is wired")
        .text("]")
        .end_line();
}

void DriveControl::tell_fault(const drives::DriveFault& fault,
                              const Settings& settings,
                              protocol::ReplyQueue& out) const noexcept
{
    constexpr std::array<std::string_view, drives::kMostDrives> kNames{"X", "Y", "Z",
                                                                       "of the second motor"};
    const bool is_rotary = fault.drive == kLinearAxes && settings.has_rotary();
    (void)out.text("[MSG:Drive ").text(is_rotary ? "A" : kNames[fault.drive]).character(' ');
    (void)out.text(text_of(fault)).text("; then reset]").end_line();
}

}  // namespace cusp::machine
