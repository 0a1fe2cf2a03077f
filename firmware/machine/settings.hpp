// Settings: the configuration of a machine, by Grbl's numbers.
//
// A value is a float and a number in a table; `$$` lists them in the table's order. Numbers that
// are not Grbl's ($8, $14 to $16, $29, $33 to $37, $44 to $46, $140 to $162, $170 to $172, $210 to $212, $338 to $349, $374 to $395, $460 to $481 as in grblHAL, $790 and up) come after Grbl's own.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "firmware/base/axis.hpp"
#include "firmware/base/error.hpp"
#include "firmware/base/machine_limits.hpp"
#include "firmware/base/span.hpp"
#include "firmware/planner/input_shaper.hpp"
#include "firmware/pulse/pulse_maker.hpp"
#include "firmware/vfd/vfd.hpp"

namespace cusp::machine {

inline constexpr unsigned kHomingPasses = 3;

// Places in the table. Per-axis settings take three places, X first; those that A has too take one more in
// builds with it.
enum class Setting : std::uint8_t {
    kStepPulse,                                   // $0 us; also the least low time
    kIdleLock,                                    // $1 ms; 255: drives stay on
    kStepInvert,                                  // $2 mask
    kDirectionInvert,                             // $3 mask
    kEnableInvert,                                // $4
    kLimitInvert,                                 // $5
    kProbeInvert,                                 // $6
    kStatusReport,                                // $10 mask: 1 machine position, 2 buffer state
    kPathTolerance,                               // $11 mm
    kArcTolerance,                                // $12 mm; kept for senders, arcs are exact
    kReportInches,                                // $13
    kSoftLimits,                                  // $20
    kHardLimits,                                  // $21
    kHoming,                                      // $22
    kHomingDirection,                             // $23 mask: a set bit homes towards minus
    kHomingFeed,                                  // $24 mm/min
    kHomingSeek,                                  // $25 mm/min
    kHomingDebounce,                              // $26 ms
    kHomingPullOff,                               // $27 mm
    kSpindleMaximum,                              // $30 rpm
    kSpindleMinimum,                              // $31 rpm
    kLaserMode,                                   // $32
    kStepsPerMillimetre,                          // $100
    kMaxRate = kStepsPerMillimetre + kAxisCount,  // $110 mm/min
    kAcceleration = kMaxRate + kAxisCount,        // $120 mm/s^2
    kTravel = kAcceleration + kAxisCount,         // $130 mm; of A 0: it turns for ever
    kSecondInvert =
        kTravel + kAxisCount,  // $8 mask: the second motor turns the other way than $3 says
    kControlInvert,            // $14 mask: 1 reset, 2 hold, 4 start, 8 door,
                               // 64 emergency stop, 256 motor fault
    kCoolantInvert,            // $15 mask: 1 flood, 2 mist
    kSpindleInvert,            // $16 mask: 1 on, 2 reverse, 4 pulses
    kDirectionSetup,           // $29 us
    kSpindleFrequency,         // $33 Hz, of the spindle's pulses
    kSpindleOffDuty,           // $34 %: of the time that they are high while it is off
    kSpindleLeastDuty,         // $35 %: and at $31
    kSpindleMostDuty,          // $36 %: and at $30
    kKeepCurrent,              // $37 mask: axes whose drives stay on, whatever $1 says
    kHomingPass,               // $44 to $46 masks: axes that are homed first, second, third
    kMotorCurrent =
        kHomingPass + kHomingPasses,           // $140 mA rms, of a drive that is set over its wires
    kMicrosteps = kMotorCurrent + kAxisCount,  // $150: of a full step, a power of two
    kBacklash = kMicrosteps + kAxisCount,      // $160 mm: the play of the axis
    kSquareOffset = kBacklash + kAxisCount,    // $170 mm: offset of the second motor towards plus
    kHoldCurrent = kSquareOffset + 3,          // $210 %: of $140, at rest
    kSetDrives =
        kHoldCurrent + kAxisCount,  // $338 mask: axes whose drives are set over their wires
    kSpeedTolerance,                // $340 %: by which a spindle's drive may be off at speed
    kToolChangeMode,                // $341; see ToolChangeMode
    kToolSearch,                    // $342 mm: the longest way down to the tool setter
    kToolFeed,                      // $343 mm/min: the slow touch
    kToolSeek,                      // $344 mm/min: the fast touch
    kSquarePercent,                 // $347 %: of the travel that one switch may close later, but
    kSquareLeast,                   // $348 mm: no less
    kSquareMost,                    // $349 mm: no more
    kVfdBaud,                       // $374: 0 to 5 for 2400 to 38400 and 115200
    kVfdTimeout,                    // $375 ms: of an answer of the spindle's drive
    kSpindleDelay,                  // $394 s: until the spindle is up; 0: see Accessories
    kSpindleType,                   // $395: 0 outputs, vfd::Protocol otherwise
    kVfdAddress,                    // $460
    kVfdRunRegister,                // $462, of a plain drive
    kVfdSpeedRegister,              // $463
    kVfdReadRegister,               // $464
    kVfdClockwise,                  // $465: the word for M3
    kVfdCounterClockwise,           // $466: for M4
    kVfdStop,                       // $467: for M5
    kVfdToMultiplier,               // $468: a speed is sent as rpm x $468 / $469
    kVfdToDivisor,                  // $469
    kVfdFromMultiplier,             // $470: and read as word x $470 / $471
    kVfdFromDivisor,                // $471
    kReportInterval,                // $481 ms, of status reports that nobody asks for; 0: none
    kLimitFilter,                   // $790 ms
    kLinkWatchdog,                  // $791 ms; 0: off
    kStopOnError,                   // $792
    kSecondMotor,  // $793, of the fourth motor: 0 none, 1 to 3 the second one of X, Y or Z, 4 axis A
    kFourthSwitch,                          // $794: the fourth motor has a switch of its own
    kOptionalStop,                          // $795: M1 stops
    kHoldWhenLeft,                          // $796: a sender that leaves while something moves
    kAtSpeedInput,                          // $797: the spindle's drive says when it is at speed
    kBusDrives,                             // $798 mask: axes of $338 whose drives are TMC5160
    kJerk,                                  // $800 mm/s^3
    kShaperType = kJerk + kAxisCount,       // $810 planner::ShaperType
    kShaperFrequency = kShaperType + 3,     // $820 Hz
    kShaperDamping = kShaperFrequency + 3,  // $830 ratio
    kStealthSpeed = kShaperDamping + 3,  // $840 mm/min: up to which a drive runs silent; 0: never
    kAxisPullOff =
        kStealthSpeed + kAxisCount,  // $850 mm: of this axis in place of $27; 0: as $27 says
    kCount = kAxisPullOff + kAxisCount,
};

inline constexpr std::size_t kSettingCount = static_cast<std::size_t>(Setting::kCount);

constexpr std::size_t index_of(Setting setting, unsigned axis = 0) noexcept
{
    return static_cast<std::size_t>(setting) + axis;
}

struct SettingEntry {
    std::uint16_t number;   // of the '$'
    std::uint8_t decimals;  // 0 or 3, as it is printed; 0 also cuts what is set to a whole number
    float standard;         // the default: a 3-axis mill
    float least;
    float most;
    // The layout of stored settings that has it first; kLayoutWithRotary: it is of A.
    std::uint8_t since{1};
};

// The version of the stored record. A new setting raises it and has it as its `since`; then records of
// earlier versions are still read, and the new setting keeps its default.
inline constexpr std::uint8_t kLayoutNumber = 11;
// Added to it where A has settings and offsets of its own. Builds with A read records without it, too.
inline constexpr std::uint8_t kLayoutWithRotary = 0x80;
inline constexpr std::uint8_t kSettingsLayout =
    kLayoutNumber + (kHasRotaryAxis ? kLayoutWithRotary : std::uint8_t{0});
// True if a record of a layout has the setting.
constexpr bool holds(std::uint8_t layout, const SettingEntry& entry) noexcept
{
    return entry.since == kLayoutWithRotary
               ? layout >= kLayoutWithRotary
               : entry.since <= static_cast<std::uint8_t>(layout & (kLayoutWithRotary - 1U));
}

const SettingEntry& setting_entry(std::size_t index) noexcept;
// The number of settings that a record of this layout holds, in the table's order.
std::size_t settings_in_layout(std::uint8_t layout) noexcept;

// The reason why a value is refused. If two settings contradict each other, both are here.
struct SettingFault {
    Error error{Error::kSettingDisabled};
    std::uint16_t first{0};   // number of the setting at fault; 0: the reason is the value alone
    std::uint16_t second{0};  // and the one that it can't go with
    float amount{0};          // what they ask for together
    float limit{0};           // the bound that this breaks
    bool of_board{false};     // the bound is the board's: both are steps/s
};

// The board's capabilities; settings beyond them are refused.
struct BoardLimits {
    // On each axis while all three move. By default a step each microsecond: nothing asks for more.
    std::uint32_t most_steps_per_second{1000000};
    bool second_motor{true};    // it has pins for one
    bool at_speed_input{true};  // it has a pin for the spindle's at-speed signal
    bool spindle_wire{false};   // it has a line to a spindle's drive
    // Motors whose drives it has a wire to: a bit each, as drives::kMostDrives counts them.
    std::uint8_t drive_wires{0};
    float sense_milliohms{110};  // of these drives
    bool drive_bus{false};       // they may be TMC5160, with these sense resistors
    float bus_sense_milliohms{75};
};

class Settings {
public:
    // The defaults.
    Settings() noexcept;

