// CheckedWindow: sends lines with numbers and CRCs to a controller that refuses damaged, repeated
// and lost ones. Each is executed once, in order, on any serial line.
//
// The protocol is described in docs/protocol.md, "Checked lines". Answers count only with a correct
// CRC; an answer to line k means that all lines before it are done too. After a refusal the sender
// waits for all due answers, then continues with the expected line. After silence or a damaged
// answer it sends an empty line, whose answer names the expected line. On a bad serial line fewer
// lines are in flight.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace cusp::stream {

// A line as sent, without line end.
std::string checked_line(std::uint32_t number, std::string_view text);

// The text of an answer with a correct CRC: in "ok N5*..." the text before '*'. None if the CRC is
// missing or wrong.
std::optional<std::string> checked_answer(std::string_view line);

// The number requested by a refusal, "resend N5*...". None if it is no refusal or is damaged.
std::optional<std::uint32_t> refused_number(std::string_view line);

class CheckedWindow {
public:
    using Clock = std::chrono::steady_clock;

    // capacity  of the controller's buffer, bytes; half of it is used, since a line may be in
    //           flight twice
    explicit CheckedWindow(std::size_t capacity) : capacity_{capacity / 2}, room_{capacity_} {}

    void set_capacity(std::size_t capacity) { capacity_ = room_ = capacity / 2; }

    // True if another line of the program may be added.
    bool has_room() const { return lines_.size() < kMostLines; }
    void add(std::uint64_t program_line, std::string_view text);

    // The next line to send, with line end; none if there is none, no room for it, or answers have
    // to be awaited first.
    std::optional<std::string> next(Clock::time_point now);

    // Result of an answer.
    struct Verdict {
        std::uint64_t done_lines{0};
        std::uint64_t program_line{0};  // of the last line that is done; 0: none
        int error{0};                   // of that line; 0: ok
    };
    // Processes a line from the controller. None if it is no answer, or a damaged one.
    std::optional<Verdict> take(std::string_view line, Clock::time_point now);

    // Unchecked answers arrive although only checked ones are due: the controller no longer checks
    // lines.
    bool lapsed() const { return plain_answers_ >= kMostPlain; }

    bool empty() const { return lines_.empty(); }
    std::uint64_t resent() const { return resent_; }
    // The program's line of a checked number; 0 if it is no longer stored.
    std::uint64_t program_line_of(std::uint32_t number) const;

private:
    static constexpr std::size_t kMostLines = 256;
    static constexpr std::size_t kMostRemembered = 4096;
    // Damage rarely turns a checked answer into a plain one, and never so many in a row.
    static constexpr unsigned kMostPlain = 4;
    static constexpr std::chrono::milliseconds kFirstPatience{100};

    struct Line {
        std::uint32_t number;
        std::uint64_t program_line;
        std::string wire;
    };
    Verdict finish_before(std::uint32_t number);
    void rewind(Clock::time_point now);
    bool wants_to_ask(Clock::time_point now) const;
    void count_damaged(std::string_view line);

    std::size_t capacity_;
    std::size_t room_;           // bytes of it in use: fewer on a bad line
    std::size_t under_way_{0};   // line ends without an answer so far
    unsigned plain_answers_{0};  // in a row
    std::deque<Line> lines_;     // not known to be executed
    std::size_t sent_{0};        // of lines_, on the wire
    std::size_t sent_bytes_{0};
    std::uint32_t next_number_{1};
    std::deque<std::uint64_t> program_lines_;  // of the last numbers done
    std::uint32_t done_{0};                    // number of the last line done
    bool draining_{false};
    Clock::time_point quiet_since_{};
    std::chrono::milliseconds patience_{kFirstPatience};
    std::uint64_t resent_{0};
};

}  // namespace cusp::stream
