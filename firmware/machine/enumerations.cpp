// The names of settings, errors and alarms, as senders ask for them.
#include "firmware/machine/enumerations.hpp"

#include <array>
#include <string_view>

#include "firmware/base/axis.hpp"
#include "firmware/base/error.hpp"
#include "firmware/machine/machine_state.hpp"
#include "firmware/machine/settings.hpp"
#include "firmware/protocol/system_command.hpp"

namespace cusp::machine {
namespace {

using protocol::ReplyQueue;

// The groups' numbers are grblHAL's but for the last five.
enum class Group : std::uint8_t {
    kRoot = 0,
    kGeneral = 1,
    kControls = 2,
    kLimits = 3,
    kSecondMotor = 4,
    kCoolant = 5,
    kSpindle = 6,
    kToolChange = 9,
    kHoming = 11,
    kProbing = 12,
    kModbus = 19,
    kStepper = 40,
    kAxis = 41,
    kFirstAxis = 42,
};
struct GroupName {
    Group group;
    Group parent;
    std::string_view name;
};
constexpr Group axis_group(unsigned axis) noexcept
{
    return static_cast<Group>(static_cast<unsigned>(Group::kFirstAxis) + axis);
}
constexpr std::array<GroupName, 16> kGroups{{
    {Group::kGeneral, Group::kRoot, "General"},
    {Group::kControls, Group::kRoot, "Control signals"},
    {Group::kLimits, Group::kRoot, "Limits"},
    {Group::kSecondMotor, Group::kLimits, "Two motors for one axis"},
    {Group::kCoolant, Group::kRoot, "Coolant"},
    {Group::kSpindle, Group::kRoot, "Spindle"},
    {Group::kToolChange, Group::kRoot, "Tool change"},
    {Group::kHoming, Group::kRoot, "Homing"},
    {Group::kProbing, Group::kRoot, "Probing"},
    {Group::kModbus, Group::kRoot, "ModBus"},
    {Group::kStepper, Group::kRoot, "Stepper"},
    {Group::kAxis, Group::kRoot, "Axis"},
    {axis_group(0), Group::kAxis, "X-axis"},
    {axis_group(1), Group::kAxis, "Y-axis"},
    {axis_group(2), Group::kAxis, "Z-axis"},
    {axis_group(3), Group::kAxis, "A-axis"},
}};

// grblHAL's numbers of data types.
enum class Type : std::uint8_t {
    kSwitch = 0,
    kBits = 1,
    kChoice = 3,
    kAxes = 4,
    kInteger = 5,
    kDecimal = 6,
};
struct SettingName {
    std::uint16_t number;  // of X, where each axis has one
    Group group;
    Type type;
    std::string_view name;
    std::string_view unit;
    std::string_view choices;  // of bits and choices, in order
};
constexpr std::array<SettingName, 84> kNames{{
    {0, Group::kStepper, Type::kInteger, "Step pulse time", "us", ""},
    {1, Group::kStepper, Type::kInteger, "Step idle delay", "ms", ""},
    {2, Group::kStepper, Type::kAxes, "Step pulse invert", "", ""},
    {3, Group::kStepper, Type::kAxes, "Step direction invert", "", ""},
    {4, Group::kStepper, Type::kSwitch, "Invert stepper enable", "", ""},
    {5, Group::kLimits, Type::kSwitch, "Invert limit inputs", "", ""},
    {6, Group::kProbing, Type::kSwitch, "Invert probe input", "", ""},
    {10, Group::kGeneral, Type::kBits, "Status report options", "",
     "Position in machine coordinate,Buffer state"},
    {11, Group::kGeneral, Type::kDecimal, "Path tolerance", "mm", ""},
    {12, Group::kGeneral, Type::kDecimal, "Arc tolerance", "mm", ""},
    {13, Group::kGeneral, Type::kSwitch, "Report in inches", "", ""},
    {20, Group::kLimits, Type::kSwitch, "Soft limits enable", "", ""},
    {21, Group::kLimits, Type::kSwitch, "Hard limits enable", "", ""},
    {22, Group::kHoming, Type::kSwitch, "Homing cycle", "", ""},
    {23, Group::kHoming, Type::kAxes, "Homing direction invert", "", ""},
    {24, Group::kHoming, Type::kDecimal, "Homing locate feed rate", "mm/min", ""},
    {25, Group::kHoming, Type::kDecimal, "Homing search seek rate", "mm/min", ""},
    {26, Group::kHoming, Type::kInteger, "Homing switch debounce delay", "ms", ""},
    {27, Group::kHoming, Type::kDecimal, "Homing switch pull-off distance", "mm", ""},
    {30, Group::kSpindle, Type::kInteger, "Maximum spindle speed", "RPM", ""},
    {31, Group::kSpindle, Type::kInteger, "Minimum spindle speed", "RPM", ""},
    {32, Group::kSpindle, Type::kSwitch, "Laser mode", "", ""},
    {100, Group::kAxis, Type::kDecimal, "travel resolution", "step/mm", ""},
    {110, Group::kAxis, Type::kDecimal, "maximum rate", "mm/min", ""},
    {120, Group::kAxis, Type::kDecimal, "acceleration", "mm/sec^2", ""},
    {130, Group::kAxis, Type::kDecimal, "maximum travel", "mm", ""},
    {8, Group::kSecondMotor, Type::kAxes, "Ganged axes direction invert", "", ""},
    {14, Group::kControls, Type::kBits, "Invert control inputs", "",
     "Reset,Feed hold,Cycle start,Safety door,N/A,N/A,EStop,N/A,Motor fault"},
    {15, Group::kCoolant, Type::kBits, "Invert coolant outputs", "", "Flood,Mist"},
    {16, Group::kSpindle, Type::kBits, "Invert spindle signals", "",
     "Spindle enable,Spindle direction,PWM"},
    {29, Group::kStepper, Type::kInteger, "Direction set-up time", "us", ""},
    {33, Group::kSpindle, Type::kInteger, "Spindle PWM frequency", "Hz", ""},
    {34, Group::kSpindle, Type::kDecimal, "Spindle PWM off value", "percent", ""},
    {35, Group::kSpindle, Type::kDecimal, "Spindle PWM min value", "percent", ""},
    {36, Group::kSpindle, Type::kDecimal, "Spindle PWM max value", "percent", ""},
    {37, Group::kStepper, Type::kAxes, "Steppers to keep enabled", "", ""},
    {44, Group::kHoming, Type::kAxes, "Axes homing, first pass", "", ""},
    {45, Group::kHoming, Type::kAxes, "Axes homing, second pass", "", ""},
    {46, Group::kHoming, Type::kAxes, "Axes homing, third pass", "", ""},
    {140, Group::kAxis, Type::kInteger, "motor current", "mA", ""},
    {150, Group::kAxis, Type::kInteger, "microsteps", "steps", ""},
    {160, Group::kAxis, Type::kDecimal, "backlash compensation", "mm", ""},
    {170, Group::kAxis, Type::kDecimal, "dual axis offset", "mm", ""},
    {210, Group::kAxis, Type::kInteger, "hold current", "percent", ""},
    {338, Group::kStepper, Type::kAxes, "Trinamic driver", "", ""},
    {340, Group::kSpindle, Type::kInteger, "Spindle at speed tolerance", "percent", ""},
    {341, Group::kToolChange, Type::kChoice, "Tool change mode", "",
     "Normal,Manual touch off,Manual touch off @ G59.3,Automatic touch off @ G59.3,Ignore M6"},
    {342, Group::kToolChange, Type::kDecimal, "Tool change probing distance", "mm", ""},
    {343, Group::kToolChange, Type::kDecimal, "Tool change locate feed rate", "mm/min", ""},
    {344, Group::kToolChange, Type::kDecimal, "Tool change search seek rate", "mm/min", ""},
    {347, Group::kSecondMotor, Type::kDecimal, "Dual axis length fail", "percent", ""},
    {348, Group::kSecondMotor, Type::kDecimal, "Dual axis length fail min", "mm", ""},
    {349, Group::kSecondMotor, Type::kDecimal, "Dual axis length fail max", "mm", ""},
    {374, Group::kModbus, Type::kChoice, "ModBus baud rate", "",
     "2400,4800,9600,19200,38400,115200"},
    {375, Group::kModbus, Type::kInteger, "ModBus RX timeout", "ms", ""},
    {394, Group::kSpindle, Type::kDecimal, "Spindle on delay", "s", ""},
    {395, Group::kSpindle, Type::kChoice, "Default spindle", "",
     "PWM,Huanyang,Huanyang P2A,MODVFD"},
    {460, Group::kModbus, Type::kInteger, "VFD ModBus address", "", ""},
    {462, Group::kModbus, Type::kInteger, "Run/Stop register", "", ""},
    {463, Group::kModbus, Type::kInteger, "Set frequency register", "", ""},
    {464, Group::kModbus, Type::kInteger, "Get frequency register", "", ""},
    {465, Group::kModbus, Type::kInteger, "Run CW command", "", ""},
    {466, Group::kModbus, Type::kInteger, "Run CCW command", "", ""},
    {467, Group::kModbus, Type::kInteger, "Stop command", "", ""},
    {468, Group::kModbus, Type::kInteger, "RPM input multiplier", "", ""},
    {469, Group::kModbus, Type::kInteger, "RPM input divider", "", ""},
    {470, Group::kModbus, Type::kInteger, "RPM output multiplier", "", ""},
    {471, Group::kModbus, Type::kInteger, "RPM output divider", "", ""},
    {481, Group::kGeneral, Type::kInteger, "Autoreport interval", "ms", ""},
    {790, Group::kLimits, Type::kInteger, "Input filter", "ms", ""},
    {791, Group::kGeneral, Type::kInteger, "Hold if the link is silent for", "ms", ""},
    {792, Group::kGeneral, Type::kSwitch, "Hold at an error", "", ""},
    {793, Group::kSecondMotor, Type::kChoice, "Axis with a second motor", "",
     kHasRotaryAxis ? "None,X-axis,Y-axis,Z-axis,none: it is A" : "None,X-axis,Y-axis,Z-axis"},
    {794, Group::kSecondMotor, Type::kSwitch, "Fourth motor has a switch", "", ""},
    {795, Group::kControls, Type::kSwitch, "Optional stop", "", ""},
    {796, Group::kGeneral, Type::kSwitch, "Hold if the sender leaves USB", "", ""},
    {797, Group::kSpindle, Type::kSwitch, "Wait for the at-speed input", "", ""},
    {798, Group::kStepper, Type::kAxes, "Drivers that are TMC5160", "", ""},
    {800, Group::kAxis, Type::kDecimal, "jerk", "mm/sec^3", ""},
    {810, Group::kAxis, Type::kChoice, "input shaper", "", "None,ZV,ZVD,EI"},
    {820, Group::kAxis, Type::kDecimal, "vibration frequency", "Hz", ""},
    {830, Group::kAxis, Type::kDecimal, "vibration damping ratio", "", ""},
    {840, Group::kAxis, Type::kDecimal, "stealthChop up to", "mm/min", ""},
    {850, Group::kAxis, Type::kDecimal, "homing pull-off", "mm", ""},
}};

const SettingName& name_of(std::uint16_t number) noexcept
{
    for (const SettingName& name : kNames) {
        const unsigned count = name.group == Group::kAxis ? kAxisCount : 1U;
        if (number >= name.number && number < name.number + count) {
            return name;
        }
    }
    return kNames[0];  // every setting is there: tests/unit/machine/enumerations_test.cpp
}

struct CodeText {
    std::uint8_t code;
    std::string_view text;
};
constexpr CodeText text_for(Error error, std::string_view text) noexcept
{
    return {static_cast<std::uint8_t>(error), text};
}
constexpr CodeText text_for(Alarm alarm, std::string_view text) noexcept
{
    return {static_cast<std::uint8_t>(alarm), text};
}
constexpr std::array<CodeText, 37> kErrors{{
    text_for(Error::kExpectedCommandLetter, "A word does not begin with a letter."),
    text_for(Error::kBadNumberFormat, "A value is missing or no number."),
    text_for(Error::kInvalidStatement, "The $ command or setting is not known."),
    text_for(Error::kNegativeValue, "A value is negative, or 0 where it must not be."),
    text_for(Error::kSettingDisabled, "Homing is off or has no axis, or the board lacks the pins."),
    text_for(Error::kSettingStepPulseMin, "The step pulse is too short."),
    text_for(Error::kSettingReadFail, "Stored settings could not be read, or new ones not stored."),
    text_for(Error::kIdleError, "Not in this state."),
    text_for(Error::kSystemGcLock, "G-code is locked: alarm or jog."),
    text_for(Error::kSoftLimitError, "Soft limits need homing."),
    text_for(Error::kOverflow, "The line is too long, or bytes of it were lost."),
    text_for(Error::kMaxStepRateExceeded, "Steps would come too close."),
    text_for(Error::kCheckDoor, "The door is open."),
    text_for(Error::kLineLengthExceeded, "The text is too long to store."),
    text_for(Error::kTravelExceeded, "The move would leave the travel."),
    text_for(Error::kInvalidJogCommand, "A jog has a word that is not allowed."),
    text_for(Error::kGcodeUnsupportedCommand, "A G or M word is not supported."),
    text_for(Error::kGcodeModalGroupViolation, "Two words of one modal group."),
    text_for(Error::kGcodeUndefinedFeedRate, "No feed is set."),
    text_for(Error::kGcodeCommandValueNotInteger, "A G or M number must be whole."),
    text_for(Error::kGcodeAxisCommandConflict, "Two commands use the axis words."),
    text_for(Error::kGcodeWordRepeated, "A word is repeated."),
    text_for(Error::kGcodeNoAxisWords, "Axis words are missing."),
    text_for(Error::kGcodeInvalidLineNumber, "The line number is out of range."),
    text_for(Error::kGcodeValueWordMissing, "A value word is missing."),
    text_for(Error::kGcodeUnsupportedCoordSys, "The coordinate system is not supported."),
    text_for(Error::kGcodeG53InvalidMotionMode, "G53 needs G0 or G1."),
    text_for(Error::kGcodeAxisWordsExist, "Axis words that nothing uses."),
    text_for(Error::kGcodeNoAxisWordsInPlane, "An arc has no axis word in its plane."),
    text_for(Error::kGcodeInvalidTarget, "The target or geometry is impossible."),
    text_for(Error::kGcodeArcRadiusError, "No arc of this radius reaches the target."),
    text_for(Error::kGcodeNoOffsetsInPlane, "An arc has no centre offset in its plane."),
    text_for(Error::kGcodeUnusedWords, "Value words that nothing uses."),
    text_for(Error::kGcodeG43DynamicAxisError, "A tool length offset on an axis other than Z."),
    text_for(Error::kGcodeMaxValueExceeded, "A number is too large."),
    text_for(Error::kHomingRequired, "The tool change needs a homed machine."),
    text_for(Error::kNoToolChangePlace, "G59.3, the place of the tool change, is not set."),
}};
constexpr std::array<CodeText, 13> kAlarms{{
    text_for(Alarm::kHardLimit, "A hard limit was hit. The position may be lost."),
    text_for(Alarm::kSoftLimit, "A move would leave the travel. The position is kept."),
    text_for(Alarm::kAbortInMotion, "Reset in motion. The position may be lost."),
    text_for(Alarm::kProbeInitial, "The probe was not as it should be before its move."),
    text_for(Alarm::kProbeContact, "The probe did not touch."),
    text_for(Alarm::kHomingReset, "Reset while homing."),
    text_for(Alarm::kHomingDoor, "The door opened while homing."),
    text_for(Alarm::kHomingPullOff, "A switch stayed closed after the pull-off."),
    text_for(Alarm::kHomingApproach, "Homing found no switch."),
    text_for(Alarm::kEmergencyStop, "The emergency stop is pressed."),
    text_for(Alarm::kSpindle, "The spindle did not come up in time, or its drive does not answer."),
    text_for(Alarm::kSquaringApproach,
             "A switch of an axis with two motors did not close in time."),
    text_for(Alarm::kMotorFault, "A drive reports a fault."),
}};

template <std::size_t N>
bool write_code(const std::array<CodeText, N>& texts,
                unsigned index,
                std::string_view word,
                ReplyQueue& out) noexcept
{
    if (index >= texts.size()) {
        return false;
    }
    (void)out.text(word).number(texts[index].code).text("||").text(texts[index].text);
    (void)out.character(']').end_line();
    return true;
}

// A's are degrees.
void write_unit(std::string_view unit, unsigned axis, ReplyQueue& out) noexcept
{
    constexpr std::string_view kMillimetres = "mm";
    const std::size_t at = axis < kLinearAxes ? std::string_view::npos : unit.find(kMillimetres);
    if (at == std::string_view::npos) {
        (void)out.text(unit);
        return;
    }
    (void)out.text(unit.substr(0, at)).text("deg").text(unit.substr(at + kMillimetres.size()));
}

}  // namespace

bool write_setting_description(unsigned index, unsigned axes, ReplyQueue& out) noexcept
{
    if (index >= kSettingCount) {
        return false;
    }
    const SettingEntry& entry = setting_entry(index);
    const SettingName& name = name_of(entry.number);
    const bool of_axis = name.group == Group::kAxis;
    const unsigned axis = of_axis ? unsigned{entry.number} - name.number : 0U;
    if (axis >= axes) {
        return true;
    }
    const auto group = static_cast<unsigned>(of_axis ? axis_group(axis) : name.group);
    (void)out.text("[SETTING:").number(entry.number).character('|').number(group).character('|');
    if (of_axis) {
        (void)out.character("XYZA"[axis]).text("-axis ");
    }
    (void)out.text(name.name).character('|');
    write_unit(name.unit, axis, out);
    (void)out.character('|');
    (void)out.number(static_cast<unsigned>(name.type)).character('|');
    const bool has_range = name.type == Type::kInteger || name.type == Type::kDecimal;
    if (!has_range) {
        (void)out.text(name.type == Type::kAxes ? "axes" : name.choices).text("||");
    } else {
        (void)out.text(name.type == Type::kInteger ? "#######0" : "#######0.000");
        for (const float bound : {entry.least, entry.most}) {
            (void)out.character('|').decimal(protocol::scaled(bound, entry.decimals),
                                             entry.decimals);
        }
    }
    // No restart is needed, and there is no empty value.
    (void)out.text("|0|0]").end_line();
    return true;
}

bool write_setting_group(unsigned index, unsigned axes, ReplyQueue& out) noexcept
{
    if (index >= kGroups.size() - kLinearAxes - 1 + axes) {
        return false;
    }
    const GroupName& group = kGroups[index];
    (void)out.text("[SETTINGGROUP:").number(static_cast<unsigned>(group.group)).character('|');
    (void)out.number(static_cast<unsigned>(group.parent)).character('|').text(group.name);
    (void)out.character(']').end_line();
    return true;
}

bool write_error_code(unsigned index, ReplyQueue& out) noexcept
{
    return write_code(kErrors, index, "[ERRORCODE:", out);
}

bool write_alarm_code(unsigned index, ReplyQueue& out) noexcept
{
    return write_code(kAlarms, index, "[ALARMCODE:", out);
}

}  // namespace cusp::machine
