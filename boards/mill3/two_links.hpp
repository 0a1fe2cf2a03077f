// TwoLinks: a serial port and USB at once, as one link. Answers go where the lines come from.
//
// One of both is the one whose lines are read. The other's realtime bytes act at once; its text is
// kept back until every line of the first is answered, and then it has the turn. Queries are answered to
// the link that has the turn, which one takes by any byte while nothing is owed to the other.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/protocol/realtime_command.hpp"
#include "firmware/protocol/receive_queue.hpp"
#include "hal/contract/board.hpp"

namespace cusp::boards {

// `Serial` and `Usb` as hal/stm32f4/dma_link.hpp and usb_link.hpp. Context as in
// hal/contract/board.hpp.
template <class Serial, class Usb>
class TwoLinks {
public:
    Serial serial;
    Usb usb;

    // The serial port's.
    void on_interrupt() noexcept { serial.on_interrupt(); }

    bool try_read(std::uint8_t& byte) noexcept
    {
        // By turns: a flood on one link keeps no stop of the other waiting.
        other_first_ = !other_first_;
        return other_first_ ? read_other(byte) || read_own(byte)
                            : read_own(byte) || read_other(byte);
    }
    bool try_scan(std::uint8_t& byte) noexcept
    {
        return serial.try_scan(byte) || usb.try_scan(byte);
    }
    bool overrun() noexcept;
    std::uint32_t write_room() const noexcept
    {
        return usb_has_turn_ ? usb.write_room() : serial.write_room();
    }
    void write(Span<const std::uint8_t> bytes) noexcept
    {
        usb_has_turn_ ? usb.write(bytes) : serial.write(bytes);
    }
    void follow(const hal::LineState& lines) noexcept;
    bool sender_left() noexcept { return usb.sender_left() && usb_has_turn_; }

private:
    static constexpr std::uint32_t kParked = 256;
    // A line that has begun and does not go on for so many ticks is given up for the other's.
    static constexpr std::uint32_t kPatience = 2000;

    bool read(bool from_usb, std::uint8_t& byte) noexcept
    {
        return from_usb ? usb.try_read(byte) : serial.try_read(byte);
    }
    bool is_gone() const noexcept { return usb_has_turn_ && !usb.open() && usb.empty(); }
    bool may_turn() const noexcept
    {
        return lines_.silent && (lines_.answered || !owes_ || is_gone());
    }
    void turn() noexcept;
    void tell_parked_loss() noexcept;
    bool read_own(std::uint8_t& byte) noexcept;
    bool read_other(std::uint8_t& byte) noexcept;
    void note_text(std::uint8_t byte) noexcept;

    bool usb_has_turn_{false};
    bool other_first_{false};
    hal::LineState lines_{true, true, 0, 0};
    bool owes_{false};       // answers, to the link that has the turn
    bool amid_line_{false};  // the last text that was read is no line's end
    std::uint32_t text_at_{0};
    bool lost_{false};           // of the link that has the turn
    bool serial_lost_{false};    // while what was kept back of USB is read
    bool ends_line_{false};      // a line that is given up
    bool asked_{false};          // the other has sent a realtime byte amid a line
    bool parked_is_own_{false};  // what was kept back is now to be read
    bool parked_lost_{false};    // of the other's text
    std::array<std::uint8_t, kParked> parked_{};
    std::uint32_t parked_head_{0};  // both count bytes and wrap
    std::uint32_t parked_tail_{0};
};

template <class Serial, class Usb>
void TwoLinks<Serial, Usb>::follow(const hal::LineState& lines) noexcept
{
    lines_ = lines;
    owes_ = owes_ && !lines.answered;
    asked_ = asked_ && amid_line_;
    const bool other_waits = !parked_is_own_ && (parked_head_ != parked_tail_ || parked_lost_);
    if (amid_line_ && lines.answered && (other_waits || asked_ || is_gone())) {
        // The rest of the line may never come: it is refused, not executed in part.
        ends_line_ = is_gone() || lines.tick - text_at_ > kPatience;
        lost_ = lost_ || ends_line_;
    }
    if (!amid_line_ && may_turn() && (other_waits || is_gone())) {
        turn();
    }
}

template <class Serial, class Usb>
void TwoLinks<Serial, Usb>::turn() noexcept
{
    usb_has_turn_ = !usb_has_turn_;
    parked_is_own_ = parked_head_ != parked_tail_;
    owes_ = parked_is_own_;
    tell_parked_loss();
}

// Lost bytes came after the text that was kept.
template <class Serial, class Usb>
void TwoLinks<Serial, Usb>::tell_parked_loss() noexcept
{
    if (!parked_is_own_) {
        lost_ = parked_lost_;
        parked_lost_ = false;
    }
}

template <class Serial, class Usb>
bool TwoLinks<Serial, Usb>::overrun() noexcept
{
    serial_lost_ = serial.overrun() || serial_lost_;
    const bool undecided = parked_is_own_ && usb_has_turn_;
    if (serial_lost_ && !undecided) {
        serial_lost_ = false;
        (usb_has_turn_ || parked_is_own_ ? parked_lost_ : lost_) = true;
    }
    const bool lost = lost_;
    lost_ = false;
    return lost;
}

template <class Serial, class Usb>
void TwoLinks<Serial, Usb>::note_text(std::uint8_t byte) noexcept
{
    owes_ = true;
    amid_line_ = !protocol::is_line_end(byte);
    text_at_ = lines_.tick;
    lines_.answered = false;
    lines_.room -= lines_.room > 0 ? 1 : 0;
}

template <class Serial, class Usb>
bool TwoLinks<Serial, Usb>::read_own(std::uint8_t& byte) noexcept
{
    if (lost_) {
        return false;  // what is lost is told before what follows
    }
    if (ends_line_) {
        ends_line_ = false;
        byte = '\n';
        note_text(byte);
        return true;
    }
    const bool has_room = lines_.room > 0;
    if (parked_is_own_) {
        if (has_room) {
            byte = parked_[parked_tail_ % kParked];
            ++parked_tail_;
            parked_is_own_ = parked_head_ != parked_tail_;
            note_text(byte);
            tell_parked_loss();
        }
        return has_room;
    }
    // USB holds its sender back; on the serial line bytes without room are lost, and told.
    if ((usb_has_turn_ && !has_room) || !read(usb_has_turn_, byte)) {
        return false;
    }
    if (protocol::byte_kind(byte) == protocol::ByteKind::kText) {
        note_text(byte);
    }
    return true;
}

template <class Serial, class Usb>
bool TwoLinks<Serial, Usb>::read_other(std::uint8_t& byte) noexcept
{
    constexpr unsigned kBytesAtOnce = 64;
    for (unsigned i = 0; i < kBytesAtOnce && !parked_is_own_ && read(!usb_has_turn_, byte); ++i) {
        const bool text = protocol::byte_kind(byte) == protocol::ByteKind::kText;
        const bool parks = parked_head_ != parked_tail_ || parked_lost_;
        const bool turns = may_turn() && !amid_line_ && !(text && parks);
        asked_ = !turns;
        if (turns) {
            turn();
        }
        if (!text) {
            return true;
        }
        if (turns) {
            note_text(byte);
            return true;
        }
        if (parked_head_ - parked_tail_ < kParked) {
            parked_[parked_head_ % kParked] = byte;
            ++parked_head_;
        } else {
            parked_lost_ = true;
        }
    }
    return false;
}

}  // namespace cusp::boards
