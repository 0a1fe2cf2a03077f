// Instructions by Unicorn, exceptions by ARMv7-M's manual (section B1.5).
#include "tests/target/cosim/core_model.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

namespace cusp::cosim {
namespace {

constexpr std::uint32_t kFlashStart = 0x08000000;
constexpr std::uint32_t kNowhere = 0xFFFFFF00;
constexpr std::uint32_t kPage = 1024;  // of the engine
constexpr unsigned kNmi = 2;
constexpr unsigned kPendSv = 14;
constexpr unsigned kTimer = 15;
constexpr unsigned kFirstInterrupt = 16;
constexpr unsigned kNone = 0;
constexpr unsigned kThreadPriority = 256;
constexpr std::uint32_t kFloatingPointActive = 4;  // FPCA of CONTROL
constexpr unsigned kBasicWords = 8;
constexpr unsigned kFloatWords = 18;

void demand(uc_err error, const char* what)
{
    if (error != UC_ERR_OK) {
        throw std::runtime_error{std::string{what} + ": " + uc_strerror(error)};
    }
}

}  // namespace

CoreModel::CoreModel(Circuit& circuit, std::vector<std::uint8_t>& flash, Outside outside)
    : Model{circuit}, flash_{flash}, outside_{std::move(outside)}, counts_(flash.size() / 2)
{
    const auto mode = static_cast<uc_mode>(UC_MODE_THUMB | UC_MODE_MCLASS);
    demand(uc_open(UC_ARCH_ARM, mode, &engine_), "unicorn");
    demand(uc_ctl_set_cpu_model(engine_, UC_CPU_ARM_CORTEX_M4), "unicorn, Cortex-M4");
    demand(uc_mem_map_ptr(engine_, kFlashStart, flash_.size(), UC_PROT_READ | UC_PROT_EXEC,
                          flash_.data()),
           "flash");
    for (MemoryArea& area : circuit_.memories) {
        demand(uc_mem_map_ptr(engine_, area.start, area.bytes.size(), UC_PROT_READ | UC_PROT_WRITE,
                              area.bytes.data()),
               "memory");
    }
    const auto read = [](uc_engine*, std::uint64_t offset, unsigned size, void* range) {
        auto* const self = static_cast<std::pair<CoreModel*, std::uint32_t>*>(range);
        return std::uint64_t{
            self->first->outside_.read(self->second + static_cast<std::uint32_t>(offset), size)};
    };
    const auto write = [](uc_engine*, std::uint64_t offset, unsigned size, std::uint64_t value,
                          void* range) {
        auto* const self = static_cast<std::pair<CoreModel*, std::uint32_t>*>(range);
        self->first->outside_.write(self->second + static_cast<std::uint32_t>(offset), size,
                                    static_cast<std::uint32_t>(value));
    };
    // Owned by the engine's callbacks until the end of the program.
    static std::vector<std::unique_ptr<std::pair<CoreModel*, std::uint32_t>>> ranges;
    for (const auto& [start, size] : {std::pair{0x40000000U, 0x28000U},
                                      {0x50000000U, 0x5000U},
                                      {0x1FFF7000U, 0x1000U},
                                      {0xE0001000U, 0x1000U},
                                      {0xE000E000U, 0x1000U},
                                      {0xE0042000U, 0x1000U}}) {
        ranges.push_back(std::make_unique<std::pair<CoreModel*, std::uint32_t>>(this, start));
        demand(uc_mmio_map(engine_, start, size, read, ranges.back().get(), write,
                           ranges.back().get()),
               "registers");
    }
    uc_hook hook = 0;
    demand(
        uc_hook_add(engine_, &hook, UC_HOOK_BLOCK, reinterpret_cast<void*>(on_block), this, 1, 0),
        "hook");
    demand(uc_hook_add(engine_, &hook, UC_HOOK_MEM_WRITE_PROT,
                       reinterpret_cast<void*>(on_protected_store), this, 1, 0),
           "hook");
}

CoreModel::~CoreModel() { uc_close(engine_); }

std::uint32_t CoreModel::register_of(int name) const
{
    std::uint32_t value = 0;
    uc_reg_read(engine_, name, &value);
    return value;
}

void CoreModel::set_register(int name, std::uint32_t value) { uc_reg_write(engine_, name, &value); }

void CoreModel::reset()
{
    active_.clear();
    enabled_ = {};
    circuit_.interrupt_edges = {};
    priorities_ = {};
    pend_sv_ = false;
    timer_on_ = timer_pends_ = masked_ = false;
    vtor_ = 0;
    shpr1_ = shpr2_ = shpr3_ = 0;
    cpacr_ = 0;
    reset_wanted_ = false;
    locked_up_ = false;
    sleeping_ = false;
    circuit_.nmi = false;
    std::array<std::uint32_t, 2> vectors{};
    std::memcpy(vectors.data(), flash_.data(), sizeof vectors);
    for (const int name : {UC_ARM_REG_CONTROL, UC_ARM_REG_PRIMASK, UC_ARM_REG_BASEPRI}) {
        set_register(name, 0);
    }
    set_register(UC_ARM_REG_XPSR, 1U << 24U);
    set_register(UC_ARM_REG_SP, vectors[0]);
    set_register(UC_ARM_REG_LR, 0xFFFFFFFF);
    set_register(UC_ARM_REG_PC, vectors[1]);
}

std::uint8_t* CoreModel::memory(std::uint32_t address, std::uint32_t size)
{
    for (MemoryArea& area : circuit_.memories) {
        if (address >= area.start && address - area.start < area.bytes.size() &&
            area.bytes.size() - (address - area.start) >= size) {
            return &area.bytes[address - area.start];
        }
    }
    return nullptr;
}

// A Thumb instruction has two halfwords where the first begins with 11101, 11110 or 11111.
unsigned CoreModel::count_instructions(std::uint32_t address, std::uint32_t size)
{
    const std::uint32_t place = (address - kFlashStart) / 2;
    if (address < kFlashStart || place >= counts_.size()) {
        return size / 2;
    }
    std::uint32_t& known = counts_[place];
    if (known >> 16U != size) {
        unsigned count = 0;
        for (std::uint32_t at = 0; at < size; ++count) {
            const std::uint8_t high = flash_[address - kFlashStart + at + 1];
            at += high >= 0xE8 ? 4 : 2;
        }
        known = size << 16U | count;
    }
    return known & 0xFFFFU;
}

void CoreModel::on_block(uc_engine*, std::uint64_t address, std::uint32_t size, void* self)
{
    static_cast<CoreModel*>(self)->begin_block(static_cast<std::uint32_t>(address), size);
}

void CoreModel::begin_block(std::uint32_t address, std::uint32_t size)
{
    if (circuit_.now >= circuit_.next_event) {
        outside_.events();
    }
    if (masked_ && (register_of(UC_ARM_REG_PRIMASK) & 1U) == 0) {
        masked_ = false;
        circuit_.interrupts_changed = true;
    }
    if (circuit_.interrupts_changed || reset_wanted_ || outside_.must_stop()) {
        stopped_ = true;
        uc_emu_stop(engine_);
        return;
    }
    // The engine ends a block where a page of 1 KB ends: the next one is its rest.
    const bool goes_on = address % kPage == 0 && block_ + block_size_ == address;
    unbroken_from_ = goes_on ? unbroken_from_ : address;
    block_ = address;
    block_size_ = size;
    const unsigned count = count_instructions(address, size);
    instructions_ += count;
    circuit_.now += count * instruction_time_;
}

bool CoreModel::on_protected_store(
    uc_engine*, uc_mem_type, std::uint64_t address, int size, std::int64_t value, void* self)
{
    static_cast<CoreModel*>(self)->outside_.store_flash(static_cast<std::uint32_t>(address),
                                                        static_cast<unsigned>(size),
                                                        static_cast<std::uint32_t>(value));
    return true;
}

void CoreModel::lock_up(const std::string& why)
{
    circuit_.violate("the core locks up: " + why + " near " + hexadecimal(block_));
    locked_up_ = true;
}

void CoreModel::run()
{
    stopped_ = false;
    const std::uint32_t at = program_counter();
    const uc_err error = uc_emu_start(engine_, at | 1U, kNowhere, 0, 0);
    const std::uint32_t now_at = program_counter();
    if (now_at >= kNowhere) {
        leave(now_at | 1U);
        return;
    }
    if (error != UC_ERR_OK) {
        lock_up(uc_strerror(error));
        return;
    }
    sleeping_ = !stopped_;
}

// A long block: the engine is asked for events once a block.
void CoreModel::hang()
{
    constexpr std::uint32_t kRest = 200;  // NOPs
    constexpr std::uint16_t kNop = 0xBF00;
    constexpr std::uint16_t kBranchBack = 0xE000U | (0x7FFU & (0U - (kRest + 2)));
    const std::size_t at = flash_.size() - kPage;
    for (std::uint32_t i = 0; i <= kRest; ++i) {
        const std::uint16_t word = i < kRest ? kNop : kBranchBack;
        std::memcpy(&flash_[at + 2UL * i], &word, sizeof word);
    }
    set_register(UC_ARM_REG_PC, (kFlashStart + static_cast<std::uint32_t>(at)) | 1U);
    sleeping_ = false;
}

unsigned CoreModel::priority_of(unsigned exception) const
{
    if (exception < 4) {
        return 0;  // NMI: above all else here
    }
    if (exception == kPendSv) {
        return 1 + (shpr3_ >> 16U & 0xF0U);
    }
    return exception >= kFirstInterrupt ? 1 + (priorities_[exception - kFirstInterrupt] & 0xF0U)
                                        : 1;
}

unsigned CoreModel::running_priority() const
{
    unsigned least = kThreadPriority;
    for (const Active& active : active_) {
        least = std::min(least, priority_of(active.exception));
    }
    return least;
}

bool CoreModel::pending(unsigned exception) const
{
    if (exception == kNmi) {
        return circuit_.nmi;
    }
    if (exception == kPendSv) {
        return pend_sv_;
    }
    if (exception == kTimer) {
        return timer_pends_;
    }
    const unsigned number = exception - kFirstInterrupt;
    return exception >= kFirstInterrupt && enabled_[number] &&
           (circuit_.interrupt_lines[number] || circuit_.interrupt_edges[number]);
}

unsigned CoreModel::most_urgent() const
{
    unsigned best = kNone;
    unsigned best_priority = kThreadPriority;
    for (unsigned exception = kNmi; exception < kFirstInterrupt + enabled_.size(); ++exception) {
        if (pending(exception) && priority_of(exception) < best_priority) {
            best = exception;
            best_priority = priority_of(exception);
        }
    }
    return best;
}

void CoreModel::take_exception()
{
    circuit_.interrupts_changed = false;
    const unsigned exception = most_urgent();
    if (exception == kNone) {
        return;
    }
    sleeping_ = false;
    if (priority_of(exception) >= running_priority()) {
        return;
    }
    if (exception != kNmi && (register_of(UC_ARM_REG_PRIMASK) & 1U) != 0) {
        masked_ = true;  // until they are allowed again: seen at a block's begin
        return;
    }
    enter(exception);
}

void CoreModel::enter(unsigned exception)
{
    const std::uint32_t stack = register_of(UC_ARM_REG_SP);
    const bool floats = (register_of(UC_ARM_REG_CONTROL) & kFloatingPointActive) != 0;
    const std::uint32_t words = kBasicWords + (floats ? kFloatWords : 0);
    const std::uint32_t frame = (stack - words * 4) & ~7U;
    std::uint8_t* const to = memory(frame, words * 4);
    if (to == nullptr) {
        lock_up("the stack overflows at " + hexadecimal(frame));
        return;
    }
    lowest_stack_ = std::min(lowest_stack_, frame);
    std::array<std::uint32_t, kBasicWords + kFloatWords> saved{};
    constexpr std::array<int, 7> kNames{UC_ARM_REG_R0,  UC_ARM_REG_R1, UC_ARM_REG_R2, UC_ARM_REG_R3,
                                        UC_ARM_REG_R12, UC_ARM_REG_LR, UC_ARM_REG_PC};
    for (unsigned i = 0; i < kNames.size(); ++i) {
        saved[i] = register_of(kNames[i]);
    }
    saved[7] = register_of(UC_ARM_REG_XPSR) | 1U << 24U | ((stack & 4U) != 0 ? 1U << 9U : 0U);
    for (unsigned i = 0; floats && i < 16; ++i) {
        saved[kBasicWords + i] = register_of(UC_ARM_REG_S0 + static_cast<int>(i));
    }
    saved[kBasicWords + 16] = floats ? register_of(UC_ARM_REG_FPSCR) : 0;
    std::memcpy(to, saved.data(), words * 4);

    const bool nested = !active_.empty();
    set_register(UC_ARM_REG_SP, frame);
    set_register(UC_ARM_REG_LR, 0xFFFFFFE1U | (floats ? 0U : 0x10U) | (nested ? 0U : 8U));
    set_register(UC_ARM_REG_CONTROL, 0);
    set_register(UC_ARM_REG_XPSR, 1U << 24U);
    std::uint32_t vector = 0;
    const std::uint32_t table = vtor_ >= kFlashStart ? vtor_ - kFlashStart : vtor_;
    std::memcpy(&vector, &flash_[table + exception * 4], 4);
    set_register(UC_ARM_REG_PC, vector);

    active_.push_back({exception, instructions_, 0});
    circuit_.nmi = circuit_.nmi && exception != kNmi;
    pend_sv_ = pend_sv_ && exception != kPendSv;
    timer_pends_ = timer_pends_ && exception != kTimer;
    if (exception >= kFirstInterrupt) {
        circuit_.interrupt_edges[exception - kFirstInterrupt] = false;
    }
}

// Erratum 838869 of the Cortex-M4: a store before the return may lead to a wrong vector.
void CoreModel::check_barrier(unsigned exception)
{
    bool found = false;
    for (std::uint32_t at = unbroken_from_ - kFlashStart;
         at + 4 <= block_ - kFlashStart + block_size_; at += 2) {
        constexpr std::array<std::uint8_t, 4> kBarrier{0xBF, 0xF3, 0x4F, 0x8F};
        found = found || std::equal(kBarrier.begin(), kBarrier.end(), flash_.begin() + at);
    }
    if (!found) {
        circuit_.violate("exception " + std::to_string(exception) +
                         " returns without a barrier (erratum 838869)");
    }
}

void CoreModel::leave(std::uint32_t exception_return)
{
    if (active_.empty()) {
        lock_up("a return from no exception");
        return;
    }
    const Active ended = active_.back();
    active_.pop_back();
    check_barrier(ended.exception);
    const std::uint64_t all = instructions_ - ended.entered_at;
    longest_[ended.exception] = std::max(longest_[ended.exception], all - ended.inside);
    if (!active_.empty()) {
        active_.back().inside += all;
    }
    const bool floats = (exception_return & 0x10U) == 0;
    const std::uint32_t words = kBasicWords + (floats ? kFloatWords : 0);
    const std::uint32_t frame = register_of(UC_ARM_REG_SP);
    const std::uint8_t* const from = memory(frame, words * 4);
    if (from == nullptr) {
        lock_up("the stack is gone");
        return;
    }
    std::array<std::uint32_t, kBasicWords + kFloatWords> saved{};
    std::memcpy(saved.data(), from, words * 4);
    set_register(UC_ARM_REG_CONTROL, floats ? kFloatingPointActive : 0U);
    for (unsigned i = 0; floats && i < 16; ++i) {
        set_register(UC_ARM_REG_S0 + static_cast<int>(i), saved[kBasicWords + i]);
    }
    if (floats) {
        set_register(UC_ARM_REG_FPSCR, saved[kBasicWords + 16]);
    }
    set_register(UC_ARM_REG_SP, (frame + words * 4) | ((saved[7] >> 9U & 1U) != 0 ? 4U : 0U));
    constexpr std::array<int, 6> kNames{UC_ARM_REG_R0, UC_ARM_REG_R1,  UC_ARM_REG_R2,
                                        UC_ARM_REG_R3, UC_ARM_REG_R12, UC_ARM_REG_LR};
    for (unsigned i = 0; i < kNames.size(); ++i) {
        set_register(kNames[i], saved[i]);
    }
    set_register(UC_ARM_REG_PC, saved[6] | 1U);
    set_register(UC_ARM_REG_XPSR, saved[7] & ~(1U << 9U));
    circuit_.interrupts_changed = true;
}

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
            return 0x410FC241;
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
