// A state machine's ticks, and its instructions but for those that move data: sections 11.4 and 11.5.
#include "tests/target/cosim/rp2350/pio_machine.hpp"

#include "tests/target/cosim/rp2350/pio_bits.hpp"

namespace cusp::cosim::rp2350 {
void PioMachine::reset()
{
    clkdiv = 0x00010000;
    execctrl = 0x0001F000;
    shiftctrl_ = 0x000C0000;
    pinctrl = 0x14000000;
    x_ = y_ = osr_ = 0;
    pc_ = 0;
    sent_.clear();
    received_.clear();
    stored_ = {};
    starved = choked = false;
    restart();
}

void PioMachine::restart()
{
    isr_ = 0;
    isr_count_ = 0;
    osr_count_ = kWord;
    latched_ = waits_ = raised_ = false;
}

void PioMachine::forbid(const std::string& what)
{
    block_.forbid("state machine " + std::to_string(number_) + ": " + what);
}

void PioMachine::write_shiftctrl(std::uint32_t value)
{
    constexpr std::uint32_t kJoins = 3U << 30U | 3U << 14U;
    if (((value ^ shiftctrl_) & kJoins) != 0) {
        sent_.clear();
        received_.clear();
    }
    shiftctrl_ = value;
    if (stores() && autopush()) {
        forbid("autopush with a FIFO that is storage");
    }
}

std::size_t PioMachine::sent_depth() const
{
    return (shiftctrl_ >> 31U) != 0 ? 0 : (shiftctrl_ >> 30U & 1U) != 0 ? 8 : 4;
}

std::size_t PioMachine::received_depth() const
{
    return (shiftctrl_ >> 30U & 1U) != 0 || stores() ? 0 : (shiftctrl_ >> 31U) != 0 ? 8 : 4;
}

bool PioMachine::push_sent(std::uint32_t word)
{
    if (sent_full()) {
        return false;
    }
    sent_.push_back(word);
    return true;
}

bool PioMachine::pop_received(std::uint32_t& word)
{
    if (received_.empty()) {
        return false;
    }
    word = received_.front();
    received_.pop_front();
    return true;
}

std::uint32_t PioMachine::tick()
{
    const bool from_latch = latched_;
    const std::uint16_t code = current();
    latched_ = false;
    jumped_ = undelayed_ = waits_ = false;
    side_set(code);
    const bool done = perform(code);
    if (code >> 13U != 3) {
        refill();
    }
    if (!done) {
        latched_ = from_latch;
        latch_ = code;
        return waits_ ? 0 : 1;
    }
    if (!from_latch && !jumped_) {
        advance();
    }
    return 1 + (undelayed_ ? 0 : delay(code));
}

void PioMachine::force(std::uint16_t code)
{
    jumped_ = waits_ = false;
    side_set(code);
    if (!perform(code)) {
        forbid("a forced instruction has to wait");
    }
}

void PioMachine::advance()
{
    const unsigned top = execctrl >> 12U & 31U;
    pc_ = pc_ == top ? execctrl >> 7U & 31U : (pc_ + 1) & 31U;
}

void PioMachine::go_to(unsigned address)
{
    pc_ = address & 31U;
    jumped_ = true;
}

std::uint32_t PioMachine::delay(std::uint16_t code) const
{
    const unsigned side = pinctrl >> 29U;
    return side >= 5 ? 0 : code >> 8U & low_bits(5 - side);
}

void PioMachine::side_set(std::uint16_t code)
{
    const unsigned bits = pinctrl >> 29U;
    if (bits > 5) {
        forbid("side-set of more than five bits");
        return;
    }
    const bool optional = (execctrl >> 30U & 1U) != 0;
    const std::uint32_t field = code >> 8U & 31U;
    if (bits == 0 || (optional && field >> 4U == 0)) {
        return;
    }
    const unsigned count = bits - (optional ? 1 : 0);
    write_mapped((execctrl >> 29U & 1U) != 0, pinctrl >> 10U & 31U, count,
                 field >> (5 - bits) & low_bits(count));
}

void PioMachine::write_mapped(bool directions, unsigned base, unsigned count, std::uint32_t value)
{
    const std::uint32_t mask = rotated_left(low_bits(count), base);
    const std::uint32_t levels = rotated_left(value & low_bits(count), base);
    if (directions) {
        block_.write_directions(mask, levels);
    } else {
        block_.write_pins(mask, levels);
    }
}

bool PioMachine::perform(std::uint16_t code)
{
    switch (code >> 13U) {
        case 0:
            return jump(code);
        case 1:
            return wait(code);
        case 2:
            return shift_in(code);
        case 3:
            return shift_out(code);
        case 4:
            return (code >> 4U & 1U) != 0   ? move_stored(code)
                   : (code >> 7U & 1U) != 0 ? pull(code)
                                            : push(code);
        case 5:
            return move(code);
        case 6:
            return raise(code);
        default:
            return set(code);
    }
}

bool PioMachine::jump(std::uint16_t code)
{
    bool taken = true;
    switch (code >> 5U & 7U) {
        case 0:
            break;
        case 1:
            taken = x_ == 0;
            break;
        case 2:
            taken = x_-- != 0;
            break;
        case 3:
            taken = y_ == 0;
            break;
        case 4:
            taken = y_-- != 0;
            break;
        case 5:
            taken = x_ != y_;
            break;
        case 6:
            taken = (block_.pins() >> (execctrl >> 24U & 31U) & 1U) != 0;
            break;
        default:
            taken = osr_count_ < pull_threshold();
    }
    if (taken) {
        go_to(code & 31U);
    }
    return true;
}

unsigned PioMachine::flag_index(std::uint16_t code)
{
    const unsigned index = code & 7U;
    switch (code >> 3U & 3U) {
        case 0:
            return index;
        case 2:
            return (index & 4U) | ((index + number_) & 3U);
        default:
            forbid("flags of another block are not modelled");
            return index;
    }
}

bool PioMachine::wait(std::uint16_t code)
{
    const bool wanted = (code >> 7U & 1U) != 0;
    const unsigned index = code & 31U;
    bool level = false;
    switch (code >> 5U & 3U) {
        case 0:
            level = (block_.pins() >> index & 1U) != 0;
            break;
        case 1:
            level = (block_.pins() >> ((index + (pinctrl >> 15U & 31U)) & 31U) & 1U) != 0;
            break;
        case 2: {
            const unsigned flag = flag_index(code);
            level = block_.flag(flag);
            if (level && wanted) {
                block_.write_flag(flag, false);
            }
            break;
        }
        default:
            if (index > 3) {
                forbid("WAIT for the fourth pin behind JMP_PIN, or a later one");
            }
            level = (block_.pins() >> ((index + (execctrl >> 24U & 31U)) & 31U) & 1U) != 0;
    }
    waits_ = level != wanted;
    return !waits_;
}

bool PioMachine::raise(std::uint16_t code)
{
    if ((code >> 7U & 1U) != 0) {
        forbid("IRQ of an encoding that is reserved");
    }
    const unsigned flag = flag_index(code);
    if ((code >> 6U & 1U) != 0) {
        block_.write_flag(flag, false);
        return true;
    }
    if (!raised_) {
        block_.write_flag(flag, true);
        raised_ = (code >> 5U & 1U) != 0;
        return !raised_;
    }
    waits_ = block_.flag(flag);
    raised_ = waits_;
    return !waits_;
}

bool PioMachine::set(std::uint16_t code)
{
    const unsigned destination = code >> 5U & 7U;
    const std::uint32_t value = code & 31U;
    switch (destination) {
        case 0:
        case 4:
            write_mapped(destination == 4, pinctrl >> 5U & 31U, pinctrl >> 26U & 7U, value);
            break;
        case 1:
            x_ = value;
            break;
        case 2:
            y_ = value;
            break;
        default:
            forbid("SET of a destination that is reserved");
    }
    return true;
}

}  // namespace cusp::cosim::rp2350
