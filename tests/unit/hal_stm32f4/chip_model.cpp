// Behaviour of each register of the modelled chip, after RM0090.
#include "tests/unit/hal_stm32f4/chip_model.hpp"

namespace cusp::test {
namespace {

constexpr std::uint32_t kStreamEnable = 1U << 0U;
constexpr std::uint32_t kTransferError = 1U << 9U;
constexpr std::uint32_t kHalfTransfer = 1U << 10U;
constexpr std::uint32_t kTransferComplete = 1U << 11U;
constexpr std::uint32_t kStreamFlags = 0xF40;
constexpr std::uint32_t kFlashLock = 1U << 31U;
constexpr std::uint32_t kFlashStart = 1U << 16U;
constexpr std::uint32_t kFlashBusy = 1U << 16U;
constexpr std::uint32_t kWriteProtectionError = 1U << 4U;
constexpr std::uint32_t kDataCache = 1U << 10U;
constexpr std::uint32_t kEmptyDataCache = 1U << 12U;
constexpr std::uint32_t kCrystalOn = 1U << 16U;
constexpr std::uint32_t kMultiplierOn = 1U << 24U;
constexpr std::uint32_t kErased = 0xFFFFFFFF;

}  // namespace

ChipModel* ChipModel::current = nullptr;

ChipModel::ChipModel()
{
    current = this;
    flash.cr.value = kFlashLock;
    usart1.sr.value = 1U << 7U;
}
ChipModel::~ChipModel() { current = nullptr; }

std::uint32_t ModelWord::read() { return ChipModel::current->on_read(*this); }
void ModelWord::write(std::uint32_t written) { ChipModel::current->on_write(*this, written); }

std::uint32_t ChipModel::bus_address(const volatile void* memory)
{
    addresses_.push_back(memory);
    return static_cast<std::uint32_t>(addresses_.size() - 1);
}

std::uint32_t ChipModel::on_read(ModelWord& word)
{
    if (&word == &timer11.sr) {
        capture();
    }
    if (&word == &flash.sr && busy_reads_ > 0) {
        --busy_reads_;
        return word.value | kFlashBusy;
    }
    return word.value;
}

void ChipModel::on_write(ModelWord& word, std::uint32_t value)
{
    auto& stream = dma2.stream[1];
    const bool runs = (stream.cr.value & kStreamEnable) != 0;
    if (&word == &port_c.bsrr) {
        write_port(value);
    } else if (&word == &stream.cr) {
        write_stream_control(value);
    } else if (&word == &stream.ndtr || &word == &stream.par || &word == &stream.m0ar ||
               &word == &stream.fcr) {
        // Section 10.5.6 and on: protected, may be written only while the stream is off.
        if (runs) {
            ++violations;
        } else {
            word.value = value;
        }
    } else if (&word == &dma2.lifcr) {
        dma2.lisr.value &= ~value;
    } else if (&word == &flash.keyr) {
        keys_ = keys_ == 0 && value == 0x45670123 ? 1 : keys_ == 1 && value == 0xCDEF89AB ? 2 : 0;
        if (keys_ == 2) {
            flash.cr.value &= ~kFlashLock;
            keys_ = 0;
        }
    } else if (&word == &flash.cr) {
        write_flash_control(value);
    } else if (&word == &flash.sr) {
        word.value &= ~value;
    } else if (&word == &flash.acr) {
        write_flash_access(value);
    } else if (&word == &rcc.cr) {
        write_clock_control(value);
    } else if (&word == &rcc.cfgr) {
        write_clock_choice(value);
    } else if (&word == &rcc.pllcfgr && (rcc.cr.value & kMultiplierOn) != 0) {
        // Section 7.3.2: may be written only while the multiplier is off.
        ++violations;
    } else {
        word.value = value;
    }
}

// Section 7.3.1: each clock's ready bit follows its on bit, where it works.
void ChipModel::write_clock_control(std::uint32_t value)
{
    const bool multiplied = (rcc.cfgr.value >> 2U & 3U) == 2;
    if (multiplied && (value & kMultiplierOn) == 0) {
        ++violations;
    }
    const auto ready = [&](std::uint32_t on, bool works) {
        return (value & on) != 0 && works ? on << 1U : 0U;
    };
    constexpr std::uint32_t kReadyBits = 2U | kCrystalOn << 1U | kMultiplierOn << 1U;
    rcc.cr.value = (value & ~kReadyBits) | ready(1U, true) | ready(kCrystalOn, crystal_works) |
                   ready(kMultiplierOn, multiplier_works);
    power.csr.value = (rcc.cr.value & kMultiplierOn << 1U) != 0 ? 1U << 14U : 0U;
}

void ChipModel::write_clock_choice(std::uint32_t value)
{
    const std::uint32_t choice = value & 3U;
    const bool multiplied = choice == 2;
    // Five wait states and the highest voltage for 168 MHz.
    if (multiplied && ((rcc.cr.value & kMultiplierOn << 1U) == 0 || (flash.acr.value & 7U) < 5 ||
                       (power.cr.value & 1U << 14U) == 0)) {
        ++violations;
    }
    rcc.cfgr.value = (value & ~0xCU) | choice << 2U;
}

// Section 3.9.1: the data cache may be emptied only while it is off.
void ChipModel::write_flash_access(std::uint32_t value)
{
    if ((value & kEmptyDataCache) != 0) {
        if ((value & kDataCache) != 0) {
            ++violations;
        } else {
            cached_.clear();
        }
    }
    flash.acr.value = value;
}

void ChipModel::write_port(std::uint32_t word)
{
    const auto raise = word & 0xFFFFU;
    const auto lower = word >> 16U;
    // Section 8.4.7: where both bits are set, the set bit has priority.
    const std::uint32_t levels = (port_c.odr.value & ~lower) | raise;
    if (levels != port_c.odr.value) {
        port_c.odr.value = levels;
        changes.push_back({now_, levels & 0xFFFFU});
    }
}

void ChipModel::write_stream_control(std::uint32_t value)
{
    auto& stream = dma2.stream[1];
    const bool ran = (stream.cr.value & kStreamEnable) != 0;
    const bool runs = (value & kStreamEnable) != 0;
    if (ran && runs && value != stream.cr.value) {
        ++violations;
        return;
    }
    stream.cr.value = value;
    if (!ran && runs) {
        // Section 10.3.17: the flags of the stream have to be cleared before it is enabled.
        if ((dma2.lisr.value & kStreamFlags) != 0) {
            ++violations;
        }
        start_count_ = stream.ndtr.value;
        fetched_ = word_of_memory(0);
    }
}

std::uint32_t ChipModel::word_of_memory(std::uint32_t index) const
{
    const auto* words =
        static_cast<const volatile std::uint32_t*>(addresses_.at(dma2.stream[1].m0ar.value));
    return words[index];
}

// Section 18.3.15: timer 8 counts while timer 2, at 84 MHz, has not come to its single end.
bool ChipModel::gate_open()
{
    constexpr std::uint32_t kGated = 1U << 4U | 5U;
    if ((timer2.cr1.value & 1U) != 0) {
        ++timer2.cnt.value;
        if (timer2.cnt.value >= (timer2.arr.value + 1) / 84) {
            timer2.cr1.value &= ~1U;
        }
    }
    const bool one_pulse = (timer2.cr1.value & 8U) != 0 && timer2.cr2.value == 1U << 4U;
    return timer8.smcr.value == kGated && one_pulse && (timer2.cr1.value & 1U) != 0;
}

// Each eighth edge of the crystal by 31, counted at 16 MHz.
void ChipModel::capture()
{
    const bool on = (timer11.cr1.value & 1U) != 0 && (timer11.ccer.value & 1U) != 0;
    const bool divided = (rcc.cfgr.value >> 16U & 31U) == 31 && timer11.option.value == 2;
    const bool runs = (rcc.cr.value & kCrystalOn << 1U) != 0;
    if (on && divided && runs && timer11.ccmr1.value == 0xD) {
        timer11.ccr1.value += static_cast<std::uint32_t>(16000000ULL * 31 * 8 / crystal_hz);
        timer11.sr.value |= 2;
    }
}

void ChipModel::run_microsecond()
{
    const bool open = gate_open();
    auto& stream = dma2.stream[1];
    const bool asks = (timer8.cr1.value & 1U) != 0 && (timer8.dier.value & 1U << 8U) != 0 &&
                      timer8.arr.value == 167 && timer8.psc.value == 0 && open;
    const bool listens = (stream.cr.value & kStreamEnable) != 0 && stream.cr.value >> 25U == 7;
    if (asks && listens) {
        if (addresses_.at(stream.par.value) == &port_c.bsrr) {
            write_port(fetched_);
        }
        --stream.ndtr.value;
        if (stream.ndtr.value == start_count_ / 2) {
            dma2.lisr.value |= kHalfTransfer;
        }
        if (stream.ndtr.value == 0) {
            dma2.lisr.value |= kTransferComplete;
            stream.ndtr.value = start_count_;
        }
        fetched_ = word_of_memory(start_count_ - stream.ndtr.value);
    }
    ++now_;
}

bool ChipModel::interrupt_pending() const
{
    const std::uint32_t cr = dma2.stream[1].cr.value;
    const std::uint32_t flags = dma2.lisr.value;
    return ((cr & 1U << 4U) != 0 && (flags & kTransferComplete) != 0) ||
           ((cr & 1U << 3U) != 0 && (flags & kHalfTransfer) != 0) ||
           ((cr & 1U << 2U) != 0 && (flags & kTransferError) != 0);
}

void ChipModel::raise_transfer_error()
{
    // Section 10.3.18: the stream is switched off by the controller itself.
    dma2.lisr.value |= kTransferError;
    dma2.stream[1].cr.value &= ~kStreamEnable;
}

bool ChipModel::spend_power()
{
    if (power_left <= 0) {
        return false;
    }
    --power_left;
    return power_left > 0;
}

std::uint32_t ChipModel::read_memory(std::uint32_t address)
{
    const auto found = flash_words.find(address);
    const std::uint32_t there = found == flash_words.end() ? kErased : found->second;
    if ((flash.acr.value & kDataCache) == 0) {
        return there;
    }
    return cached_.emplace(address, there).first->second;
}

void ChipModel::write_memory(std::uint32_t address, std::uint32_t value)
{
    const bool programs = (flash.cr.value & (kFlashLock | 1U)) == 1U &&
                          (flash.cr.value >> 8U & 3U) == 2 && busy_reads_ == 0;
    if (!programs) {
        ++violations;
        flash.sr.value |= kWriteProtectionError;
        return;
    }
    const std::uint32_t before = read_memory(address);
    if (before != kErased && before != value) {
        ++violations;
    }
    const bool was_on = power_left > 0;
    if (spend_power()) {
        flash_words[address] = before & value;
    } else if (was_on) {
        // The power fails amid the write: some of the bits are cleared.
        flash_words[address] = before & (value | 0x0F0F3355U);
    }
    // A write changes what is cached too (section 3.5.2); an erase does not.
    const auto cached = cached_.find(address);
    if (cached != cached_.end()) {
        cached->second = flash_words.count(address) != 0 ? flash_words[address] : kErased;
    }
    busy_reads_ = 3;
}

void ChipModel::write_flash_control(std::uint32_t value)
{
    if ((flash.cr.value & kFlashLock) != 0) {
        ++violations;
        return;
    }
    flash.cr.value = value & ~kFlashStart;
    const bool erases = (value & kFlashStart) != 0 && (value & 2U) != 0;
    if (!erases) {
        return;
    }
    const bool was_on = power_left > 0;
    const bool finishes = spend_power();
    const std::uint32_t begin = 0x08000000 + (value >> 3U & 0xFU) * 0x4000;
    const std::uint32_t end = begin + (finishes ? 0x4000 : was_on ? 0x2000 : 0);
    flash_words.erase(flash_words.lower_bound(begin), flash_words.lower_bound(end));
    busy_reads_ = 50;
}

}  // namespace cusp::test
