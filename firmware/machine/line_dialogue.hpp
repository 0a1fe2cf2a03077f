// LineDialogue: lines from the sender, and the answers to them.
//
//   receive(byte) -> realtime bytes are the caller's, text waits
//   read(text)    -> the next line that is to be executed
//   answer(error) -> its answer; next() lets the line after it come
//
// Lines that can't be executed (too long, damaged, lost) are answered here.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "firmware/base/error.hpp"
#include "firmware/protocol/checked_lines.hpp"
#include "firmware/protocol/line_assembler.hpp"
#include "firmware/protocol/receive_queue.hpp"
#include "firmware/protocol/reply_queue.hpp"

namespace cusp::machine {

// Context: main loop, but for checked().
class LineDialogue {
public:
    // `replies` must outlive this.
    explicit LineDialogue(protocol::ReplyQueue& replies) noexcept : replies_{replies} {}

    // A byte from the sender at servo tick `now`. True if it is a realtime byte that counts.
    bool receive(std::uint8_t byte, std::uint32_t now) noexcept;
    // Bytes were lost on their way to receive().
    void bytes_lost() noexcept { received_.put(kLossMark); }
    // A reset byte: what came before it is discarded, what comes after it is not.
    void discard() noexcept;
    // A reset has begun: answers that bytes lost earlier still wait for are none.
    void forget_lost_lines() noexcept { lost_answers_ = 0; }

    enum class Progress : std::uint8_t { kNothing, kWorked, kLine };
    // Reads on, a limited number of bytes. kLine: `text` is to be executed and answered; it holds
    // until next().
    Progress read(std::string_view& text) noexcept;
    // "ok", or "error:", with number and checksum where the lines are checked.
    void answer(std::optional<Error> error) noexcept;
    // Ends a status report that begins at `start` of the replies: with a checksum where lines are checked.
    void end_report(std::uint32_t start) noexcept;
    // The line that was read is over.
    void next() noexcept { line_.begin_line(); }

    // A jog cancel: lines that began before it are cancelled. `in_jog`: it stopped one.
    void cancel(bool in_jog) noexcept;
    void forget_cancel() noexcept { cancelling_ = false; }
    // True if a jog cancel came after the first byte of this line.
    bool cancelled() const noexcept
    {
        return cancelling_ && static_cast<std::int32_t>(cancelled_to_ - line_start_) > 0;
    }
    bool cancelled_in_jog() const noexcept { return cancelled() && cancelled_in_jog_; }

    // Lines with numbers and checksums; `checked` may be asked in the servo tick.
    bool checked() const noexcept { return checked_.on(); }
    void switch_checked(bool on) noexcept { on ? checked_.switch_on() : checked_.switch_off(); }
    // In a long silence at rest checked lines lapse, so that a stock sender finds a stock controller.
    void lapse() noexcept;
    // True if no text has come for so long that they may.
    bool may_lapse(std::uint32_t now) const noexcept;
    // Servo ticks without any byte.
    std::uint32_t silence(std::uint32_t now) const noexcept { return now - last_byte_tick_; }

    // All that was received is read, and what was lost of it is answered; a line may have begun.
    bool all_read() const noexcept { return received_.empty() && lost_answers_ == 0; }
    bool empty() const noexcept { return received_.empty(); }
    std::uint32_t room() const noexcept { return received_.room(); }
    // The number of the line that was read, where lines are checked; otherwise 0.
    std::uint32_t line_number() const noexcept { return line_number_; }

private:
    // Among the text, which has no such byte: here some were lost.
    static constexpr std::uint8_t kLossMark = 0x80;

    void report_lost_bytes() noexcept;
    bool accept(std::string_view& text) noexcept;
    void refuse() noexcept;
    void append_checksum(std::uint32_t start) noexcept;

    protocol::ReplyQueue& replies_;
    protocol::ReceiveQueue received_;
    protocol::LineAssembler line_;
    protocol::CheckedLines checked_;
    std::uint32_t line_number_{0};
    std::uint32_t line_start_{0};    // place in the stream where the line began
    std::uint32_t cancelled_to_{0};  // lines that began before this place are cancelled
    std::uint32_t lost_answers_{0};
    std::uint32_t last_byte_tick_{0};
    std::uint32_t last_text_tick_{0};
    bool cancelling_{false};
    bool cancelled_in_jog_{false};
};

}  // namespace cusp::machine