    float value(Setting setting, unsigned axis = 0) const noexcept
    {
        return values_[index_of(setting, axis)];
    }
    float value_at(std::size_t index) const noexcept { return values_[index]; }
    bool on(Setting setting) const noexcept { return value(setting) != 0; }
    std::uint32_t whole(Setting setting) const noexcept
    {
        return static_cast<std::uint32_t>(value(setting));
    }

    // Sets the setting of this number, alone: what it must be together with others is
    // find_fault()'s.
    //
    // Errors:
    //   kInvalidStatement     no setting has this number
    //   kNegativeValue        the value is negative, or zero where it must not be
    //   kSettingStepPulseMin  a step pulse shorter than 1 us
    //   kGcodeMaxValueExceeded the value is above its range
    //   kInvalidStatement     microsteps that are no power of two
    std::optional<Error> put(std::uint32_t number, float value) noexcept;

    // The contradiction between settings, if any:
    //   kMaxStepRateExceeded   $110 x $100 needs steps closer than twice $0, or more of them than
    //                          the board plays
    //   kGcodeMaxValueExceeded $120 / $800 asks for a filter over 250 ms, or $810 to $832 for
    //                          shapers over planner::kMostShaperTicks together
    //   kSoftLimitError        soft limits without homing
    //   kSettingDisabled       a second motor, an at-speed signal, a spindle's drive, or drives on a bus, on a board
    //                          without pins for it
    std::optional<SettingFault> find_fault(const BoardLimits& board = {}) const noexcept;

