// Fields of registers by their names in the data sheets.
#include "firmware/drives/drive_kind.hpp"

namespace cusp::drives {
namespace {

constexpr unsigned kBytesOfWord = 4;

}  // namespace

std::uint32_t scale_bits(float scale) noexcept
{
    if (scale < 1.0F) {
        return 0;
    }
    return static_cast<std::uint32_t>(scale >= kMostScale ? kMostScale : scale) - 1;
}

std::uint32_t resolution_bits(std::uint32_t microsteps) noexcept
{
    std::uint32_t bits = 8;  // a full step
    for (; bits > 0 && microsteps > 1; microsteps /= 2) {
        --bits;
    }
    return bits;
}

std::uint32_t current_bits(std::uint32_t run, float hold_percent) noexcept
{
    constexpr std::uint32_t kHoldSteps = 8U << 16U;  // IHOLDDELAY: from run to hold, each 22 ms
    constexpr float kPercent = 100.0F;
    const std::uint32_t hold = scale_bits(static_cast<float>(run + 1) * hold_percent / kPercent);
    return kHoldSteps | run << 8U | hold;
}

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

void put_word(std::uint32_t word, Datagram& datagram) noexcept
{
    for (unsigned place = kBytesOfWord * kBitsOfByte; place > 0; place -= kBitsOfByte) {
        put(word >> (place - kBitsOfByte) & 0xFFU, datagram);
    }
}

std::uint32_t word_at(Span<const std::uint8_t> bytes, std::size_t place) noexcept
{
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < kBytesOfWord; ++i) {
        word = word << kBitsOfByte | bytes[place + i];
    }
    return word;
}

}  // namespace cusp::drives
