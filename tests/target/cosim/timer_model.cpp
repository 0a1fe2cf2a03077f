// RM0090 sections 17 and 18, as far as a pulse stream, a spindle and a measured crystal need.
#include "tests/target/cosim/timer_model.hpp"

#include <algorithm>
#include <utility>

namespace cusp::cosim {
namespace {

constexpr std::uint32_t kEnable = 1;
constexpr std::uint32_t kOnePulse = 1U << 3U;
constexpr std::uint32_t kUpdateFlag = 1;
constexpr std::uint32_t kUpdateRequest = 1U << 8U;
constexpr std::uint32_t kCompareRequests = 0xFU << 9U;
__extension__ using Wide = unsigned __int128;

}  // namespace

TimerModel::TimerModel(Circuit& circuit, std::string name, Wiring wiring)
    : Model{circuit}, name_{std::move(name)}, wiring_{std::move(wiring)}
{
    TimerModel::reset();
}

void TimerModel::reset()
{
    registers_ = {};
    registers_[kArr] = wiring_.wide ? 0xFFFFFFFF : 0xFFFF;
    prescaler_ = 0;
    count_ = 0;
    frozen_ = false;
    running_ = false;
    capture_due_ = kNever;
    plan();
    update_line();
}

bool TimerModel::counts() const
{
    if (!enabled() || frozen_) {
        return false;
    }
    if (!gated()) {
        return true;
    }
    const TimerModel* const gate = wiring_.triggers[registers_[kSmcr] >> 4U & 3U];
    // TRGO of the gate must be its enable: MMS = 1.
    return gate != nullptr && (gate->registers_[kCr2] >> 4U & 7U) == 1 && gate->enabled();
}

Picoseconds TimerModel::time_of(std::uint64_t counts) const
{
    const auto cycles = static_cast<Wide>(counts) * (prescaler_ + 1U);
    return static_cast<Picoseconds>(cycles * static_cast<std::uint64_t>(kSecond) / hz_);
}

std::uint64_t TimerModel::counted() const
{
    if (!running_) {
        return count_;
    }
    const auto passed = static_cast<Wide>(circuit_.now - since_) * hz_ /
                        static_cast<std::uint64_t>(kSecond) / (prescaler_ + 1U);
    return count_ + static_cast<std::uint64_t>(passed);
}

void TimerModel::settle()
{
    const std::uint64_t period = std::uint64_t{top()} + 1;
    if (running_) {
        const std::uint64_t whole = counted();
        since_ += time_of(whole - count_);
        count_ = whole >= period && due_ == kNever ? whole % period : whole;
        if (count_ >= period) {
            count_ = period - 1;  // its event is due at this very moment
        }
    }
}

void TimerModel::look_again()
{
    const std::uint32_t hz = wiring_.clock_hz();
    if (hz == hz_ && counts() == running_) {
        return;
    }
    settle();
    hz_ = hz;
    plan();
}

void TimerModel::freeze(bool on)
{
    frozen_ = on;
    look_again();
}

void TimerModel::plan()
{
    hz_ = std::max(1U, wiring_.clock_hz());
    const bool was = running_;
    running_ = counts();
    if (running_ && !was) {
        since_ = circuit_.now;
    }
    plan_capture();
    due_ = capture_due_;
    circuit_.next_event = 0;
    if (!running_) {
        return;
    }
    const std::uint32_t wanted = registers_[kDier];
    std::uint64_t next = 0;
    const auto consider = [&](std::uint64_t at) {
        next = next == 0 || at < next ? at : next;
    };
    const std::uint32_t at_update =
        kUpdateRequest | 1U | (requests_at_update() ? kCompareRequests : 0U);
    if ((wanted & at_update) != 0 || (registers_[kCr1] & kOnePulse) != 0) {
        consider(std::uint64_t{top()} + 1);
    }
    for (unsigned channel = 0; channel < 4; ++channel) {
        if ((wanted >> (9 + channel) & 1U) != 0 && !requests_at_update()) {
            const std::uint64_t at = registers_[kCcr1 + channel];
            consider(at > count_ ? at : at + top() + 1);
        }
    }
    if (next != 0) {
        const Picoseconds at = since_ + time_of(next - count_);
        due_count_ = next;
        due_ = std::min(due_, at);
    }
}

void TimerModel::plan_capture()
{
    const bool wanted = running_ && (registers_[kCcer] & 1U) != 0 &&
                        (registers_[kCcmr1] & 3U) == 1 && (registers_[kOr] & 3U) == 2 &&
                        wiring_.captured_hz && wiring_.captured_hz() != 0;
    if (!wanted) {
        capture_due_ = kNever;
    } else if (capture_due_ == kNever) {
        const unsigned each = 1U << (registers_[kCcmr1] >> 2U & 3U);
        capture_due_ = circuit_.now + kSecond * each / wiring_.captured_hz();
    }
}

void TimerModel::happen()
{
    if (capture_due_ <= circuit_.now) {
        registers_[kCcr1] = static_cast<std::uint32_t>(counted() % (std::uint64_t{top()} + 1));
        registers_[kSr] |= (registers_[kSr] & 2U) != 0 ? 1U << 9U : 2U;
        const unsigned each = 1U << (registers_[kCcmr1] >> 2U & 3U);
        capture_due_ += kSecond * each / std::max(1U, wiring_.captured_hz());
        const Picoseconds counter_due = since_ + time_of(due_count_ - count_);
        due_ = due_count_ != 0 && running_ ? std::min(capture_due_, counter_due) : capture_due_;
        circuit_.next_event = 0;
        return;
    }
    since_ = due_;
    count_ = due_count_;
    const std::uint64_t period = std::uint64_t{top()} + 1;
    if (count_ >= period) {
        count_ -= period;
        if (count_ == 0) {
            update_event();
        }
    }
    compare_events(static_cast<std::uint32_t>(count_));
    plan();
}

void TimerModel::update_event()
{
    prescaler_ = registers_[kPsc];
    registers_[kSr] |= kUpdateFlag;
    if ((registers_[kCr1] & kOnePulse) != 0) {
        registers_[kCr1] &= ~kEnable;
        if (listener_ != nullptr) {
            listener_->look_again();
        }
    }
    if ((registers_[kDier] & kUpdateRequest) != 0 && wiring_.dma_request) {
        wiring_.dma_request(Event::kUpdate);
    }
    for (unsigned channel = 0; channel < 4 && requests_at_update(); ++channel) {
        if ((registers_[kDier] >> (9 + channel) & 1U) != 0 && wiring_.dma_request) {
            wiring_.dma_request(static_cast<Event>(1 + channel));
        }
    }
    update_line();
}

void TimerModel::compare_events(std::uint32_t at)
{
    for (unsigned channel = 0; channel < 4; ++channel) {
        const bool asks = (registers_[kDier] >> (9 + channel) & 1U) != 0 && !requests_at_update();
        if (asks && registers_[kCcr1 + channel] == at && wiring_.dma_request) {
            wiring_.dma_request(static_cast<Event>(1 + channel));
        }
    }
}

std::uint32_t TimerModel::read(std::uint32_t offset)
{
    const unsigned index = offset / 4;
    if (index >= kRegisterCount) {
        return 0;
    }
    if (index == kCnt) {
        return static_cast<std::uint32_t>(counted() % (std::uint64_t{top()} + 1));
    }
    if (index == kCcr1 && (registers_[kCcmr1] & 3U) == 1) {
        registers_[kSr] &= ~2U;  // reading the capture clears its flag
    }
    return registers_[index];
}

void TimerModel::write(std::uint32_t offset, std::uint32_t value)
{
    const unsigned index = offset / 4;
    if (index >= kRegisterCount) {
        circuit_.violate(name_ + ": write to a register that it does not have");
        return;
    }
    settle();
    switch (index) {
        case kSr:
            registers_[kSr] &= value;
            update_line();
            return;
        case kEgr:
            if ((value & 1U) != 0) {
                count_ = 0;
                since_ = circuit_.now;
                prescaler_ = registers_[kPsc];
                if ((registers_[kCr1] & 4U) == 0) {
                    registers_[kSr] |= kUpdateFlag;
                }
            }
            break;
        case kCnt:
            count_ = value;
            since_ = circuit_.now;
            break;
        default:
            registers_[index] = value;
    }
    if (index >= kCcr1 && index <= kCcr4) {
        duty_changes_.push_back({circuit_.now, index - kCcr1, duty_ppm(index - kCcr1)});
    }
    plan();
    update_line();
    if (index == kCr1 && listener_ != nullptr) {
        listener_->look_again();
    }
}

void TimerModel::update_line()
{
    if (wiring_.interrupt >= 0) {
        circuit_.set_line(static_cast<unsigned>(wiring_.interrupt),
                          (registers_[kSr] & registers_[kDier] & 0x1FU) != 0);
    }
}

}  // namespace cusp::cosim
