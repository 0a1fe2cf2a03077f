// Bits of the registers by their names in the data sheet.
#include "firmware/drives/tmc5160.hpp"

namespace cusp::drives::tmc5160 {
namespace {

// Section 9: the full scale of the sense voltage, uV; GLOBALSCALER of it, 32 to 255, and 0 for 256.
constexpr float kFullScale = 325000.0F;
constexpr std::uint32_t kLeastScaler = 32;
constexpr std::uint32_t kMostScaler = 256;

Datagram request(unsigned place, std::uint32_t word) noexcept
{
    Datagram datagram;
    put(place, datagram);
    put_word(word, datagram);
    return datagram;
}

}  // namespace

Datagram read_request(Register from) noexcept { return request(static_cast<unsigned>(from), 0); }

Datagram write_request(Register to, std::uint32_t value) noexcept
{
    constexpr unsigned kWriteBit = 0x80;
    return request(static_cast<unsigned>(to) | kWriteBit, value);
}

std::optional<std::uint32_t> parse_reply(Span<const std::uint8_t> bytes) noexcept
{
    constexpr std::uint8_t kNobody = 0xFF;
    if (bytes.size() != kReplySize) {
        return std::nullopt;
    }
    bool silent = true;
    for (const std::uint8_t byte : bytes) {
        silent = silent && byte == kNobody;
    }
    return silent ? std::nullopt : std::optional<std::uint32_t>{word_at(bytes, 1)};
}

DriveRegisters registers_for(const MotorSetup& setup) noexcept
{
    constexpr std::uint32_t kStealthChop = 1U << 2U;  // en_pwm_mode
    constexpr std::uint32_t kStepFilter = 1U << 3U;   // multistep_filt
    // As after its reset, with the stage on: interpolation to 256 microsteps; blank time 36 clocks, passive fast
    // decay 4, hysteresis 5 and -1, off time 3.
    constexpr std::uint32_t kChopper = 1U << 28U | 4U << 20U | 2U << 15U | 2U << 7U | 5U << 4U | 3U;
    constexpr unsigned kResolutionPlace = 24;

    const float scaler = static_cast<float>(kMostScaler) * kRootOfTwo * setup.milliamperes *
                         setup.sense_milliohms / kFullScale;
    DriveRegisters registers;
    registers.kind = DriveKind::kTmc5160;
    std::uint32_t run = scale_bits(kMostScale);
    if (scaler >= static_cast<float>(kMostScaler)) {
        registers.scaler = 0;
    } else if (scaler >= static_cast<float>(kLeastScaler)) {
        registers.scaler = static_cast<std::uint32_t>(scaler);
    } else {
        registers.scaler = kLeastScaler;
        run = scale_bits(scaler / static_cast<float>(kLeastScaler) * kMostScale);
    }
    registers.stealth_limit = stealth_limit(setup);
    registers.global_settings = kStepFilter | (registers.stealth_limit == 0 ? 0U : kStealthChop);
    registers.chopper = kChopper | resolution_bits(setup.microsteps) << kResolutionPlace;
    registers.currents = current_bits(run, setup.hold_percent);
    registers.hold_delay = kHoldDelay;
    return registers;
}

}  // namespace cusp::drives::tmc5160
