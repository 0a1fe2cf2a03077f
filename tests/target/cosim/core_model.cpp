// Instructions by Unicorn, exceptions by ARMv7-M's manual (section B1.5).
#include "tests/target/cosim/core_model.hpp"

#include <algorithm>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

namespace cusp::cosim {
namespace {

constexpr std::uint32_t kNowhere = 0xFFFFFF00;
constexpr std::uint32_t kPage = 1024;  // of the engine
constexpr unsigned kNmi = 2;
constexpr unsigned kPendSv = 14;
constexpr unsigned kTimer = 15;
constexpr unsigned kFirstInterrupt = 16;
constexpr unsigned kNone = 0;
constexpr unsigned kThreadPriority = 256;
constexpr std::uint32_t kFloatingPointActive = 4;  // FPCA of CONTROL
constexpr std::uint32_t kSecureFloatingPoint = 8;  // SFPA
constexpr unsigned kBasicWords = 8;
constexpr unsigned kFloatWords = 18;

void demand(uc_err error, const char* what)
{
    if (error != UC_ERR_OK) {
        throw std::runtime_error{std::string{what} + ": " + uc_strerror(error)};
    }
}

}  // namespace

CoreModel::CoreModel(Circuit& circuit,
                     CoreFacts facts,
                     std::vector<std::uint8_t>& flash,
                     Outside outside)
    : Model{circuit}, facts_{std::move(facts)}, flash_{flash}, outside_{std::move(outside)}
{
    const auto mode = static_cast<uc_mode>(UC_MODE_THUMB | UC_MODE_MCLASS);
    demand(uc_open(UC_ARCH_ARM, mode, &engine_), "unicorn");
    demand(uc_ctl_set_cpu_model(engine_, facts_.cpu), "unicorn, the core");
    map_memories();
    map_registers();
    uc_hook hook = 0;
    demand(
        uc_hook_add(engine_, &hook, UC_HOOK_BLOCK, reinterpret_cast<void*>(on_block), this, 1, 0),
        "hook");
    demand(uc_hook_add(engine_, &hook, UC_HOOK_MEM_WRITE_PROT,
                       reinterpret_cast<void*>(on_protected_store), this, 1, 0),
           "hook");
}

void CoreModel::map_memories()
{
    const auto add_code = [this](std::uint32_t start, const std::vector<std::uint8_t>& bytes) {
        code_.push_back({start, &bytes, std::vector<std::uint32_t>(bytes.size() / 2)});
    };
    demand(uc_mem_map_ptr(engine_, facts_.flash_start, flash_.size(), UC_PROT_READ | UC_PROT_EXEC,
                          flash_.data()),
           "flash");
    for (MemoryArea& area : circuit_.memories) {
        const unsigned allowed = UC_PROT_READ | (area.writable ? unsigned{UC_PROT_WRITE} : 0U) |
                                 (area.executes ? unsigned{UC_PROT_EXEC} : 0U);
        demand(uc_mem_map_ptr(engine_, area.start, area.bytes.size(), allowed, area.bytes.data()),
               "memory");
        if (area.executes) {
            add_code(area.start, area.bytes);
        }
    }
    add_code(facts_.flash_start, flash_);
}

void CoreModel::map_registers()
{
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
    for (const auto& [start, size] : facts_.registers) {
        ranges.push_back(std::make_unique<std::pair<CoreModel*, std::uint32_t>>(this, start));
        demand(uc_mmio_map(engine_, start, size, read, ranges.back().get(), write,
                           ranges.back().get()),
               "registers");
    }
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
    vtor_ = facts_.vectors;
    shpr1_ = shpr2_ = shpr3_ = 0;
    cpacr_ = 0;
    reset_wanted_ = false;
    locked_up_ = false;
    sleeping_ = false;
    circuit_.nmi = false;
    for (const int name : {UC_ARM_REG_CONTROL, UC_ARM_REG_PRIMASK, UC_ARM_REG_BASEPRI}) {
        set_register(name, 0);
    }
    set_register(UC_ARM_REG_XPSR, 1U << 24U);
    set_register(UC_ARM_REG_SP, word_at(facts_.vectors));
    set_register(UC_ARM_REG_LR, 0xFFFFFFFF);
    set_register(UC_ARM_REG_PC, word_at(facts_.vectors + 4));
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

// The flash is seen at address 0, too.
std::uint32_t CoreModel::word_at(std::uint32_t address)
{
    const std::uint8_t* from = memory(address, 4);
    if (from == nullptr) {
        const std::uint32_t place =
            address >= facts_.flash_start ? address - facts_.flash_start : address;
        if (place > flash_.size() - 4) {
            lock_up("no vector at " + hexadecimal(address));
            return 0;
        }
        from = &flash_[place];
    }
    std::uint32_t word = 0;
    std::memcpy(&word, from, sizeof word);
    return word;
}

// A Thumb instruction has two halfwords where the first begins with 11101, 11110 or 11111.
unsigned CoreModel::count_instructions(std::uint32_t address, std::uint32_t size)
{
    for (Code& code : code_) {
        const std::uint32_t place = (address - code.start) / 2;
        if (address < code.start || place >= code.counts.size()) {
            continue;
        }
        std::uint32_t& known = code.counts[place];
        if (known >> 16U != size) {
            unsigned count = 0;
            for (std::uint32_t at = 0; at < size; ++count) {
                const std::uint8_t high = (*code.bytes)[address - code.start + at + 1];
                at += high >= 0xE8 ? 4 : 2;
            }
            known = size << 16U | count;
        }
        return known & 0xFFFFU;
    }
    return size / 2;
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
    const std::uint32_t at = facts_.circles;
    const auto flash_end = static_cast<std::uint32_t>(facts_.flash_start + flash_.size());
    std::uint8_t* const to =
        at == flash_end - kPage ? &flash_[flash_.size() - kPage] : memory(at, kPage);
    for (std::uint32_t i = 0; i <= kRest; ++i) {
        const std::uint16_t word = i < kRest ? kNop : kBranchBack;
        std::memcpy(to + 2UL * i, &word, sizeof word);
    }
    set_register(UC_ARM_REG_PC, at | 1U);
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
    set_register(UC_ARM_REG_PC, word_at(vtor_ + exception * 4));

    amid_tick_[exception] += nested && active_.back().exception == kPendSv ? 1U : 0U;
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
    bool found = !facts_.late_stores;
    const std::uint32_t start = facts_.flash_start;
    for (std::uint32_t at = unbroken_from_ - start;
         !found && at + 4 <= block_ - start + block_size_; at += 2) {
        constexpr std::array<std::uint8_t, 4> kBarrier{0xBF, 0xF3, 0x4F, 0x8F};
        found = std::equal(kBarrier.begin(), kBarrier.end(), flash_.begin() + at);
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
    // Without the second bit the engine, of any core, begins a new context, and the flags of a comparison are gone.
    set_register(UC_ARM_REG_CONTROL, floats ? kFloatingPointActive | kSecureFloatingPoint : 0U);
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

}  // namespace cusp::cosim
