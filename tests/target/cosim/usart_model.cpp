// RM0090 section 30: data register, shift registers, flags and their interrupts and requests.
#include "tests/target/cosim/usart_model.hpp"

#include <algorithm>
#include <utility>

namespace cusp::cosim {
namespace {

constexpr std::uint32_t kFraming = 1U << 1U;
constexpr std::uint32_t kOverrun = 1U << 3U;
constexpr std::uint32_t kReceived = 1U << 5U;
constexpr std::uint32_t kComplete = 1U << 6U;
constexpr std::uint32_t kEmpty = 1U << 7U;
constexpr std::uint32_t kReceiver = 1U << 2U;
constexpr std::uint32_t kTransmitter = 1U << 3U;
constexpr std::uint32_t kPortOn = 1U << 13U;
constexpr unsigned kBitsPerByte = 10;

}  // namespace

UsartModel::UsartModel(Circuit& circuit, std::string name, Wiring wiring)
    : Model{circuit}, name_{std::move(name)}, wiring_{std::move(wiring)}
{
}

void UsartModel::reset()
{
    sr_ = 0xC0;
    brr_ = cr1_ = cr2_ = cr3_ = 0;
    holds_ = false;
    flags_read_ = false;
    stuck_ = false;
    shift_due_ = kNever;
    plan();
    update_line();
}

Picoseconds UsartModel::byte_time() const
{
    if (instant_) {
        return 0;
    }
    const std::uint32_t hz = std::max(1U, wiring_.bus_hz());
    return kSecond / hz * kBitsPerByte * std::max(1U, brr_);
}

// A receiver samples the tenth bit within half a bit where the rates differ by some 3 %.
bool UsartModel::rate_fits() const
{
    const double mine = static_cast<double>(wiring_.bus_hz()) / std::max(1U, brr_);
    const double ratio = mine / sender_baud_;
    return ratio > 0.97 && ratio < 1.03;
}

void UsartModel::set_instant(bool on)
{
    instant_ = on;
    circuit_.next_event = 0;
}

void UsartModel::send(const std::string& bytes)
{
    incoming_.insert(incoming_.end(), bytes.begin(), bytes.end());
    plan_receive();
}

void UsartModel::plan_receive()
{
    const bool blocked = instant_ && (sr_ & kReceived) != 0;
    if (incoming_.empty() || blocked) {
        receive_due_ = kNever;
    } else if (receive_due_ == kNever) {
        receive_due_ =
            circuit_.now + (instant_ ? 0 : kSecond * kBitsPerByte / std::max(1U, sender_baud_));
    }
    plan();
}

void UsartModel::plan()
{
    due_ = std::min(shift_due_, receive_due_);
    circuit_.next_event = 0;
}

void UsartModel::happen()
{
    if (receive_due_ <= circuit_.now) {
        receive_due_ = kNever;
        arrive();
        plan_receive();
    }
    if (shift_due_ <= circuit_.now) {
        shift_due_ = kNever;
        stuck_ = mute_;
        if (stuck_) {
            plan();
            update_line();
            return;
        }
        if (receiver_) {
            receiver_(rate_fits() ? static_cast<char>(shifted_) : '\xFF');
        }
        if (holds_) {
            holds_ = false;
            take_to_shift(held_);
        } else {
            sr_ |= kComplete;
        }
    }
    plan();
    update_line();
}

void UsartModel::set_mute(bool on)
{
    mute_ = on;
    if (!on && stuck_) {
        stuck_ = false;
        shift_due_ = circuit_.now;
    }
    plan();
}

void UsartModel::overrun()
{
    sr_ |= kOverrun;
    ++lost_;
    update_line();
}

void UsartModel::damage()
{
    received_ = 0;
    sr_ |= kReceived | kFraming;
    update_line();
    if ((cr3_ >> 6U & 1U) != 0) {
        static_cast<void>(wiring_.ask_receive_dma());
    }
}

void UsartModel::arrive()
{
    const std::uint8_t byte = incoming_.front();
    incoming_.pop_front();
    const bool listens = (cr1_ & (kPortOn | kReceiver)) == (kPortOn | kReceiver);
    if (!listens || !wiring_.pins_ready()) {
        ++lost_;
        return;
    }
    if ((sr_ & kReceived) != 0) {
        sr_ |= kOverrun;
        ++lost_;
        return;
    }
    received_ = rate_fits() ? byte : std::uint8_t{0xA5};
    sr_ |= kReceived | (rate_fits() ? 0U : kFraming);
    update_line();
    if ((cr3_ >> 6U & 1U) != 0) {
        static_cast<void>(wiring_.ask_receive_dma());
    }
}

void UsartModel::take_to_shift(std::uint8_t byte)
{
    if (!wiring_.pins_ready()) {
        circuit_.violate(name_ + ": sends without its pins");
    }
    shifted_ = byte;
    sr_ = (sr_ | kEmpty) & ~kComplete;
    shift_due_ = circuit_.now + byte_time();
    plan();
    ask_for_transmit();
}

void UsartModel::ask_for_transmit()
{
    const bool on = (cr1_ & (kPortOn | kTransmitter)) == (kPortOn | kTransmitter);
    if (!on || (cr3_ >> 7U & 1U) == 0 || asking_) {
        return;
    }
    asking_ = true;
    while ((sr_ & kEmpty) != 0 && wiring_.ask_transmit_dma()) {
    }
    asking_ = false;
}

std::uint32_t UsartModel::read(std::uint32_t offset)
{
    switch (offset) {
        case 0x00:
            flags_read_ = true;
            // A stream that was set up later finds the register empty.
            ask_for_transmit();
            return sr_;
        case 0x04:
            sr_ &= ~kReceived;
            if (flags_read_) {
                sr_ &= ~(kOverrun | kFraming);
                flags_read_ = false;
            }
            update_line();
            plan_receive();
            return received_;
        case 0x08:
            return brr_;
        case 0x0C:
            return cr1_;
        case 0x10:
            return cr2_;
        case 0x14:
            return cr3_;
        default:
            return 0;
    }
}

void UsartModel::write(std::uint32_t offset, std::uint32_t value)
{
    switch (offset) {
        case 0x00:
            sr_ &= value | ~(kReceived | kComplete);
            break;
        case 0x04:
            if ((cr1_ & (kPortOn | kTransmitter)) != (kPortOn | kTransmitter)) {
                circuit_.violate(name_ + ": a byte is sent while it is off");
                return;
            }
            if ((sr_ & kEmpty) == 0) {
                circuit_.violate(name_ + ": a byte is written over the one before");
            }
            if (shift_due_ == kNever && !stuck_) {
                take_to_shift(static_cast<std::uint8_t>(value));
            } else {
                holds_ = true;
                held_ = static_cast<std::uint8_t>(value);
                sr_ &= ~kEmpty;
            }
            break;
        case 0x08:
            if ((cr1_ & kPortOn) != 0) {
                circuit_.violate(name_ + ": its rate is set while it is on");
            }
            brr_ = value;
            break;
        case 0x0C:
            cr1_ = value;
            break;
        case 0x10:
            cr2_ = value;
            break;
        case 0x14:
            cr3_ = value;
            break;
        default:
            break;
    }
    ask_for_transmit();
    update_line();
}

void UsartModel::update_line()
{
    const bool receive = (cr1_ >> 5U & 1U) != 0 && (sr_ & (kReceived | kOverrun)) != 0;
    const bool empty = (cr1_ >> 7U & 1U) != 0 && (sr_ & kEmpty) != 0;
    const bool complete = (cr1_ >> 6U & 1U) != 0 && (sr_ & kComplete) != 0;
    const bool error = (cr3_ & 1U) != 0 && (sr_ & (kOverrun | kFraming)) != 0;
    circuit_.set_line(wiring_.interrupt,
                      (cr1_ & kPortOn) != 0 && (receive || empty || complete || error));
}

}  // namespace cusp::cosim
