// InstructionMeter: counts the instructions of a piece of code under QEMU, exactly.
#pragma once

#include <cstdint>
#include <string_view>

#include "hal/qemu/semihosting.hpp"
#include "hal/stm32f4/chip.hpp"

namespace cusp::test {

// QEMU runs with -icount shift=3: an instruction lasts 8 ns, and its timer 5 counts nanoseconds.
class InstructionMeter {
public:
    explicit InstructionMeter(std::string_view name) noexcept : name_{name} {}

    static void start_clock() noexcept { hal::stm32f4::Chip::timer5().cr1.write(1); }

    void begin() noexcept { began_ = now(); }
    void end() noexcept
    {
        const std::uint32_t ended = now();
        add((ended - began_) / kNanosecondsPerInstruction);
    }
    void add(std::uint32_t instructions) noexcept
    {
        const std::uint32_t own = overhead();
        const std::uint32_t count = instructions > own ? instructions - own : 0;
        sum_ += count;
        ++runs_;
        most_ = count > most_ ? count : most_;
    }

    // One line: name, mean, most, runs.
    void report(const hal::qemu::HostFile& file) const noexcept
    {
        write(file, name_);
        write_number(file, runs_ == 0 ? 0 : static_cast<std::uint32_t>(sum_ / runs_));
        write_number(file, most_);
        write_number(file, runs_);
        write(file, "\n");
    }

private:
    static constexpr std::uint32_t kNanosecondsPerInstruction = 8;

    static std::uint32_t now() noexcept { return hal::stm32f4::Chip::timer5().cnt.read(); }
    // Instructions that begin() and end() count of themselves.
    static std::uint32_t overhead() noexcept
    {
        static std::uint32_t own = 0;
        if (own == 0) {
            InstructionMeter empty{""};
            empty.began_ = now();
            own = (now() - empty.began_) / kNanosecondsPerInstruction;
        }
        return own;
    }
    static void write(const hal::qemu::HostFile& file, std::string_view text) noexcept
    {
        file.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    }
    static void write_number(const hal::qemu::HostFile& file, std::uint32_t value) noexcept
    {
        char digits[11]{};
        unsigned at = sizeof digits;
        do {
            --at;
            digits[at] = static_cast<char>('0' + value % 10);
            value /= 10;
        } while (value != 0);
        write(file, " ");
        write(file, {digits + at, sizeof digits - at});
    }

    std::string_view name_;
    std::uint32_t began_{0};
    std::uint64_t sum_{0};
    std::uint32_t most_{0};
    std::uint32_t runs_{0};
};

}  // namespace cusp::test
