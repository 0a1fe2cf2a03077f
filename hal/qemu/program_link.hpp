// ProgramLink: a byte link whose far end sends a program from a file: each line after the answer to
// the one before, realtime bytes at their servo ticks.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "hal/contract/board.hpp"
#include "hal/qemu/semihosting.hpp"

namespace cusp::hal::qemu {

// A script is a text of lines `tick byte`, both decimal, ticks not falling: the byte is read by the
// firmware before the servo tick of that number, counted from 0.
class ProgramLink {
public:
    // `script`  may be empty: no script
    void open(const char* program, const char* script) noexcept
    {
        program_.open(program);
        console_ = HostFile{":tt", FileMode::kWrite};
        if (script[0] != '\0') {
            script_.open(script);
            read_script_line();
        }
    }
    bool is_open() const noexcept { return program_.is_open(); }

    // See hal/contract/board.hpp.
    bool try_read(std::uint8_t& byte) noexcept;
    std::uint32_t write_room() const noexcept { return 1024; }
    void write(Span<const std::uint8_t> bytes) noexcept;

    // Call before each servo tick.
    void set_tick(std::uint64_t tick) noexcept
    {
        tick_ = tick;
        may_begin_line_ = true;
    }

    // Every line is sent and answered.
    bool finished() const noexcept { return ended_ && unanswered_ == 0; }
    // A line was answered by an error, an alarm was raised or the controller was reset: the run is
    // over.
    bool refused() const noexcept { return refused_; }
    // True if bytes of the script are still to be sent.
    bool script_waits() const noexcept { return script_waits_; }
    // Sends a byte ahead of the program; no line is begun until the next tick.
    void send(char byte) noexcept
    {
        own_ = static_cast<std::uint8_t>(byte);
        may_begin_line_ = false;
    }

private:
    // A file read through a buffer, a byte at a time.
    class Reader {
    public:
        void open(const char* name) noexcept { file_ = HostFile{name, FileMode::kRead}; }
        bool is_open() const noexcept { return file_.is_open(); }
        bool next(std::uint8_t& byte) noexcept
        {
            if (at_ == size_) {
                at_ = 0;
                size_ = is_open() ? file_.read(Span<std::uint8_t>{buffer_}) : 0;
                if (size_ == 0) {
                    return false;
                }
            }
            byte = buffer_[at_];
            ++at_;
            return true;
        }

    private:
        HostFile file_;
        std::array<std::uint8_t, 512> buffer_{};
        std::uint32_t at_{0};
        std::uint32_t size_{0};
    };

    void read_script_line() noexcept;
    bool next_of_program(std::uint8_t& byte) noexcept;
    bool try_read_program(std::uint8_t& byte) noexcept;
    void take_answer() noexcept;

    Reader program_;
    Reader script_;
    std::uint64_t tick_{0};
    bool script_waits_{false};
    std::uint64_t script_tick_{0};
    std::uint8_t script_byte_{0};
    std::uint8_t own_{0};
    bool may_begin_line_{true};
    bool amid_line_{false};
    bool after_return_{false};
    bool ended_{false};
    std::uint32_t unanswered_{0};
    bool refused_{false};
    std::array<char, 96> answer_{};
    std::uint32_t answer_size_{0};
    HostFile console_;
};

inline void ProgramLink::read_script_line() noexcept
{
    std::array<std::uint64_t, 2> numbers{};
    unsigned index = 0;
    bool digits = false;
    std::uint8_t byte = 0;
    script_waits_ = false;
    while (script_.next(byte)) {
        if (byte >= '0' && byte <= '9') {
            numbers[index] = numbers[index] * 10 + (byte - std::uint64_t{'0'});
            digits = true;
        } else if (digits && byte == ' ') {
            index = 1;
        } else if (digits && byte == '\n') {
            break;
        }
    }
    script_waits_ = digits && index == 1;
    script_tick_ = numbers[0];
    script_byte_ = static_cast<std::uint8_t>(numbers[1]);
}

inline bool ProgramLink::try_read(std::uint8_t& byte) noexcept
{
    if (script_waits_ && script_tick_ <= tick_) {
        byte = script_byte_;
        read_script_line();
        return true;
    }
    if (own_ != 0) {
        byte = own_;
        own_ = 0;
        return true;
    }
    return try_read_program(byte);
}

// Any of LF, CR LF and CR ends a line, as for `cusp stream`; the controller, as Grbl does, would
// answer CR LF twice.
inline bool ProgramLink::next_of_program(std::uint8_t& byte) noexcept
{
    bool found = program_.next(byte);
    if (found && after_return_ && byte == '\n') {
        found = program_.next(byte);
    }
    after_return_ = found && byte == '\r';
    if (after_return_) {
        byte = '\n';
    }
    return found;
}

inline bool ProgramLink::try_read_program(std::uint8_t& byte) noexcept
{
    if (ended_ || refused_ || (!amid_line_ && (unanswered_ > 0 || !may_begin_line_))) {
        return false;
    }
    if (!next_of_program(byte)) {
        // A last line without its end gets one.
        ended_ = true;
        if (amid_line_) {
            amid_line_ = false;
            byte = '\n';
            return true;
        }
        return false;
    }
    if (!amid_line_) {
        ++unanswered_;
    }
    amid_line_ = byte != '\n';
    return true;
}

inline void ProgramLink::write(Span<const std::uint8_t> bytes) noexcept
{
    for (const std::uint8_t byte : bytes) {
        if (byte == '\n') {
            take_answer();
            answer_size_ = 0;
        } else if (byte != '\r' && answer_size_ < answer_.size()) {
            answer_[answer_size_] = static_cast<char>(byte);
            ++answer_size_;
        }
    }
    console_.write(bytes);
}

inline void ProgramLink::take_answer() noexcept
{
    const std::string_view answer{answer_.data(), answer_size_};
    const bool error = answer.substr(0, 6) == "error:";
    if ((answer == "ok" || error) && unanswered_ > 0) {
        --unanswered_;
    }
    // A banner amid the program: the controller was reset and has lost its lines.
    const bool reset = tick_ > 0 && answer.substr(0, 5) == "Grbl ";
    refused_ = refused_ || error || reset || answer.substr(0, 6) == "ALARM:";
    // Lines after M2 or M30 are not sent.
    ended_ = ended_ || answer == "[MSG:Pgm End]";
}

}  // namespace cusp::hal::qemu
