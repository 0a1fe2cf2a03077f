// The interrupt controller and the system control block, as the core reads and writes them.
#include <cstring>

#include "tests/target/cosim/core_model.hpp"

namespace cusp::cosim {

std::uint32_t CoreModel::read(std::uint32_t offset)
{
    if (offset >= 0x100 && offset < 0x10C) {
        std::uint32_t bits = 0;
        for (unsigned i = 0; i < 32; ++i) {
            bits |= (enabled_[(offset - 0x100) * 8 + i] ? 1U : 0U) << i;
        }
        return bits;
    }
    if (offset >= 0x400 && offset < 0x460) {
        std::uint32_t value = 0;
        std::memcpy(&value, &priorities_[offset - 0x400], 4);
        return value;
    }
    switch (offset) {
        case 0xD00:
            return facts_.id;
        case 0xD04:
            return (active_.empty() ? 0U : active_.back().exception) | (pend_sv_ ? 1U << 28U : 0U);
        case 0xD08:
            return vtor_;
        case 0xD0C:
            return 0xFA050000;
        case 0xD14:
            return ccr_;
        case 0xD20:
            return shpr3_;
        case 0xD24:
            return shcsr_;
        case 0xD28:
            return 0;
        case 0xD88:
            return cpacr_;
        default:
            circuit_.violate("the core: read of a register that is not modelled, " +
                             hexadecimal(0xE000E000U + offset));
            return 0;
    }
}

void CoreModel::write(std::uint32_t offset, std::uint32_t value)
{
    circuit_.interrupts_changed = true;
    const auto each = [&](std::uint32_t base, auto& flags, bool to) {
        for (unsigned i = 0; i < 32; ++i) {
            if ((value >> i & 1U) != 0 && (offset - base) * 8 + i < flags.size()) {
                flags[(offset - base) * 8 + i] = to;
            }
        }
    };
    if (offset >= 0x100 && offset < 0x10C) {
        each(0x100, enabled_, true);
    } else if (offset >= 0x180 && offset < 0x18C) {
        each(0x180, enabled_, false);
    } else if (offset >= 0x200 && offset < 0x20C) {
        each(0x200, circuit_.interrupt_edges, true);
    } else if (offset >= 0x280 && offset < 0x28C) {
        each(0x280, circuit_.interrupt_edges, false);
    } else if (offset >= 0x400 && offset < 0x460) {
        std::memcpy(&priorities_[offset - 0x400], &value, 4);
    } else if (offset == 0x010) {
        // Its time is not modelled: it pends as soon as it is on.
        timer_on_ = (value & 3U) == 3;
        timer_pends_ = timer_pends_ || timer_on_;
    } else if (offset == 0x014 || offset == 0x018) {
        // What it counts.
    } else if (offset == 0xD04) {
        pend_sv_ = (pend_sv_ || (value >> 28U & 1U) != 0) && (value >> 27U & 1U) == 0;
        timer_pends_ = timer_pends_ && (timer_on_ || (value >> 25U & 1U) == 0);
    } else if (offset == 0xD08) {
        vtor_ = value;
    } else if (offset == 0xD0C) {
        reset_wanted_ = reset_wanted_ || (value >> 16U == 0x05FA && (value >> 2U & 1U) != 0);
    } else if (offset == 0xD14) {
        ccr_ = value;
    } else if (offset == 0xD20) {
        shpr3_ = value;
    } else if (offset == 0xD88) {
        cpacr_ = value;
    } else {
        circuit_.violate("the core: write to a register that is not modelled, " +
                         hexadecimal(0xE000E000U + offset));
    }
}

}  // namespace cusp::cosim
