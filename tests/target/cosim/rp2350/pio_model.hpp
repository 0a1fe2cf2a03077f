// PioModel: a PIO block: four state machines, their clock dividers, FIFOs, flags and interrupts, to the cycle.
#pragma once

#include <functional>

#include "tests/target/cosim/model.hpp"
#include "tests/target/cosim/rp2350/pio_machine.hpp"

namespace cusp::cosim::rp2350 {

class PioModel final : public Model, private PioBlock {
public:
    static constexpr unsigned kMachines = 4;
    struct Wiring {
        std::function<std::uint32_t()> clock_hz;
        std::function<std::uint32_t()> levels;   // of the pins
        std::function<void()> outputs_changed;   // out() and directions()
        std::function<void()> requests_changed;  // room or words in a FIFO
        unsigned interrupt;                      // the first of both
    };
    PioModel(Circuit& circuit, std::string name, Wiring wiring);

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;
    void reset() override;
    void happen() override;

    std::uint32_t out() const { return out_; }
    std::uint32_t directions() const { return directions_; }
    // Requests for DMA: a FIFO has room for a word, or has one.
    bool wants(unsigned machine) const { return !machines_[machine].sent_full(); }
    bool offers(unsigned machine) const { return machines_[machine].received() != 0; }
    // The level of an input pin, or the rate of the clock, has changed.
    void inputs_changed();
    void clock_changed();

private:
    // Ticks of a machine come at the cycles start + tick * divisor, rounded down.
    struct Pace {
        std::int64_t start{0};
        std::int64_t tick{0};  // of the next instruction
        bool on{false};
        bool asleep{false};
    };
    std::uint32_t pins() const override;
    void write_pins(std::uint32_t mask, std::uint32_t levels) override;
    void write_directions(std::uint32_t mask, std::uint32_t directions) override;
    bool flag(unsigned number) const override { return (flags_ >> number & 1U) != 0; }
    void write_flag(unsigned number, bool on) override;
    std::uint16_t instruction(unsigned address) const override { return memory_[address]; }
    void fifo_changed() override { fifos_changed_ = true; }
    void forbid(const std::string& what) override { circuit_.violate(name_ + ", " + what); }

    std::int64_t cycle_now() const;
    Picoseconds time_of(std::int64_t cycle) const;
    static std::int64_t divisor(std::uint32_t clkdiv);
    std::int64_t cycle_of_tick(unsigned machine) const;
    std::int64_t next_tick(unsigned machine, std::int64_t after) const;
    void control(std::uint32_t value);
    void enable(unsigned machine, bool on);
    void wake(std::int64_t after);
    void send(unsigned machine, std::uint32_t word);
    std::uint32_t receive(unsigned machine);
    std::uint32_t read_machine(std::uint32_t offset);
    void write_machine(std::uint32_t offset, std::uint32_t value);
    std::uint32_t raw_interrupts() const;
    std::uint32_t levels_of_fifos() const;
    std::uint32_t states_of_fifos() const;
    std::uint32_t debug() const;
    void settle();
    void update_lines();
    void plan();

    std::string name_;
    Wiring wiring_;
    std::array<PioMachine, kMachines> machines_;
    std::array<Pace, kMachines> paces_{};
    std::array<std::uint16_t, 32> memory_{};
    std::uint32_t out_{0}, directions_{0}, flags_{0}, bypass_{0}, overruns_{0};
    std::uint32_t flags_up_{0}, flags_down_{0};
    std::array<std::uint32_t, 2> enabled_{}, forced_{};
    bool fifos_changed_{false}, outputs_changed_{false}, interrupts_changed_{false};
    // The clock since its last change.
    std::uint32_t hz_{1};
    Picoseconds since_{0};
    std::int64_t cycle_since_{0};
    // Levels that went through the synchronisers, and those on their way.
    struct Seen {
        std::int64_t cycle;
        std::uint32_t levels;
    };
    mutable std::deque<Seen> on_their_way_;
    mutable std::uint32_t synchronised_{0};
    std::int64_t cycle_{0};  // that is being executed
};

}  // namespace cusp::cosim::rp2350