    // Every value is in its range.
    bool in_range() const noexcept;
    // As above, and none contradict: put() and find_fault() accept them.
    bool sound(const BoardLimits& board = {}) const noexcept;

    // Gives each value that put() or find_fault() would refuse, as stored bytes of another firmware
    // may hold them, that of `standard`; all of them where these contradict what is left. Returns
    // whether there was one.
    bool mend(const Settings& standard, const BoardLimits& board = {}) noexcept;

    // The fourth motor turns A.
    bool has_rotary() const noexcept
    {
        return kHasRotaryAxis && whole(Setting::kSecondMotor) > kLinearAxes;
    }
    // Axes of the machine, X first.
    unsigned axes() const noexcept { return has_rotary() ? kAxisCount : kLinearAxes; }
    // The axis with the second motor.
    std::optional<unsigned> second_motor_axis() const noexcept
    {
        const std::uint32_t axis = whole(Setting::kSecondMotor);
        return axis > 0 && axis <= kLinearAxes ? std::optional<unsigned>{axis - 1} : std::nullopt;
    }
    // True if homing squares this axis on two switches.
    bool squares(unsigned axis) const noexcept
    {
        return on(Setting::kFourthSwitch) && second_motor_axis() == axis;
    }

    // The fourth motor has a switch, which is read.
    bool has_fourth_switch() const noexcept
    {
        return on(Setting::kFourthSwitch) && whole(Setting::kSecondMotor) > 0;
    }
    // Axes that homing can find: those with a switch.
    AxisMask axes_with_switches() const noexcept
    {
        const unsigned all = has_rotary() && has_fourth_switch() ? kAxisCount : kLinearAxes;
        return {static_cast<std::uint8_t>((1U << all) - 1)};
    }
    // False of A where it turns for ever.
    bool has_ends(unsigned axis) const noexcept { return value(Setting::kTravel, axis) > 0; }

    // Limits of the motors.
    MachineLimits limits() const noexcept;
    AxisVecf backlash() const noexcept;  // mm
    // How far inside its switch homing leaves an axis, mm.
    float pull_off(unsigned axis) const noexcept
    {
        const float own = value(Setting::kAxisPullOff, axis);
        return own > 0 ? own : value(Setting::kHomingPullOff);
    }
    // Axes that homing takes in one of its passes, 0 to kHomingPasses - 1; and in all of them.
    AxisMask homing_pass(unsigned pass) const noexcept
    {
        return {static_cast<std::uint8_t>(value(Setting::kHomingPass, pass))};
    }
    AxisMask homed_axes() const noexcept
    {
        unsigned bits = 0;
        for (unsigned pass = 0; pass < kHomingPasses; ++pass) {
            bits |= homing_pass(pass).bits;
        }
        return {static_cast<std::uint8_t>(bits)};
    }
    pulse::StepSettings steps() const noexcept;
    planner::InputShaper input_shaper() const noexcept;
    vfd::VfdSetup vfd() const noexcept;
    vfd::VfdTimes vfd_times() const noexcept;
    std::uint32_t vfd_baud() const noexcept;
    // The spindle is a drive's, and no laser.
    bool has_vfd() const noexcept { return on(Setting::kSpindleType) && !on(Setting::kLaserMode); }

    // As they are stored, in the table's order.
    Span<std::uint8_t> bytes() noexcept;

private:
    bool in_range_at(std::size_t index) const noexcept;
    unsigned slowest_shaped_axis() const noexcept;

    std::array<float, kSettingCount> values_{};
};

}  // namespace cusp::machine
