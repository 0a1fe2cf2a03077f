// Instructions of a state machine that move data: shift registers, FIFOs, scratch registers.
#include <algorithm>

#include "tests/target/cosim/rp2350/pio_bits.hpp"
#include "tests/target/cosim/rp2350/pio_machine.hpp"

namespace cusp::cosim::rp2350 {
namespace {

// Of OUT and, but for places 3, 4 and 7, of MOV.
enum Destination : unsigned {
    kToPins,
    kToX,
    kToY,
    kToNull,
    kToDirections,
    kToCounter,
    kToIsr,
    kToExecute
};

std::uint32_t reversed(std::uint32_t value)
{
    std::uint32_t result = 0;
    for (unsigned i = 0; i < kWord; ++i) {
        result |= (value >> i & 1U) << (kWord - 1 - i);
    }
    return result;
}

}  // namespace

std::uint32_t PioMachine::input() const
{
    const unsigned base = pinctrl >> 15U & 31U;
    return rotated_left(block_.pins(), (kWord - base) & 31U) & low_bits(count_of(shiftctrl_ & 31U));
}

bool PioMachine::give_to_fifo()
{
    if (received_full()) {
        choked = true;
        return false;
    }
    received_.push_back(isr_);
    isr_ = 0;
    isr_count_ = 0;
    block_.fifo_changed();
    return true;
}

bool PioMachine::shift_in(std::uint16_t code)
{
    const unsigned count = count_of(code & 31U);
    if (autopush() && isr_count_ >= push_threshold()) {
        // The push of the instruction before still waits.
        waits_ = !give_to_fifo();
        return !waits_;
    }
    const unsigned source = code >> 5U & 7U;
    if (source == 4 || source == 5) {
        forbid("IN from a source that is reserved");
    }
    const std::uint32_t value = operand(source) & low_bits(count);
    const bool right = (shiftctrl_ >> 18U & 1U) != 0;
    if (count == kWord) {
        isr_ = value;
    } else {
        isr_ = right ? isr_ >> count | value << (kWord - count) : isr_ << count | value;
    }
    isr_count_ = std::min(kWord, isr_count_ + count);
    if (autopush() && isr_count_ >= push_threshold()) {
        waits_ = !give_to_fifo();
        return !waits_;
    }
    return true;
}

void PioMachine::take_from_fifo()
{
    osr_ = sent_.front();
    sent_.pop_front();
    osr_count_ = 0;
    block_.fifo_changed();
}

void PioMachine::refill()
{
    if (autopull() && osr_count_ >= pull_threshold() && !sent_.empty()) {
        take_from_fifo();
    }
}

bool PioMachine::shift_out(std::uint16_t code)
{
    if (autopull() && osr_count_ >= pull_threshold()) {
        if (sent_.empty()) {
            starved = true;
            waits_ = true;
        } else {
            take_from_fifo();
        }
        return false;
    }
    const unsigned count = count_of(code & 31U);
    const bool right = (shiftctrl_ >> 19U & 1U) != 0;
    const std::uint32_t value =
        right || count == kWord ? osr_ & low_bits(count) : osr_ >> (kWord - count);
    osr_ = count == kWord ? 0 : right ? osr_ >> count : osr_ << count;
    osr_count_ = std::min(kWord, osr_count_ + count);
    refill();
    const unsigned destination = code >> 5U & 7U;
    deliver(destination, value, count, false);
    return true;
}

void PioMachine::deliver(unsigned destination, std::uint32_t value, unsigned count, bool by_move)
{
    const bool gated = !by_move && (execctrl >> 18U & 1U) != 0;
    const bool enabled = !gated || (value >> (execctrl >> 19U & 31U) & 1U) != 0;
    switch (destination) {
        case kToPins:
        case kToDirections:
            if (enabled) {
                write_mapped(destination == kToDirections, pinctrl & 31U, pinctrl >> 20U & 63U,
                             value);
            }
            break;
        case kToX:
            x_ = value;
            break;
        case kToY:
            y_ = value;
            break;
        case kToCounter:
            go_to(value);
            break;
        case kToIsr:
            isr_ = value;
            isr_count_ = by_move ? 0 : count;
            break;
        case kToExecute:
            latched_ = true;
            latch_ = static_cast<std::uint16_t>(value);
            undelayed_ = true;
            break;
        default:
            break;
    }
}

bool PioMachine::push(std::uint16_t code)
{
    if ((code & 15U) != 0) {
        forbid("PUSH of an encoding that is reserved");
    }
    const bool if_full = (code >> 6U & 1U) != 0;
    const bool blocks = (code >> 5U & 1U) != 0;
    if (if_full && isr_count_ < push_threshold()) {
        return true;
    }
    if (!give_to_fifo()) {
        if (blocks) {
            waits_ = true;
            return false;
        }
        isr_ = 0;
        isr_count_ = 0;
    }
    return true;
}

bool PioMachine::pull(std::uint16_t code)
{
    if ((code & 15U) != 0) {
        forbid("PULL of an encoding that is reserved");
    }
    const bool if_empty = (code >> 6U & 1U) != 0;
    const bool blocks = (code >> 5U & 1U) != 0;
    if ((if_empty || autopull()) && osr_count_ < pull_threshold()) {
        return true;
    }
    if (!sent_.empty()) {
        take_from_fifo();
        return true;
    }
    starved = true;
    if (blocks) {
        waits_ = true;
        return false;
    }
    osr_ = x_;
    osr_count_ = 0;
    return true;
}

bool PioMachine::move_stored(std::uint16_t code)
{
    const bool gets = (code >> 7U & 1U) != 0;
    const bool immediate = (code >> 3U & 1U) != 0;
    if ((shiftctrl_ >> (gets ? 14U : 15U) & 1U) == 0 || (code >> 5U & 3U) != 0 ||
        (!immediate && (code & 7U) != 0)) {
        forbid("MOV to or from the RX FIFO that is undefined");
    }
    std::uint32_t& place = stored_[(immediate ? code : y_) & 3U];
    if (gets) {
        osr_ = place;
        osr_count_ = 0;
    } else {
        place = isr_;
        isr_ = 0;
        isr_count_ = 0;
    }
    return true;
}

std::uint32_t PioMachine::status() const
{
    const unsigned level = execctrl & 31U;
    switch (execctrl >> 5U & 3U) {
        case 0:
            return sent_.size() < level ? ~0U : 0U;
        case 1:
            return received_.size() < level ? ~0U : 0U;
        default:
            return block_.flag(level & 7U) ? ~0U : 0U;
    }
}

// As IN and MOV number them.
std::uint32_t PioMachine::operand(unsigned source)
{
    switch (source) {
        case 0:
            return input();
        case 1:
            return x_;
        case 2:
            return y_;
        case 5:
            return status();
        case 6:
            return isr_;
        case 7:
            if (autopull()) {
                forbid("the OSR is read, though autopull may fill it");
            }
            return osr_;
        default:
            return 0;
    }
}

bool PioMachine::move(std::uint16_t code)
{
    const unsigned operation = code >> 3U & 3U;
    const unsigned source = code & 7U;
    if (operation == 3 || source == 4) {
        forbid("MOV of an encoding that is reserved");
    }
    std::uint32_t value = operand(source);
    value = operation == 1 ? ~value : operation == 2 ? reversed(value) : value;
    constexpr unsigned kOsrOfMove = 7;
    const unsigned destination = code >> 5U & 7U;
    if (destination == kOsrOfMove) {
        osr_ = value;
        osr_count_ = 0;
        return true;
    }
    deliver(destination == 3   ? unsigned{kToDirections}
            : destination == 4 ? unsigned{kToExecute}
                               : destination,
            value, kWord, true);
    return true;
}

}  // namespace cusp::cosim::rp2350
