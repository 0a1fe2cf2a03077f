// The parts that a board offers to the firmware. One type per concern, handed to app as template
// arguments, so that every call in the real-time path is direct. A contract is this comment plus a
// compile-time check of the member functions; noexcept is part of their types.
#pragma once

#include <cstdint>
#include <type_traits>

#include "firmware/base/panel.hpp"
#include "firmware/base/pulse_frame.hpp"
#include "firmware/base/span.hpp"

namespace cusp::hal {

// PulsePlayer plays pulse frames back to back, one a millisecond, exactly two in flight.
//
//   try_play(frame)  takes over a copy of the frame and returns true, or returns false at once
//                    where two frames are in flight already. Context: servo tick. Bounded time.
//   underrun()       whether a frame was missing while motion went on: steps are low, and the
//                    player plays nothing more until clear_underrun(). Context: any.
//   clear_underrun() Context: main loop.
//   invert(lines)    lines whose pin is low where the line is high, from the next silence on.
//                    Context: main loop.
template <class T>
constexpr bool is_pulse_player()
{
    static_assert(std::is_same_v<decltype(&T::try_play), bool (T::*)(const PulseFrame&) noexcept>);
    static_assert(std::is_same_v<decltype(&T::underrun), bool (T::*)() const noexcept>);
    static_assert(std::is_same_v<decltype(&T::clear_underrun), void (T::*)() noexcept>);
    static_assert(std::is_same_v<decltype(&T::invert), void (T::*)(PulseLines) noexcept>);
    return true;
}

// ByteLink carries the serial line. Context: main loop, but for try_scan(); no call waits.
//
//   try_read(byte)   one received byte, or false where none waits.
//   try_scan(byte)   one received byte that neither call has given yet, which stays to be read; false
//                    where there is none. So the servo tick sees a stop that the main loop does not come
//                    to read. Context: servo tick. Bounded time.
//   overrun()        whether received bytes were lost since the last call; clears the mark.
//   write_room()     bytes that write() takes now.
//   write(bytes)     precondition: bytes.size() <= write_room().
//
// A link with more than one sender, or one that can hold a sender back, also has
//
//   follow(lines)    the state of the lines that were read, before the next are. A sender is held
//                    back while there is no room.
//   sender_left()    whether the sender whose lines are read has left since the last call: its plug,
//                    or the program that held its port.
struct LineState {
    bool answered;       // every line, and every query
    bool silent;         // no answer waits to be written
    std::uint32_t room;  // bytes of text that may be read
    std::uint32_t tick;  // of the servo; wraps
};
template <class T, class = void>
inline constexpr bool follows_lines = false;
template <class T>
inline constexpr bool follows_lines<T, std::void_t<decltype(&T::follow)>> = true;

template <class T>
constexpr bool is_byte_link()
{
    if constexpr (follows_lines<T>) {
        static_assert(std::is_same_v<decltype(&T::follow), void (T::*)(const LineState&) noexcept>);
        static_assert(std::is_same_v<decltype(&T::sender_left), bool (T::*)() noexcept>);
    }
    static_assert(std::is_same_v<decltype(&T::try_read), bool (T::*)(std::uint8_t&) noexcept>);
    static_assert(std::is_same_v<decltype(&T::try_scan), bool (T::*)(std::uint8_t&) noexcept>);
    static_assert(std::is_same_v<decltype(&T::overrun), bool (T::*)() noexcept>);
    static_assert(std::is_same_v<decltype(&T::write_room), std::uint32_t (T::*)() const noexcept>);
    static_assert(
        std::is_same_v<decltype(&T::write), void (T::*)(Span<const std::uint8_t>) noexcept>);
    return true;
}

// The words of the panel are firmware/base/panel.hpp's. Inputs are raw: machine/ inverts and
// filters them as the settings say.
using cusp::InputBit;
using cusp::kAtSpeed;
using cusp::kDoor;
using cusp::kEmergencyStop;
using cusp::kFourthLimit;
using cusp::kHoldButton;
using cusp::kLimitX;
using cusp::kLimitY;
using cusp::kLimitZ;
using cusp::kMotorFault;
using cusp::kProbe;
using cusp::kResetButton;
using cusp::kStartButton;
using cusp::OutputLevels;

// Panel reads inputs and sets outputs. Context: main loop and servo tick; bounded time.
//
//   inputs()      bits of InputBit; 1 = the pin is high.
//   set(levels)   takes effect at once.
//   set_duty(pwm) changes the duty cycle of the spindle's pulses alone, 0 to kFullDuty; in the servo tick.
template <class T>
constexpr bool is_panel()
{
    static_assert(std::is_same_v<decltype(&T::inputs), std::uint16_t (T::*)() const noexcept>);
    static_assert(std::is_same_v<decltype(&T::set), void (T::*)(const OutputLevels&) noexcept>);
    static_assert(std::is_same_v<decltype(&T::set_duty), void (T::*)(std::uint16_t) noexcept>);
    return true;
}

// SettingsStore keeps bytes over a power cycle: a log of two sectors, written in words, that may
// fail at any write. machine/ puts records with sequence numbers and CRC into it. Context: main
// loop, in idle or alarm, never with frames in flight.
//
//   sector_size()                 bytes in each of the two sectors; a multiple of 4.
//   read(sector, offset, bytes)   offset and size within the sector; erased bytes are 0xFF.
//   write(sector, offset, bytes)  false where the write failed; offset and size multiples of 4;
//                                 only erased bytes may be written.
//   erase(sector)                 false where it failed.
template <class T>
constexpr bool is_settings_store()
{
    static_assert(std::is_same_v<decltype(&T::sector_size), std::uint32_t (T::*)() const noexcept>);
    static_assert(
        std::is_same_v<decltype(&T::read),
                       void (T::*)(unsigned, std::uint32_t, Span<std::uint8_t>) const noexcept>);
    static_assert(
        std::is_same_v<decltype(&T::write),
                       bool (T::*)(unsigned, std::uint32_t, Span<const std::uint8_t>) noexcept>);
    static_assert(std::is_same_v<decltype(&T::erase), bool (T::*)(unsigned) noexcept>);
    return true;
}

// DriveWire carries datagrams to the motors' drives and back, one at a time. Context: main loop; no call
// waits. Only a board with wires to drives has one.
//
//   begin(drive, bytes, replies)  sends at most 8 bytes to a drive; `replies`: it answers. What was on its
//                                 way before is given up.
//   busy()                        whether that is still under way.
//   take(answer)                  the bytes of the answer, at most 8; how many came. Precondition: !busy().
//   let_go()                      before the core stands still, as in an erase: gives a request up that it
//                                 would have to turn the wire round for. Whether there was one.
template <class T>
constexpr bool is_drive_wire()
{
    static_assert(std::is_same_v<decltype(&T::begin),
                                 void (T::*)(unsigned, Span<const std::uint8_t>, bool) noexcept>);
    static_assert(std::is_same_v<decltype(&T::busy), bool (T::*)() const noexcept>);
    static_assert(
        std::is_same_v<decltype(&T::take), std::size_t (T::*)(Span<std::uint8_t>) const noexcept>);
    static_assert(std::is_same_v<decltype(&T::let_go), bool (T::*)() noexcept>);
    return true;
}
// Such a board has a drive_wire; kDriveWires, the motors that it reaches, a bit each for X, Y, Z and the
// second motor; and kSenseMilliohms, the sense resistors of the drives.
template <class Board, class = void>
inline constexpr bool has_drive_wire = false;
template <class Board>
inline constexpr bool has_drive_wire<Board, std::void_t<decltype(Board::drive_wire)>> =
    is_drive_wire<decltype(Board::drive_wire)>();

// DriveBus carries datagrams to drives that share their wires. Context: main loop; takes some 50 us. Only a board
// that has a drive_wire may have one, as its drive_bus, with kBusSenseMilliohms, the sense resistors of drives on it.
//
//   ask(drive, bytes, answer)  sends a datagram as long as the answer, then one of zeros: what comes with that is
//                              the answer.
template <class T>
constexpr bool is_drive_bus()
{
    static_assert(
        std::is_same_v<decltype(&T::ask), void (T::*)(unsigned, Span<const std::uint8_t>,
                                                      Span<std::uint8_t>) const noexcept>);
    return true;
}
template <class Board, class = void>
inline constexpr bool has_drive_bus = false;
template <class Board>
inline constexpr bool has_drive_bus<Board, std::void_t<decltype(Board::drive_bus)>> =
    is_drive_bus<decltype(Board::drive_bus)>();

// SpindleWire carries messages to a spindle's drive and back over a line that both share (RS-485), one at a
// time. Context: main loop; no call waits. Only a board with such a line has one, as its spindle_wire.
//
//   begin(bytes, baud)  sends at most 16 bytes, then listens. What came before is forgotten.
//   heard(answer)       the bytes that have come since, at most 16, from the first on; how many.
//   let_go()            before the core stands still, as in an erase: gives up what is being sent. Whether
//                       something was.
template <class T>
constexpr bool is_spindle_wire()
{
    static_assert(std::is_same_v<decltype(&T::begin),
                                 void (T::*)(Span<const std::uint8_t>, std::uint32_t) noexcept>);
    static_assert(
        std::is_same_v<decltype(&T::heard), std::size_t (T::*)(Span<std::uint8_t>) const noexcept>);
    static_assert(std::is_same_v<decltype(&T::let_go), bool (T::*)() noexcept>);
    return true;
}
template <class Board, class = void>
inline constexpr bool has_spindle_wire = false;
template <class Board>
inline constexpr bool has_spindle_wire<Board, std::void_t<decltype(Board::spindle_wire)>> =
    is_spindle_wire<decltype(Board::spindle_wire)>();

// A Board bundles the four: an object of each, named pulse_player, byte_link, panel,
// settings_store; kMostStepsPerSecond, the steps that it plays on each axis while all three move;
// kSecondMotor, whether it has pins for the second motor of an axis; and kAtSpeedInput, whether it has
// one for the spindle's at-speed signal.
template <class Board>
constexpr bool is_board()
{
    static_assert(std::is_same_v<decltype(Board::kMostStepsPerSecond), const std::uint32_t>);
    static_assert(std::is_same_v<decltype(Board::kSecondMotor), const bool>);
    static_assert(std::is_same_v<decltype(Board::kAtSpeedInput), const bool>);
    return is_pulse_player<decltype(Board::pulse_player)>() &&
           is_byte_link<decltype(Board::byte_link)>() && is_panel<decltype(Board::panel)>() &&
           is_settings_store<decltype(Board::settings_store)>();
}

}  // namespace cusp::hal
