// Section 12.1 of the data sheet.
#include "tests/target/cosim/rp2350/uart_model.hpp"

#include <algorithm>
#include <utility>

namespace cusp::cosim::rp2350 {
namespace {

// Interrupts.
constexpr std::uint32_t kReceived = 1U << 4U;
constexpr std::uint32_t kSent = 1U << 5U;
constexpr std::uint32_t kSilence = 1U << 6U;
constexpr std::uint32_t kFraming = 1U << 7U;
constexpr std::uint32_t kOverrun = 1U << 10U;
// Of an entry of the FIFO.
constexpr std::uint32_t kFramingOfEntry = 1U << 8U;
constexpr std::uint32_t kOverrunOfEntry = 1U << 11U;
constexpr unsigned kBitsOfByte = 10;
constexpr unsigned kBitsOfSilence = 32;

}  // namespace

UartModel::UartModel(Circuit& circuit, Wiring wiring) : Model{circuit}, wiring_{std::move(wiring)}
{
}

void UartModel::reset()
{
    ibrd_ = fbrd_ = lcr_ = imsc_ = raw_ = dmacr_ = errors_ = divisor_ = 0;
    cr_ = 0x300;
    ifls_ = 0x12;
    received_.clear();
    sent_.clear();
    shift_due_ = silent_at_ = kNever;
    stuck_ = false;
    update();
    plan();
}

// Words of a FIFO at which its interrupt comes.
std::size_t UartModel::trigger(unsigned field) const
{
    constexpr std::size_t kLevels[] = {4, 8, 16, 24, 28, 28, 28, 28};
    return depth() == 1 ? 1 : kLevels[field & 7U];
}

double UartModel::baud() const { return 4.0 * wiring_.clock_hz() / std::max(1U, divisor_); }

// A receiver samples the tenth bit within half a bit where the rates differ by some 3 %.
bool UartModel::rate_fits() const
{
    const double ratio = baud() / sender_baud_;
    return ratio > 0.97 && ratio < 1.03;
}

Picoseconds UartModel::bits(unsigned count) const
{
    return instant_ ? 0 : static_cast<Picoseconds>(static_cast<double>(kSecond) * count / baud());
}

void UartModel::set_instant(bool on)
{
    instant_ = on;
    circuit_.next_event = 0;
}

void UartModel::send(const std::string& bytes)
{
    incoming_.insert(incoming_.end(), bytes.begin(), bytes.end());
    plan_receive();
}

void UartModel::plan_receive()
{
    const bool blocked = instant_ && !received_.empty();
    if (incoming_.empty() || blocked) {
        receive_due_ = kNever;
    } else if (receive_due_ == kNever) {
        receive_due_ =
            circuit_.now + (instant_ ? 0 : kSecond * kBitsOfByte / std::max(1U, sender_baud_));
    }
    plan();
}

void UartModel::plan()
{
    due_ = std::min({shift_due_, receive_due_, silent_at_});
    circuit_.next_event = 0;
}

void UartModel::happen()
{
    if (receive_due_ <= circuit_.now) {
        receive_due_ = kNever;
        arrive();
        plan_receive();
    }
    if (silent_at_ <= circuit_.now) {
        silent_at_ = kNever;
        raw_ |= received_.empty() ? 0U : kSilence;
    }
    if (shift_due_ <= circuit_.now) {
        shift_due_ = kNever;
        stuck_ = mute_;
        if (!stuck_) {
            if (receiver_) {
                receiver_(rate_fits() ? static_cast<char>(shifted_) : '\xFF');
            }
            shift();
        }
    }
    update();
    plan();
}

void UartModel::set_mute(bool on)
{
    mute_ = on;
    if (!on && stuck_) {
        stuck_ = false;
        shift_due_ = circuit_.now;
    }
    plan();
}

void UartModel::overrun()
{
    ++lost_;
    raw_ |= kOverrun;
    errors_ |= kOverrunOfEntry >> 8U;
    update();
}

void UartModel::damage()
{
    raw_ |= kFraming;
    take(kFramingOfEntry);
    update();
    plan();
}

void UartModel::arrive()
{
    const std::uint8_t byte = incoming_.front();
    incoming_.pop_front();
    constexpr std::uint32_t kReceiverOn = 1U << 9U;
    if (!on() || (cr_ & kReceiverOn) == 0 || !wiring_.pins_ready()) {
        ++lost_;
        return;
    }
    if (received_.size() >= depth()) {
        overrun();
        return;
    }
    if (!rate_fits()) {
        raw_ |= kFraming;
    }
    take(rate_fits() ? byte : 0xA5U | kFramingOfEntry);
}

void UartModel::take(std::uint32_t entry)
{
    received_.push_back(entry);
    silent_at_ = circuit_.now + bits(kBitsOfSilence);
    if (received_.size() >= trigger(ifls_ >> 3U)) {
        raw_ |= kReceived;
    }
}

void UartModel::shift()
{
    constexpr std::uint32_t kTransmitterOn = 1U << 8U;
    if (sent_.empty() || !on() || (cr_ & kTransmitterOn) == 0 || stuck_ || shift_due_ != kNever) {
        return;
    }
    if (!wiring_.pins_ready()) {
        circuit_.violate("UART0: sends without its pins");
    }
    shifted_ = sent_.front();
    const std::size_t before = sent_.size();
    sent_.pop_front();
    const std::size_t at = depth() == 1 ? 0 : trigger(ifls_);
    // The interrupt comes where the level is passed, not while it is low.
    raw_ |= before > at && sent_.size() <= at ? kSent : 0U;
    shift_due_ = circuit_.now + bits(kBitsOfByte);
    plan();
}

std::uint32_t UartModel::take_entry()
{
    if (received_.empty()) {
        circuit_.violate("UART0: a byte is read that is not there");
        return 0;
    }
    const std::uint32_t entry = received_.front();
    received_.pop_front();
    if (received_.size() < trigger(ifls_ >> 3U)) {
        raw_ &= ~kReceived;
    }
    if (received_.empty()) {
        raw_ &= ~kSilence;
        silent_at_ = kNever;
    }
    const std::uint32_t overrun = (errors_ << 8U) & kOverrunOfEntry;
    errors_ &= ~(kOverrunOfEntry >> 8U);
    plan_receive();
    return entry | overrun;
}

std::uint32_t UartModel::read(std::uint32_t offset)
{
    switch (offset) {
        case 0x00: {
            const std::uint32_t entry = take_entry();
            update();
            return entry;
        }
        case 0x04:
            return errors_;
        case 0x18:
            return (shift_due_ != kNever || stuck_ ? 1U << 3U : 0U) |
                   (received_.empty() ? 1U << 4U : 0U) | (sent_.size() >= depth() ? 1U << 5U : 0U) |
                   (received_.size() >= depth() ? 1U << 6U : 0U) | (sent_.empty() ? 1U << 7U : 0U);
        case 0x24:
            return ibrd_;
        case 0x28:
            return fbrd_;
        case 0x2C:
            return lcr_;
        case 0x30:
            return cr_;
        case 0x34:
            return ifls_;
        case 0x38:
            return imsc_;
        case 0x3C:
            return raw_;
        case 0x40:
            return raw_ & imsc_;
        case 0x48:
            return dmacr_;
        default:
            circuit_.violate("UART0: a register is read that is not modelled, " +
                             hexadecimal(offset));
            return 0;
    }
}

void UartModel::write(std::uint32_t offset, std::uint32_t value)
{
    if (on() && (offset == 0x24 || offset == 0x28 || offset == 0x2C)) {
        circuit_.violate("UART0: its rate or its form is set while it is on");
    }
    switch (offset) {
        case 0x00:
            if (!on()) {
                circuit_.violate("UART0: a byte is sent while it is off");
            }
            if (sent_.size() >= depth()) {
                circuit_.violate("UART0: a byte is written over the one before");
                return;
            }
            sent_.push_back(static_cast<std::uint8_t>(value));
            if (sent_.size() > (depth() == 1 ? 0 : trigger(ifls_))) {
                raw_ &= ~kSent;
            }
            break;
        case 0x04:
            errors_ = 0;
            break;
        case 0x24:
            ibrd_ = value & 0xFFFFU;
            break;
        case 0x28:
            fbrd_ = value & 63U;
            break;
        case 0x2C:
            lcr_ = value;
            divisor_ = ibrd_ << 6U | fbrd_;
            if ((value & 0x6EU) != 0x60) {
                circuit_.violate("UART0: a form other than eight bits, no parity, one stop bit");
            }
            break;
        case 0x30:
            cr_ = value;
            break;
        case 0x34:
            ifls_ = value;
            break;
        case 0x38:
            imsc_ = value;
            break;
        case 0x44:
            raw_ &= ~value;
            break;
        case 0x48:
            dmacr_ = value;
            break;
        default:
            circuit_.violate("UART0: a register is written that is not modelled, " +
                             hexadecimal(offset));
    }
    shift();
    update();
    plan();
}

void UartModel::update()
{
    circuit_.set_line(wiring_.interrupt, (raw_ & imsc_) != 0);
    wiring_.requests_changed();
}

}  // namespace cusp::cosim::rp2350
