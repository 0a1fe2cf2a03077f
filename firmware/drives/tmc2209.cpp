// Bits of the registers by their names in the data sheet.
#include "firmware/drives/tmc2209.hpp"

namespace cusp::drives::tmc2209 {
namespace {

constexpr std::uint8_t kSync = 0x05;
constexpr std::uint8_t kToMaster = 0xFF;
constexpr unsigned kWriteBit = 0x80;

// Section 9: the full scale of the sense voltage, uV, by VSENSE; the chip's own resistance, mOhm.
constexpr float kCoarseScale = 325000.0F;
constexpr float kFineScale = 180000.0F;
constexpr float kOwnMilliohms = 20.0F;

// CS + 1 of this current; unbounded.
float scale_of(float milliamperes, float sense_milliohms, float full_scale) noexcept
{
    return kMostScale * kRootOfTwo * milliamperes * (sense_milliohms + kOwnMilliohms) / full_scale;
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
    Datagram request = begin_request(static_cast<unsigned>(to) | kWriteBit);
    put_word(value, request);
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
    return word_at(bytes, kData);
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

    const float milliamperes =
        setup.milliamperes < kMostMilliamperes ? setup.milliamperes : kMostMilliamperes;
    const float fine = scale_of(milliamperes, setup.sense_milliohms, kFineScale);
    const bool is_fine = fine <= kMostScale;
    const float scale =
        is_fine ? fine : scale_of(milliamperes, setup.sense_milliohms, kCoarseScale);

    DriveRegisters registers;
    registers.stealth_limit = stealth_limit(setup);
    registers.global_settings = kWireAlone | kMicrostepsByRegister | kStepFilter |
                                (registers.stealth_limit == 0 ? kSpreadCycle : 0U);
    registers.chopper = kChopper | (is_fine ? kFineSense : 0U) |
                        resolution_bits(setup.microsteps) << kResolutionPlace;
    registers.currents = current_bits(scale_bits(scale), setup.hold_percent);
    registers.hold_delay = kHoldDelay;
    return registers;
}

}  // namespace cusp::drives::tmc2209
