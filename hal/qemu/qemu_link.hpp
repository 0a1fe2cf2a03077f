// QemuLink: the serial line, or a program from a file in its place.
#pragma once

#include <cstdint>

#include "hal/qemu/program_link.hpp"
#include "hal/qemu/usart_link.hpp"

namespace cusp::hal::qemu {

template <class Chip>
class QemuLink {
public:
    using Line = UsartLink<Chip>;

    Line& line() noexcept { return line_; }
    ProgramLink& program() noexcept { return program_; }

    // See hal/contract/board.hpp.
    bool try_read(std::uint8_t& byte) noexcept
    {
        return program_.is_open() ? program_.try_read(byte) : line_.try_read(byte);
    }
    // A program's bytes come when they are read.
    bool try_scan(std::uint8_t& byte) noexcept
    {
        return !program_.is_open() && line_.try_scan(byte);
    }
    bool overrun() noexcept { return program_.is_open() ? false : line_.overrun(); }
    std::uint32_t write_room() const noexcept
    {
        return program_.is_open() ? program_.write_room() : line_.write_room();
    }
    void write(Span<const std::uint8_t> bytes) noexcept
    {
        if (program_.is_open()) {
            program_.write(bytes);
        } else {
            line_.write(bytes);
        }
    }
    void on_interrupt() noexcept { line_.on_interrupt(); }

private:
    Line line_;
    ProgramLink program_;
};

}  // namespace cusp::hal::qemu
