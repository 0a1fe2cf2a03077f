// Bytes to lines, errors to answers.
#include "firmware/machine/line_dialogue.hpp"

#include "firmware/protocol/crc32.hpp"
#include "firmware/protocol/realtime_command.hpp"

namespace cusp::machine {
namespace {

// Bytes of a slice: more would keep realtime commands waiting.
constexpr unsigned kBytesPerSlice = 64;
// Ticks without text after which checked lines may lapse.
constexpr std::uint32_t kCheckedLinesLapse = 3000;

}  // namespace

bool LineDialogue::receive(std::uint8_t byte, std::uint32_t now) noexcept
{
    last_byte_tick_ = now;
    switch (protocol::byte_kind(byte)) {
        case protocol::ByteKind::kDropped:
            return false;
        case protocol::ByteKind::kText:
            last_text_tick_ = now;
            checked_.text();
            received_.put(byte);
            return false;
        case protocol::ByteKind::kRealtime:
            break;
    }
    return checked_.accept_realtime(byte);
}

void LineDialogue::discard() noexcept
{
    received_.clear();
    line_.begin_line();
    checked_.switch_off();
}

LineDialogue::Progress LineDialogue::read(std::string_view& text) noexcept
{
    if (lost_answers_ > 0 || received_.lost()) {
        report_lost_bytes();
        return Progress::kWorked;
    }
    unsigned taken = 0;
    std::uint8_t byte = 0;
    while (taken < kBytesPerSlice && received_.take(byte)) {
        ++taken;
        if (byte == kLossMark) {
            (void)replies_.text("[MSG:Serial overrun: bytes lost]").end_line();
            line_.mark_overflow();
            return Progress::kWorked;
        }
        if (!line_.started()) {
            line_start_ = received_.taken() - 1;
        }
        if (line_.add(byte)) {
            return accept(text) ? Progress::kLine : Progress::kWorked;
        }
    }
    return taken > 0 ? Progress::kWorked : Progress::kNothing;
}

// Bytes that found no room: their lines are answered with error 11, one a slice.
void LineDialogue::report_lost_bytes() noexcept
{
    if (lost_answers_ > 0) {
        --lost_answers_;
        answer(Error::kOverflow);
        return;
    }
    (void)replies_.text("[MSG:Receive buffer overflow: bytes lost]").end_line();
    const bool ended = received_.loss_ended_a_line();
    lost_answers_ = received_.take_lost_line_ends();
    line_.begin_line();
    if (!ended) {
        line_.mark_overflow();
    }
}

// True if the line that is complete is to be executed.
bool LineDialogue::accept(std::string_view& text) noexcept
{
    line_number_ = 0;
    cancelling_ = cancelled();
    if (!checked_.on()) {
        text = line_.line();
        if (line_.overflow()) {
            answer(Error::kOverflow);
            next();
            return false;
        }
        return true;
    }
    const std::uint32_t number = checked_.expected();
    if (const std::optional<std::string_view> checked = checked_.accept(line_)) {
        line_number_ = number;
        text = *checked;
        return true;
    }
    if (number == 1 && line_.line() == "$CRC=1") {
        answer(std::nullopt);
        next();
        return false;
    }
    refuse();
    return false;
}

void LineDialogue::answer(std::optional<Error> error) noexcept
{
    const std::uint32_t start = replies_.place();
    if (error) {
        (void)replies_.text("error:").number(static_cast<std::uint32_t>(*error));
    } else {
        (void)replies_.text("ok");
    }
    if (checked_.on() && line_number_ > 0) {
        (void)replies_.text(" N").number(line_number_);
        append_checksum(start);
    }
    (void)replies_.end_line();
}

void LineDialogue::end_report(std::uint32_t start) noexcept
{
    if (checked_.on()) {
        append_checksum(start);
    }
    (void)replies_.end_line();
}

void LineDialogue::refuse() noexcept
{
    const std::uint32_t start = replies_.place();
    (void)replies_.text("resend N").number(checked_.expected());
    append_checksum(start);
    (void)replies_.end_line();
    next();
}

// The checksum covers the reply from `start` on.
void LineDialogue::append_checksum(std::uint32_t start) noexcept
{
    protocol::Crc32 crc;
    for (std::uint32_t place = start; place != replies_.place(); ++place) {
        crc.add(replies_.byte_at(place));
    }
    (void)replies_.character('*').hexadecimal(crc.value());
}

void LineDialogue::cancel(bool in_jog) noexcept
{
    cancelling_ = true;
    cancelled_to_ = received_.received();
    cancelled_in_jog_ = in_jog;
}

void LineDialogue::lapse() noexcept
{
    checked_.switch_off();
    line_.begin_line();
}

// Status queries are no lines: senders send them all the time.
bool LineDialogue::may_lapse(std::uint32_t now) const noexcept
{
    return checked_.on() && now - last_text_tick_ > kCheckedLinesLapse;
}

}  // namespace cusp::machine
