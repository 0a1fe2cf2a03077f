// Bits of the registers by their names in the data sheet.
#include "firmware/drives/tmc2209.hpp"

namespace cusp::drives {
namespace {

constexpr std::uint8_t kSync = 0x05;
constexpr std::uint8_t kToMaster = 0xFF;
constexpr unsigned kWriteBit = 0x80;
constexpr unsigned kBitsOfByte = 8;

constexpr unsigned kMostScale = 32;  // CS + 1
// Section 9: the full scale of the sense voltage, uV, by VSENSE; the chip's own resistance, mOhm.
constexpr float kCoarseScale = 325000.0F;
constexpr float kFineScale = 180000.0F;
constexpr float kOwnMilliohms = 20.0F;
constexpr float kRootOfTwo = 1.41421356F;

// CS + 1 of this current; unbounded.
float scale_of(float milliamperes, float sense_milliohms, float full_scale) noexcept
{
    return static_cast<float>(kMostScale) * kRootOfTwo * milliamperes *
           (sense_milliohms + kOwnMilliohms) / full_scale;
}

// CS, 0 to 31.
std::uint32_t scale_bits(float scale) noexcept
{
    if (scale < 1.0F) {
        return 0;
    }
    return scale >= static_cast<float>(kMostScale) ? kMostScale - 1
                                                   : static_cast<std::uint32_t>(scale) - 1;
}

std::uint32_t resolution_bits(std::uint32_t microsteps) noexcept
{
    std::uint32_t bits = 8;  // a full step
    for (; bits > 0 && microsteps > 1; microsteps /= 2) {
        --bits;
    }
    return bits;
}

// Section 5.5: clocks between 1/256 microsteps at this speed, 20 bits.
std::uint32_t stealth_limit(const MotorSetup& setup) noexcept
{
    constexpr float kClocksPerMinute = 12e6F * 60.0F;
    constexpr float kFinest = 256.0F;
    constexpr std::uint32_t kMost = (1U << 20U) - 1;
    if (setup.stealth_speed <= 0.0F) {
        return 0;
    }
    const float fine_steps =
        setup.stealth_speed * setup.steps_per_mm * kFinest / static_cast<float>(setup.microsteps);
    const float clocks = kClocksPerMinute / fine_steps;
    return clocks >= static_cast<float>(kMost) ? kMost
           : clocks < 1.0F                     ? 1
                                               : static_cast<std::uint32_t>(clocks);
}

void put(std::uint32_t byte, Datagram& datagram) noexcept
{
    static_cast<void>(datagram.try_push_back(static_cast<std::uint8_t>(byte)));
}

// To the drive of address 0.
Datagram begin_request(unsigned place) noexcept
{
    Datagram request;
    put(kSync, request);
    put(0, request);
    put(place, request);
    return request;
}

}  // namespace

std::uint8_t crc8(Span<const std::uint8_t> bytes) noexcept
{
    constexpr unsigned kPolynomial = 0x07;
    unsigned crc = 0;
    for (unsigned byte : bytes) {
        for (unsigned bit = 0; bit < kBitsOfByte; ++bit) {
            const bool differs = ((crc >> 7U ^ byte) & 1U) != 0;
            crc = (crc << 1U & 0xFFU) ^ (differs ? kPolynomial : 0U);
            byte >>= 1U;
        }
    }
    return static_cast<std::uint8_t>(crc);
}

Datagram read_request(Register from) noexcept
{
    Datagram request = begin_request(static_cast<unsigned>(from));
    put(crc8(request.span()), request);
    return request;
}

Datagram write_request(Register to, std::uint32_t value) noexcept
{
    constexpr unsigned kValueBits = 32;
    Datagram request = begin_request(static_cast<unsigned>(to) | kWriteBit);
    for (unsigned place = kValueBits; place > 0; place -= kBitsOfByte) {
        put(value >> (place - kBitsOfByte) & 0xFFU, request);
    }
    put(crc8(request.span()), request);
    return request;
}

std::optional<std::uint32_t> parse_reply(Span<const std::uint8_t> bytes, Register from) noexcept
{
    constexpr std::size_t kData = 3;
    constexpr std::size_t kCrc = kReplySize - 1;
    const bool sound = bytes.size() == kReplySize && (bytes[0] & 0x0FU) == kSync &&
                       bytes[1] == kToMaster && bytes[2] == static_cast<std::uint8_t>(from) &&
                       bytes[kCrc] == crc8(bytes.first(kCrc));
    if (!sound) {
        return std::nullopt;
    }
    std::uint32_t value = 0;
    for (std::size_t i = kData; i < kCrc; ++i) {
        value = value << kBitsOfByte | bytes[i];
    }
    return value;
}

DriveRegisters registers_for(const MotorSetup& setup) noexcept
{
    constexpr std::uint32_t kSpreadCycle = 1U << 2U;
    constexpr std::uint32_t kWireAlone = 1U << 6U;  // pdn_disable
    constexpr std::uint32_t kMicrostepsByRegister = 1U << 7U;
    constexpr std::uint32_t kStepFilter = 1U << 8U;
    // Interpolation to 256 microsteps; blank time 36 clocks, hysteresis 5 and 0, off time 3.
    constexpr std::uint32_t kChopper = 1U << 28U | 2U << 15U | 5U << 4U | 3U;
    constexpr std::uint32_t kFineSense = 1U << 17U;
    constexpr unsigned kResolutionPlace = 24;
    constexpr std::uint32_t kHoldSteps = 8U << 16U;  // IHOLDDELAY: from run to hold, each 22 ms
    constexpr std::uint32_t kHoldDelay = 20;         // 0.44 s after the last step
    constexpr float kPercent = 100.0F;

    const float fine = scale_of(setup.milliamperes, setup.sense_milliohms, kFineScale);
    const bool is_fine = fine <= static_cast<float>(kMostScale);
    const float scale =
        is_fine ? fine : scale_of(setup.milliamperes, setup.sense_milliohms, kCoarseScale);
    const std::uint32_t run = scale_bits(scale);
    const std::uint32_t hold =
        scale_bits(static_cast<float>(run + 1) * setup.hold_percent / kPercent);

    DriveRegisters registers;
    registers.stealth_limit = stealth_limit(setup);
    registers.global_settings = kWireAlone | kMicrostepsByRegister | kStepFilter |
                                (registers.stealth_limit == 0 ? kSpreadCycle : 0U);
    registers.chopper = kChopper | (is_fine ? kFineSense : 0U) |
                        resolution_bits(setup.microsteps) << kResolutionPlace;
    registers.currents = kHoldSteps | run << 8U | hold;
    registers.hold_delay = kHoldDelay;
    return registers;
}

}  // namespace cusp::drives
