// TimerModel: a timer that counts up: updates, compares and a capture, with their DMA requests; a gate.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "tests/target/cosim/model.hpp"

namespace cusp::cosim {

class TimerModel final : public Model {
public:
    enum class Event : std::uint8_t { kUpdate, kCompare1, kCompare2, kCompare3, kCompare4 };
    struct Wiring {
        std::function<std::uint32_t()> clock_hz;
        std::function<void(Event)> dma_request;
        std::function<std::uint32_t()> captured_hz;  // of what channel 1 can capture; 0: nothing
        std::array<TimerModel*, 4> triggers{};       // whose output is ITR0 to ITR3
        int interrupt{-1};
        bool wide{false};
    };
    TimerModel(Circuit& circuit, std::string name, Wiring wiring);

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;
    void reset() override;
    void happen() override;

    // The rates of the clock tree, or another timer's gate, may have changed.
    void look_again();
    // A debugger holds the core: DBGMCU stops this timer.
    void freeze(bool on);
    bool enabled() const { return (registers_[kCr1] & 1U) != 0; }
    void set_listener(TimerModel* listener) { listener_ = listener; }
    // Parts of a million that the output of a channel, 0 to 3, is high; and pulses a second.
    std::uint32_t duty_ppm(unsigned channel) const
    {
        return static_cast<std::uint32_t>(std::uint64_t{registers_[kCcr1 + channel]} * 1000000 /
                                          (std::uint64_t{top()} + 1));
    }
    // Each write of a compare: when, channel 0 to 3, and the duty that it gives.
    struct DutyChange {
        Picoseconds time;
        unsigned channel;
        std::uint32_t ppm;
    };
    std::vector<DutyChange> take_duty_changes() { return std::exchange(duty_changes_, {}); }
    std::uint32_t pulses_hz() const
    {
        return static_cast<std::uint32_t>(hz_ / (std::uint64_t{top()} + 1) / (prescaler_ + 1));
    }

private:
    enum Register : unsigned {
        kCr1,
        kCr2,
        kSmcr,
        kDier,
        kSr,
        kEgr,
        kCcmr1,
        kCcmr2,
        kCcer,
        kCnt,
        kPsc,
        kArr,
        kRcr,
        kCcr1,
        kCcr2,
        kCcr3,
        kCcr4,
        kBdtr,
        kDcr,
        kDmar,
        kOr,
        kRegisterCount
    };
    bool counts() const;
    // CCDS: the compare requests are sent at the update.
    bool requests_at_update() const { return (registers_[kCr2] >> 3U & 1U) != 0; }
    bool gated() const { return (registers_[kSmcr] & 7U) == 5; }
    Picoseconds time_of(std::uint64_t counts) const;
    std::uint64_t counted() const;
    // Brings the counter up to now, and plans what comes next.
    void settle();
    void plan();
    void plan_capture();
    void update_event();
    void compare_events(std::uint32_t at);
    void update_line();
    std::uint32_t top() const { return registers_[kArr]; }

    std::vector<DutyChange> duty_changes_;
    std::string name_;
    Wiring wiring_;
    TimerModel* listener_{nullptr};
    std::array<std::uint32_t, kRegisterCount> registers_{};
    std::uint32_t prescaler_{0};  // in force since the last update
    std::uint32_t hz_{1};
    bool running_{false};
    bool frozen_{false};
    Picoseconds since_{0};  // when the counter was `count_`
    std::uint64_t count_{0};
    std::uint64_t due_count_{0};
    Picoseconds capture_due_{kNever};
};

}  // namespace cusp::cosim
