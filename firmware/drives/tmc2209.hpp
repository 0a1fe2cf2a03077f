// The TMC2209's registers and datagrams: what a drive shall do, as words, and the words as bytes of its
// single wire (data sheet revision 1.09, sections 4 and 5).
#pragma once

#include <cstdint>
#include <optional>

#include "firmware/base/span.hpp"
#include "firmware/base/static_vector.hpp"

namespace cusp::drives {

enum class Register : std::uint8_t {
    kGlobalSettings = 0x00,  // GCONF
    kGlobalStatus = 0x01,    // GSTAT
    kWriteCount = 0x02,      // IFCNT: accepted writes, modulo 256
    kInputs = 0x06,          // IOIN: pins, and the version of the chip
    kCurrents = 0x10,        // IHOLD_IRUN; can't be read
    kHoldDelay = 0x11,       // TPOWERDOWN; can't be read
    kStealthLimit = 0x13,    // TPWMTHRS; can't be read
    kChopper = 0x6C,         // CHOPCONF
    kStatus = 0x6F,          // DRV_STATUS
};

// A request, or what answers it.
inline constexpr std::size_t kReplySize = 8;
using Datagram = StaticVector<std::uint8_t, kReplySize>;

// Section 4.2: polynomial x^8 + x^2 + x + 1, the lowest bit of each byte first.
std::uint8_t crc8(Span<const std::uint8_t> bytes) noexcept;

// To the drive of address 0.
Datagram read_request(Register from) noexcept;
Datagram write_request(Register to, std::uint32_t value) noexcept;
// The value in an answer to read_request(from). Nothing where it is none, or its checksum is wrong.
std::optional<std::uint32_t> parse_reply(Span<const std::uint8_t> bytes, Register from) noexcept;

// The needs of a motor.
struct MotorSetup {
    float milliamperes{0};  // root mean square, in motion; more than the drive gives is its most
    float hold_percent{0};  // of it, at rest
    std::uint32_t microsteps{1};  // a full step; 1 to 256, a power of two
    float stealth_speed{0};       // mm/min up to which stealthChop drives it; 0: spreadCycle always
    float steps_per_mm{1};
    float sense_milliohms{110};
};

// The registers that make a drive do so.
struct DriveRegisters {
    std::uint32_t global_settings{0};
    std::uint32_t chopper{0};
    std::uint32_t currents{0};
    std::uint32_t hold_delay{0};
    std::uint32_t stealth_limit{0};

    friend bool operator==(const DriveRegisters& a, const DriveRegisters& b) noexcept
    {
        return a.global_settings == b.global_settings && a.chopper == b.chopper &&
               a.currents == b.currents && a.hold_delay == b.hold_delay &&
               a.stealth_limit == b.stealth_limit;
    }
};
// The current is that of the next lower of 32 steps, never more than asked for but for the least step.
DriveRegisters registers_for(const MotorSetup& setup) noexcept;

}  // namespace cusp::drives
