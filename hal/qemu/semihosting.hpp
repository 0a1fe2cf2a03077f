// Services of the host for a program under QEMU: files, arguments, exit (Arm semihosting
// 3.0).
#pragma once

#include <array>
#include <cstdint>

#include "firmware/base/span.hpp"

namespace cusp::hal::qemu {

enum class SemihostingCall : std::uint32_t {
    kOpen = 0x01,
    kWrite = 0x05,
    kRead = 0x06,
    kCommandLine = 0x15,
    kExit = 0x20,
};

inline std::int32_t semihosting(SemihostingCall call, const void* block) noexcept
{
    std::int32_t result = 0;
    __asm volatile("mov r0, %1\n mov r1, %2\n bkpt 0xAB\n mov %0, r0"
                   : "=r"(result)
                   : "r"(call), "r"(block)
                   : "r0", "r1", "memory");
    return result;
}

enum class FileMode : std::uint32_t { kRead = 1, kWrite = 5 };  // "rb", "wb"

// A file of the host; -1 where it can't be opened.
class HostFile {
public:
    HostFile() = default;
    HostFile(const char* name, FileMode mode) noexcept
    {
        std::uint32_t length = 0;
        while (name[length] != '\0') {
            ++length;
        }
        const std::array<std::uintptr_t, 3> block{reinterpret_cast<std::uintptr_t>(name),
                                                  static_cast<std::uintptr_t>(mode), length};
        number_ = semihosting(SemihostingCall::kOpen, block.data());
    }
    bool is_open() const noexcept { return number_ >= 0; }

    // Bytes read: less than the room only at the end of the file.
    std::uint32_t read(Span<std::uint8_t> bytes) const noexcept
    {
        const std::array<std::uintptr_t, 3> block{static_cast<std::uintptr_t>(number_),
                                                  reinterpret_cast<std::uintptr_t>(bytes.data()),
                                                  bytes.size()};
        const auto missing =
            static_cast<std::uint32_t>(semihosting(SemihostingCall::kRead, block.data()));
        return static_cast<std::uint32_t>(bytes.size()) - missing;
    }
    void write(Span<const std::uint8_t> bytes) const noexcept
    {
        const std::array<std::uintptr_t, 3> block{static_cast<std::uintptr_t>(number_),
                                                  reinterpret_cast<std::uintptr_t>(bytes.data()),
                                                  bytes.size()};
        semihosting(SemihostingCall::kWrite, block.data());
    }

private:
    std::int32_t number_{-1};
};

// The terminal, with the members of a byte link that a report needs.
struct Console {
    static std::uint32_t write_room() noexcept { return 1; }
    void write(Span<const std::uint8_t> bytes) const noexcept { file.write(bytes); }
    HostFile file{":tt", FileMode::kWrite};
};

// The arguments of -semihosting-config arg=..., one space between them; empty where there are none.
template <std::size_t N>
void read_command_line(std::array<char, N>& text) noexcept
{
    text[0] = '\0';
    const std::array<std::uintptr_t, 2> block{reinterpret_cast<std::uintptr_t>(text.data()), N};
    semihosting(SemihostingCall::kCommandLine, block.data());
    text[N - 1] = '\0';
}

// Ends QEMU with this exit status.
[[noreturn]] inline void exit_qemu(std::uint32_t status) noexcept
{
    constexpr std::uint32_t kApplicationExit = 0x20026;
    const std::array<std::uint32_t, 2> block{kApplicationExit, status};
    semihosting(SemihostingCall::kExit, block.data());
    for (;;) {
    }
}

}  // namespace cusp::hal::qemu
