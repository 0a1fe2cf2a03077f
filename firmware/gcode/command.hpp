// The words of one line, sorted into modal groups, before their meaning is checked.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "firmware/base/axis.hpp"
#include "firmware/base/result.hpp"
#include "firmware/gcode/decimal.hpp"
#include "firmware/gcode/modal_state.hpp"

namespace cusp::gcode {

// The command that the axis words of a line belong to; at most one.
enum class AxisUse : std::uint8_t { kNone, kNonModal, kMotion, kToolLength };

// Group 0: commands that hold for one line.
enum class NonModal : std::uint8_t {
    kNone,
    kDwell,                  // G4
    kSetOffset,              // G10 L2, L20
    kGoHome,                 // G28
    kGoSecondHome,           // G30
    kStoreHome,              // G28.1
    kStoreSecondHome,        // G30.1
    kMachineCoordinates,     // G53
    kSetCoordinateOffset,    // G92
    kSetLocalOffset,         // G52
    kClearCoordinateOffset,  // G92.1, G92.2
};

enum class ToolLength : std::uint8_t { kUnchanged, kCancel, kFromTable, kDynamic };

enum class ProgramFlow : std::uint8_t { kRunning, kPause, kOptionalPause, kEnd };

// A set of value words, one bit a letter, A in bit 0.
using LetterSet = std::uint32_t;

constexpr unsigned letter_index(char letter) noexcept
{
    return static_cast<unsigned>(letter - 'A');
}
constexpr LetterSet letter(char upper_case) noexcept { return 1U << letter_index(upper_case); }

constexpr char axis_letter(unsigned axis) noexcept { return "XYZA"[axis]; }

inline constexpr LetterSet kLinearLetters = letter('X') | letter('Y') | letter('Z');
inline constexpr LetterSet kRotaryLetters = letter('A') | letter('B') | letter('C');

// The modal groups of G and M words, one bit each: a line names each group at most once.
enum class Group : std::uint8_t {
    kNonModal,
    kMotion,
    kPlane,
    kDistance,
    kArcDistance,
    kFeedMode,
    kUnits,
    kCutterRadius,
    kToolLength,
    kReturnLevel,
    kCoordinateSystem,
    kPathControl,
    kStop,
    kToolChange,
    kSpindle,
    kSpindleMode,
    kCoolant,
};

struct Command {
    ModalState modal;  // after the line, as far as its G and M words set it
    AxisUse axis_use{AxisUse::kNone};
    NonModal non_modal{NonModal::kNone};
    ToolLength tool_length{ToolLength::kUnchanged};
    ProgramFlow flow{ProgramFlow::kRunning};
    Coolant coolant{Coolant::kOff};    // where the line names it
    bool cancels{false};               // G80
    bool ends_curve{false};            // G5.3
    unsigned axis_count{kLinearAxes};  // of the machine, X first
    std::uint32_t groups{0};           // one bit a Group
    LetterSet words{0};                // value words present
    LetterSet unused{0};               // value words not used yet
    std::array<Decimal, 26> values{};

    bool names(Group group) const noexcept
    {
        return (groups >> static_cast<unsigned>(group) & 1U) != 0;
    }
    bool has(char upper_case) const noexcept { return (words & letter(upper_case)) != 0; }
    // Letters of axes that the machine has, and of those that it has not.
    LetterSet axis_letters() const noexcept
    {
        return axis_count > kLinearAxes ? kLinearLetters | letter('A') : kLinearLetters;
    }
    LetterSet absent_letters() const noexcept { return kRotaryLetters & ~axis_letters(); }
    LetterSet axes() const noexcept { return words & axis_letters(); }
    bool names_axis(unsigned axis) const noexcept
    {
        return axis < axis_count && has(axis_letter(axis));
    }
    bool is_blank() const noexcept { return groups == 0 && words == 0; }
    const Decimal& value(char upper_case) const noexcept
    {
        return values[letter_index(upper_case)];
    }
    // Marks a word as used.
    void use(char upper_case) noexcept { unused &= ~letter(upper_case); }
};

// Reads the words of a line; `modal` is the state before it.
//
// Comments in ( ) and after ;, spaces, '/' and a byte order mark before all are skipped; a line that
// begins with % is blank, and so is a program number alone, O1001 or :1001.
// Errors, in the order of the words:
//   kExpectedCommandLetter, kBadNumberFormat       not a letter and a number
//   kGcodeUnsupportedCommand                       a letter, G or M number that is not known
//   kGcodeCommandValueNotInteger                   a G or M number with a decimal it does not have
//   kGcodeModalGroupViolation                      two words of a group; G80 beside another motion is
//                                                  no second one and has no effect (LinuxCNC)
//   kGcodeAxisCommandConflict                      two commands that use axis words
//   kGcodeWordRepeated, kNegativeValue             value words
//   kGcodeMaxValueExceeded                         more than 12 digits before the point
Status read_command(std::string_view line, const ModalState& modal, Command& command) noexcept;

}  // namespace cusp::gcode
