// Error: why a line was refused. The numbers are Grbl 1.1's; they go over the wire and are never
// reused.
#pragma once

#include <cstdint>

namespace cusp {

enum class Error : std::uint8_t {
    kExpectedCommandLetter = 1,  // a G-code word has a letter and a value; the letter was not found
    kBadNumberFormat = 2,        // the value of a word is missing or no number
    kInvalidStatement = 3,       // a $ command is not known
    kNegativeValue = 4,          // a value that must not be negative is
    kSettingDisabled = 5,        // homing is not switched on
    kSettingStepPulseMin = 6,    // the step pulse is too short
    kSettingReadFail = 7,        // a stored setting could not be read
    kIdleError = 8,              // the command needs the machine idle
    kSystemGcLock = 9,           // G-code is locked out in alarm, jog or sleep
    kSoftLimitError = 10,        // soft limits need homing
    kOverflow = 11,              // the line is too long
    kMaxStepRateExceeded = 12,   // the setting makes steps closer than the pulse width allows
    kCheckDoor = 13,             // the safety door is open
    kLineLengthExceeded = 14,    // the startup line or build info is too long
    kTravelExceeded = 15,        // the jog target is beyond the machine's travel
    kInvalidJogCommand = 16,     // a jog has no = or a word that is not allowed
    kSettingDisabledLaser = 17,  // laser mode needs a PWM spindle
    kGcodeUnsupportedCommand = 20,      // a G or M number that is not known
    kGcodeModalGroupViolation = 21,     // two words of one modal group in a line
    kGcodeUndefinedFeedRate = 22,       // a feed move without a feed
    kGcodeCommandValueNotInteger = 23,  // a G or M number must be whole here
    kGcodeAxisCommandConflict = 24,     // two commands of the line both want the axis words
    kGcodeWordRepeated = 25,            // a word occurs twice in the line
    kGcodeNoAxisWords = 26,             // a command that needs axis words has none
    kGcodeInvalidLineNumber = 27,       // the N number is out of range
    kGcodeValueWordMissing = 28,        // a command lacks a value word
    kGcodeUnsupportedCoordSys = 29,     // the work coordinate system is not known
    kGcodeG53InvalidMotionMode = 30,    // G53 needs G0 or G1
    kGcodeAxisWordsExist = 31,          // axis words that nothing uses
    kGcodeNoAxisWordsInPlane = 32,      // an arc without an axis word in its plane
    kGcodeInvalidTarget = 33,        // an arc, probe or curve with an impossible target or geometry
    kGcodeArcRadiusError = 34,       // no arc of this radius reaches the target
    kGcodeNoOffsetsInPlane = 35,     // an arc without a centre offset in its plane
    kGcodeUnusedWords = 36,          // value words that nothing uses
    kGcodeG43DynamicAxisError = 37,  // a tool length offset on an axis other than Z
    kGcodeMaxValueExceeded = 38,     // a number is larger than the machine can take
    kHomingRequired = 46,            // grblHAL's number: a tool change goes to machine positions
    kNoToolChangePlace =
        47,  // grblHAL's "tool error": G59.3, where the tool is changed, is not set
};

}  // namespace cusp
