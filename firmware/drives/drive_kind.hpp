// Kinds of drives share: registers, the needs of a motor, and the steps of setting and watching
// one. A kind is a table of these steps, its datagrams, and the registers that a motor needs.
#pragma once

#include <cstdint>

#include "firmware/base/span.hpp"
#include "firmware/base/static_vector.hpp"

namespace cusp::drives {

enum class DriveKind : std::uint8_t {
    kTmc2209,  // over a wire of its own
    kTmc5160,  // over SPI, which all of them share
};

// Places of registers; alike in both kinds but for those that one alone has.
enum class Register : std::uint8_t {
    kGlobalSettings = 0x00,  // GCONF
    kGlobalStatus = 0x01,    // GSTAT
    kWriteCount = 0x02,      // IFCNT: accepted writes, modulo 256
    kBusInputs = 0x04,       // IOIN of a TMC5160: pins, and the version of the chip
    kInputs = 0x06,          // IOIN of a TMC2209
    kScaler = 0x0B,          // GLOBALSCALER of a TMC5160; can't be read
    kCurrents = 0x10,        // IHOLD_IRUN; can't be read
    kHoldDelay = 0x11,       // TPOWERDOWN; can't be read
    kStealthLimit = 0x13,    // TPWMTHRS; can't be read
    kChopper = 0x6C,         // CHOPCONF
    kStatus = 0x6F,          // DRV_STATUS
};

// A request, or what answers it.
inline constexpr std::size_t kMostBytes = 8;
inline constexpr unsigned kBitsOfByte = 8;
using Datagram = StaticVector<std::uint8_t, kMostBytes>;

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
    DriveKind kind{DriveKind::kTmc2209};
    std::uint32_t global_settings{0};
    std::uint32_t chopper{0};
    std::uint32_t scaler{0};
    std::uint32_t currents{0};
    std::uint32_t hold_delay{0};
    std::uint32_t stealth_limit{0};

    friend bool operator==(const DriveRegisters& a, const DriveRegisters& b) noexcept
    {
        return a.kind == b.kind && a.global_settings == b.global_settings &&
               a.chopper == b.chopper && a.scaler == b.scaler && a.currents == b.currents &&
               a.hold_delay == b.hold_delay && a.stealth_limit == b.stealth_limit;
    }
};

enum class Action : std::uint8_t {
    kWrite,
    kReadVersion,
    kCountBefore,  // of accepted writes
    kCountAfter,
    kCompare,       // with what was written
    kReadStatus,    // that it is neither hot nor has a short
    kReadRestarts,  // that its supply was there all the time
};
struct Step {
    Register place;
    Action action;
};

struct Recipe {
    Span<const Step> setting;
    Span<const Step> watching;
    std::uint32_t version;
    std::uint32_t hot;  // bits of DRV_STATUS: switched off for its temperature,
    std::uint32_t shorts;
    std::uint32_t undervoltage;  // of GSTAT, as far as it stays there
    bool has_checksum;    // of its answers; without one a bad word counts when it comes again
    bool mirrors_writes;  // what it took in is its answer
};

// Fields that both kinds have.

// CS of a current that is this many steps of 32, unbounded: 0 to 31.
std::uint32_t scale_bits(float scale) noexcept;
// MRES.
std::uint32_t resolution_bits(std::uint32_t microsteps) noexcept;
// IHOLD_IRUN of this CS in motion, and of hold_percent of it at rest.
std::uint32_t current_bits(std::uint32_t run, float hold_percent) noexcept;
// TPWMTHRS: clocks between 1/256 microsteps at that speed, 20 bits; 0 for none.
std::uint32_t stealth_limit(const MotorSetup& setup) noexcept;
inline constexpr std::uint32_t kHoldDelay = 20;  // TPOWERDOWN: 0.44 s after the last step
inline constexpr float kRootOfTwo = 1.41421356F;
inline constexpr float kMostScale = 32;  // CS + 1

// These append to a datagram: a byte, and a word with its highest byte first.
void put(std::uint32_t byte, Datagram& datagram) noexcept;
void put_word(std::uint32_t word, Datagram& datagram) noexcept;
// Precondition: four bytes from there on.
std::uint32_t word_at(Span<const std::uint8_t> bytes, std::size_t place) noexcept;

}  // namespace cusp::drives
