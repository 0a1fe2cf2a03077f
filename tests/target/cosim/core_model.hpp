// CoreModel: a Cortex-M4F or M33: Unicorn runs its instructions; its exceptions are made here.
//
// Unicorn has no exceptions of an M-profile core: frames are stacked and unstacked by hand, with the
// floating-point state. It is stopped at the start of a block only: a stop inside an IT block loses
// its state. Time is counted in instructions.
#pragma once

#include <functional>
#include <unicorn/unicorn.h>

#include "tests/target/cosim/model.hpp"

namespace cusp::cosim {

// The kinds of core, and the addresses around it.
struct CoreFacts {
    uc_cpu_arm cpu{UC_CPU_ARM_CORTEX_M4};
    std::uint32_t flash_start{0x08000000};
    // Start and size of each range of registers.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> registers;
    std::uint32_t id{0x410FC241};
    bool late_stores{true};    // erratum 838869 of the Cortex-M4
    std::uint32_t vectors{0};  // after a reset
    std::uint32_t circles{0};  // a page in which code that hangs goes round
};

// The interrupt controller and the system control block are its registers.
class CoreModel final : public Model {
public:
    struct Outside {
        std::function<std::uint32_t(std::uint32_t address, unsigned size)> read;
        std::function<void(std::uint32_t address, unsigned size, std::uint32_t value)> write;
        std::function<void(std::uint32_t address, unsigned size, std::uint32_t value)> store_flash;
        std::function<void()> events;  // what is due by now
        std::function<bool()> must_stop;
    };
    CoreModel(Circuit& circuit, CoreFacts facts, std::vector<std::uint8_t>& flash, Outside outside);
    ~CoreModel() override;

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;
    // From the vector table that the facts name.
    void reset() override;

    void set_instruction_time(Picoseconds time) { instruction_time_ = time; }
    // Runs until it must stop, sleeps, or an exception may be due. Precondition: !sleeping().
    void run();
    bool sleeping() const { return sleeping_; }
    bool reset_wanted() const { return reset_wanted_; }
    bool locked_up() const { return locked_up_; }
    // True if no exception is being served.
    bool in_thread() const { return active_.empty(); }
    // Code in thread mode runs in circles from now on, until a reset. Precondition: in_thread().
    void hang();
    // Takes the most urgent exception that may be taken now; wakes the core where one waits.
    void take_exception();
    std::uint64_t instructions() const { return instructions_; }
    std::uint32_t program_counter() const { return register_of(UC_ARM_REG_PC); }
    // Lowest address that the stack has reached.
    std::uint32_t lowest_stack() const { return lowest_stack_; }
    // Instructions from the entry of an exception to its end, the most so far and those of it alone.
    std::uint64_t longest(unsigned exception) const { return longest_[exception]; }
    // How often an exception came amid the servo tick, which is PendSV here.
    std::uint64_t amid_tick(unsigned exception) const { return amid_tick_[exception]; }

private:
    static void on_block(uc_engine*, std::uint64_t address, std::uint32_t size, void* self);
    static bool on_protected_store(
        uc_engine*, uc_mem_type, std::uint64_t address, int size, std::int64_t value, void* self);
    void begin_block(std::uint32_t address, std::uint32_t size);
    unsigned count_instructions(std::uint32_t address, std::uint32_t size);
    std::uint32_t register_of(int name) const;
    void set_register(int name, std::uint32_t value);
    std::uint8_t* memory(std::uint32_t address, std::uint32_t size);
    std::uint32_t word_at(std::uint32_t address);
    void map_memories();
    void map_registers();
    unsigned most_urgent() const;
    unsigned priority_of(unsigned exception) const;
    bool pending(unsigned exception) const;
    unsigned running_priority() const;
    void enter(unsigned exception);
    void leave(std::uint32_t exception_return);
    void check_barrier(unsigned exception);
    void lock_up(const std::string& why);

    uc_engine* engine_{nullptr};
    CoreFacts facts_;
    std::vector<std::uint8_t>& flash_;
    Outside outside_;
    // Memory that instructions come from, and those of its blocks: size << 16 | instructions.
    struct Code {
        std::uint32_t start;
        const std::vector<std::uint8_t>* bytes;
        std::vector<std::uint32_t> counts;
    };
    std::vector<Code> code_;
    Picoseconds instruction_time_{7738};
    std::uint64_t instructions_{0};
    std::uint32_t block_{0}, block_size_{0};
    std::uint32_t unbroken_from_{0};  // start of the block, or of that which it is the rest of
    bool stopped_{false}, sleeping_{false}, reset_wanted_{false}, locked_up_{false};
    std::uint32_t lowest_stack_{0xFFFFFFFF};

    struct Active {
        unsigned exception;
        std::uint64_t entered_at;
        std::uint64_t inside;  // instructions of exceptions that came between
    };
    std::vector<Active> active_;
    std::array<std::uint64_t, 128> longest_{}, amid_tick_{};
    std::array<bool, 96> enabled_{};
    std::array<std::uint8_t, 96> priorities_{};
    bool pend_sv_{false};
    bool timer_on_{false};  // the core's own, with its exception
    bool timer_pends_{false};
    bool masked_{false};  // an exception waits for PRIMASK
    std::uint32_t vtor_{0}, shpr3_{0}, shpr1_{0}, shpr2_{0}, cpacr_{0}, shcsr_{0}, ccr_{0x200};
};

}  // namespace cusp::cosim
