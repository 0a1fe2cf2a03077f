// RM0090 section 3.9.
#include "tests/target/cosim/flash_model.hpp"

#include <algorithm>

namespace cusp::cosim {
namespace {

constexpr std::uint32_t kStart = 0x08000000;
constexpr std::uint32_t kLock = 1U << 31U;
constexpr std::uint32_t kSequenceError = 1U << 7U;

// Sectors of 16 KB (4), 64 KB (1), 128 KB.
std::uint32_t sector_start(unsigned sector)
{
    return sector < 4 ? sector * 0x4000U : sector == 4 ? 0x10000U : 0x20000U * (sector - 4);
}

}  // namespace

FlashModel::FlashModel(Circuit& circuit, ClockModel& clocks, std::uint32_t size)
    : Model{circuit}, clocks_{clocks}, bytes_(size, 0xFF)
{
}

void FlashModel::reset()
{
    acr_ = 0;
    sr_ = 0;
    cr_ = kLock;
    key_ = 0;
    busy_until_ = 0;
    clocks_.set_wait_states(0);
}

std::uint32_t FlashModel::read(std::uint32_t offset)
{
    switch (offset) {
        case 0x00:
            return acr_;
        case 0x0C:
            return sr_ | (circuit_.now < busy_until_ ? 1U << 16U : 0U);
        case 0x10:
            return cr_;
        default:
            return 0;
    }
}

void FlashModel::write(std::uint32_t offset, std::uint32_t value)
{
    switch (offset) {
        case 0x00:
            if ((value >> 12U & 1U) != 0 && (acr_ >> 10U & 1U) != 0) {
                circuit_.violate("FLASH: the data cache is emptied while it is on");
            }
            acr_ = value;
            clocks_.set_wait_states(value & 15U);
            break;
        case 0x04:
            if (value == 0xCDEF89AB && key_ == 0x45670123) {
                cr_ &= ~kLock;
            } else if (value != 0x45670123) {
                circuit_.violate("FLASH: a wrong key");
            }
            key_ = value;
            break;
        case 0x0C:
            sr_ &= ~value;
            break;
        case 0x10:
            command(value);
            break;
        default:
            circuit_.violate("FLASH: write to a register that is not modelled");
    }
}

void FlashModel::command(std::uint32_t value)
{
    if ((cr_ & kLock) != 0) {
        if ((value & kLock) == 0) {
            circuit_.violate("FLASH: CR written while it is locked");
        }
        return;
    }
    if (circuit_.now < busy_until_) {
        circuit_.violate("FLASH: CR written while busy");
    }
    cr_ = value & ~(1U << 16U);
    if ((value >> 16U & 1U) == 0) {
        return;
    }
    if ((value & 3U) != 2) {
        circuit_.violate("FLASH: started without a sector erase");
        return;
    }
    const unsigned sector = value >> 3U & 15U;
    if (sector != first_free_ && sector != first_free_ + 1) {
        circuit_.violate("FLASH: sector " + std::to_string(sector) + " is erased");
    }
    const auto begin = bytes_.begin() + sector_start(sector);
    std::fill(begin, bytes_.begin() + sector_start(sector + 1), std::uint8_t{0xFF});
    busy_until_ = circuit_.now + erase_time_;
    ++erases_;
}

void FlashModel::store(std::uint32_t address, std::uint32_t size, std::uint32_t value)
{
    if ((cr_ & kLock) != 0 || (cr_ & 1U) == 0 || (cr_ >> 8U & 3U) != 2 || size != 4) {
        circuit_.violate("FLASH: a store to " + hexadecimal(address) + " that programs nothing");
        sr_ |= kSequenceError;
        return;
    }
    const std::uint32_t place = address - kStart;
    if (place < sector_start(first_free_) || place >= sector_start(first_free_ + 2)) {
        circuit_.violate("FLASH: " + hexadecimal(address) + " is programmed");
    }
    for (unsigned i = 0; i < 4; ++i) {
        // Programming clears bits only.
        if (bytes_[place + i] != 0xFF) {
            circuit_.violate("FLASH: a word is programmed twice");
        }
        bytes_[place + i] &= static_cast<std::uint8_t>(value >> 8 * i);
    }
    busy_until_ = circuit_.now + program_time_;
    ++words_;
}

}  // namespace cusp::cosim
