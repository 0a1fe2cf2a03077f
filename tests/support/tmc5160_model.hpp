// Tmc5160Model: a TMC5160 as its pins see it: bits in, a shift register, registers, bits out.
//
// By the data sheet, revision 1.17: section 4 (SPI), section 6 (registers). It knows nothing of the firmware.
// An edge of the clock while it is selected: rising takes a bit in, falling shows the next one out. What a
// datagram asks for comes back with the next one.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace cusp::test {

class Tmc5160Model {
public:
    using Registers = std::map<std::uint32_t, std::uint32_t>;

    enum Place : std::uint32_t {
        kGconf = 0x00,
        kGstat = 0x01,
        kIoin = 0x04,
        kGlobalScaler = 0x0B,
        kIholdIrun = 0x10,
        kTpowerdown = 0x11,
        kTpwmthrs = 0x13,
        kChopconf = 0x6C,
        kDrvStatus = 0x6F,
        kPwmconf = 0x70,
    };
    // Bits of GSTAT.
    static constexpr std::uint32_t kReset = 1, kDriverError = 2, kUndervoltage = 4;

    Tmc5160Model() { power_up(); }

    // Faults: no module, or none with power; a wrong bit in so many answers; another chip; writes that are lost,
    // though they are mirrored.
    bool missing{false};
    unsigned garbled{0};
    std::uint32_t version{0x30};
    bool deaf{false};

    void power_up()
    {
        registers_ = {{kGconf, 0x8},      {kGstat, kReset},   {0x08, 0xE},
                      {0x09, 0x00010606}, {0x0A, 0x00080400}, {kGlobalScaler, 0},
                      {kIholdIrun, 0},    {kTpowerdown, 10},  {kTpwmthrs, 0},
                      {0x14, 0},          {0x15, 0},          {kChopconf, 0x10410150},
                      {0x6D, 0},          {0x6E, 0},          {kPwmconf, 0xC40C001E}};
        answer_ = 0;
        count_ = 0;
        damaged_ = 0;
    }
    // Bits of DRV_STATUS.
    void set_status(std::uint32_t bits)
    {
        constexpr std::uint32_t kSwitchesOff = 1U << 25U | 3U << 27U | 3U << 12U;
        status_ = bits;
        if ((bits & kSwitchesOff) != 0) {
            registers_[kGstat] |= kDriverError;
        }
    }
    // A supply that sank, but not so far that it forgot.
    void starve() { registers_[kGstat] |= kUndervoltage; }

    // Levels at CSN, SCK and SDI; one of them has changed.
    void set_pins(bool deselected, bool clock, bool data)
    {
        if (deselected != deselected_) {
            deselected_ = deselected;
            deselected ? end() : begin();
        }
        if (!deselected_ && clock != clock_) {
            if (clock) {
                shift_ = (shift_ << 1U | (data ? 1U : 0U)) & kAll;
                ++count_;
            } else {
                out_ = (shift_ >> (kBits - 1) & 1U) != 0;
            }
        }
        clock_ = clock;
    }
    // The level at SDO; nothing while nobody drives it.
    std::optional<bool> data_out() const
    {
        return missing || deselected_ ? std::nullopt : std::optional<bool>{out_};
    }

    const Registers& registers() const { return registers_; }
    std::uint64_t answers() const { return answers_; }  // datagrams taken
    std::uint64_t damaged() const { return damaged_; }  // that were not of 40 bits, since power-up
    std::uint64_t writes() const { return writes_; }
    // Writes that the data sheet does not allow.
    const std::vector<std::string>& violations() const { return violations_; }

private:
    static constexpr unsigned kBits = 40;
    static constexpr std::uint64_t kAll = (std::uint64_t{1} << kBits) - 1;

    void begin()
    {
        const std::uint64_t flags = (registers_[kGstat] & 3U) | 1U << 3U;  // at standstill
        shift_ = flags << 32U | answer_;
        if (garbled > 0) {
            --garbled;
            shift_ ^= std::uint64_t{1} << 25U;
        }
        out_ = (shift_ >> (kBits - 1)) != 0;
        count_ = 0;
    }
    void end()
    {
        if (missing || count_ == 0) {
            return;
        }
        if (count_ != kBits) {
            ++damaged_;
            return;
        }
        ++answers_;
        const auto place = static_cast<std::uint32_t>(shift_ >> 32U);
        const auto value = static_cast<std::uint32_t>(shift_);
        if ((place & 0x80U) == 0) {
            answer_ = read(place);
            return;
        }
        answer_ = value;
        if (!deaf) {
            write(place & 0x7FU, value);
        }
    }
    std::uint32_t read(std::uint32_t place)
    {
        switch (place) {
            case kGconf:
            case kGstat:
            case 0x08:
            case kChopconf:
                return registers_[place];
            case kIoin:
                return version << 24U | 1U << 6U;
            case kDrvStatus: {
                const std::uint32_t held = registers_[kIholdIrun] & 31U;
                return status_ | 1U << 31U | held << 16U;
            }
            default:
                return 0;  // to be written only, or none
        }
    }
    void write(std::uint32_t place, std::uint32_t value)
    {
        // Bits that each has.
        static const Registers kWidths{
            {kGconf, 0x3FFFF},        {kGstat, 7},         {0x08, 0x1F},
            {0x09, 0x7FFFF},          {0x0A, 0x3FFFFF},    {kGlobalScaler, 0xFF},
            {kIholdIrun, 0x000F1F1F}, {kTpowerdown, 0xFF}, {kTpwmthrs, 0xFFFFF},
            {0x14, 0xFFFFF},          {0x15, 0xFFFFF},     {kChopconf, 0xFFFFFFFF},
            {0x6D, 0x1FFFFFF},        {0x6E, 0xFFFFFF},    {kPwmconf, 0xFFFFFFFF}};
        const auto width = kWidths.find(place);
        if (width == kWidths.end() || (value & ~width->second) != 0) {
            violations_.push_back("write of " + std::to_string(value) + " to register " +
                                  std::to_string(place));
            return;
        }
        if (place == kGlobalScaler && value > 0 && value < 32) {
            violations_.push_back("GLOBALSCALER " + std::to_string(value));
        }
        registers_[place] = place == kGstat ? registers_[kGstat] & ~value : value;
        ++writes_;
    }

    Registers registers_;
    std::uint32_t status_{0};
    bool deselected_{true};
    bool clock_{true};
    bool out_{false};
    std::uint64_t shift_{0};
    unsigned count_{0};
    std::uint32_t answer_{0};  // of the last datagram
    std::uint64_t answers_{0};
    std::uint64_t damaged_{0};
    std::uint64_t writes_{0};
    std::vector<std::string> violations_;
};

}  // namespace cusp::test
