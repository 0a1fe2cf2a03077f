// PioMachine: one state machine of a PIO block, an instruction a tick (RP2350's data sheet, chapter 11).
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>

namespace cusp::cosim::rp2350 {

// The part of the block that a state machine reaches.
class PioBlock {
public:
    PioBlock() = default;
    PioBlock(const PioBlock&) = delete;
    PioBlock& operator=(const PioBlock&) = delete;
    virtual ~PioBlock() = default;

    virtual std::uint32_t pins() const = 0;
    virtual void write_pins(std::uint32_t mask, std::uint32_t levels) = 0;
    virtual void write_directions(std::uint32_t mask, std::uint32_t directions) = 0;
    // A flag that is written changes in the next cycle.
    virtual bool flag(unsigned number) const = 0;
    virtual void write_flag(unsigned number, bool on) = 0;
    virtual std::uint16_t instruction(unsigned address) const = 0;
    virtual void fifo_changed() = 0;
    virtual void forbid(const std::string& what) = 0;
};

class PioMachine {
public:
    PioMachine(PioBlock& block, unsigned number) : block_{block}, number_{number} { reset(); }

    void reset();
    // CTRL_SM_RESTART: registers and program counter stay.
    void restart();
    // Executes an instruction. Returns the ticks until the next, or 0 while it waits for something.
    std::uint32_t tick();
    // SMx_INSTR: at once, whatever the divider does.
    void force(std::uint16_t code);
    // Between two instructions, while a delay lasts or another instruction waits: an OSR that is empty is filled.
    void refill();

    // Words to and from the bus. False: no room, or nothing there.
    bool push_sent(std::uint32_t word);
    bool pop_received(std::uint32_t& word);
    std::size_t sent() const { return sent_.size(); }
    std::size_t received() const { return received_.size(); }
    bool sent_full() const { return sent_.size() >= sent_depth(); }
    bool received_full() const { return received_.size() >= received_depth(); }
    std::uint32_t& stored(unsigned place) { return stored_.at(place); }

    std::uint32_t clkdiv{0}, execctrl{0}, pinctrl{0};
    void write_shiftctrl(std::uint32_t value);
    std::uint32_t shiftctrl() const { return shiftctrl_; }
    unsigned address() const { return pc_; }
    std::uint16_t current() const { return latched_ ? latch_ : block_.instruction(pc_); }
    bool latched() const { return latched_; }
    bool waits() const { return waits_; }
    // Sticky flags for FDEBUG.
    bool starved{false}, choked{false};

private:
    bool perform(std::uint16_t code);
    bool jump(std::uint16_t code);
    bool wait(std::uint16_t code);
    bool shift_in(std::uint16_t code);
    bool shift_out(std::uint16_t code);
    bool push(std::uint16_t code);
    bool pull(std::uint16_t code);
    bool move_stored(std::uint16_t code);
    bool move(std::uint16_t code);
    bool raise(std::uint16_t code);
    bool set(std::uint16_t code);
    void side_set(std::uint16_t code);
    std::uint32_t delay(std::uint16_t code) const;
    void deliver(unsigned destination, std::uint32_t value, unsigned count, bool by_move);
    void go_to(unsigned address);
    void advance();
    void take_from_fifo();
    bool give_to_fifo();
    std::uint32_t input() const;
    std::uint32_t status() const;
    std::uint32_t operand(unsigned source);
    unsigned flag_index(std::uint16_t code);
    void write_mapped(bool directions, unsigned base, unsigned count, std::uint32_t value);
    void forbid(const std::string& what);
    std::size_t sent_depth() const;
    std::size_t received_depth() const;
    bool stores() const { return (shiftctrl_ >> 14U & 3U) != 0; }
    bool autopull() const { return (shiftctrl_ >> 17U & 1U) != 0; }
    bool autopush() const { return (shiftctrl_ >> 16U & 1U) != 0; }
    static unsigned count_of(std::uint32_t field) { return field == 0 ? 32U : field; }
    unsigned pull_threshold() const { return count_of(shiftctrl_ >> 25U & 31U); }
    unsigned push_threshold() const { return count_of(shiftctrl_ >> 20U & 31U); }

    PioBlock& block_;
    unsigned number_;
    std::uint32_t shiftctrl_{0};
    std::uint32_t x_{0}, y_{0}, isr_{0}, osr_{0};
    unsigned isr_count_{0}, osr_count_{32};
    unsigned pc_{0};
    bool latched_{false}, jumped_{false}, undelayed_{false}, waits_{false}, raised_{false};
    std::uint16_t latch_{0};
    std::deque<std::uint32_t> sent_, received_;
    std::array<std::uint32_t, 4> stored_{};
};

}  // namespace cusp::cosim::rp2350
