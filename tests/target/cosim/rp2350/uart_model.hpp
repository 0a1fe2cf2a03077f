// UartModel: UART0, a PL011 with its FIFOs, and the line at its pins, bit by bit in time or without any.
#pragma once

#include <deque>
#include <functional>

#include "tests/target/cosim/line_model.hpp"
#include "tests/target/cosim/model.hpp"

namespace cusp::cosim::rp2350 {

class UartModel final : public Model, public SerialLine {
public:
    struct Wiring {
        std::function<std::uint32_t()> clock_hz;
        std::function<bool()> pins_ready;
        std::function<void()> requests_changed;
        unsigned interrupt;
    };
    UartModel(Circuit& circuit, Wiring wiring);

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;
    void reset() override;
    void happen() override;

    // Requests for DMA.
    bool wants() const { return (dmacr_ & 2U) != 0 && sent_.size() < depth(); }
    bool offers() const { return (dmacr_ & 1U) != 0 && !received_.empty(); }

    // SerialLine
    void send(const std::string& bytes) override;
    void set_receiver(std::function<void(char)> receiver) override
    {
        receiver_ = std::move(receiver);
    }
    std::size_t waiting() const override { return incoming_.size(); }
    bool quiet() const override
    {
        return incoming_.empty() && received_.empty() && shift_due_ == kNever && !stuck_;
    }
    void set_instant(bool on) override;
    void set_mute(bool on) override;
    std::uint64_t lost() const override { return lost_; }
    void set_sender_baud(std::uint32_t baud) override { sender_baud_ = baud; }
    void overrun() override;
    void damage() override;
    void unplug() override { incoming_.clear(); }

private:
    bool on() const { return (cr_ & 1U) != 0; }
    std::size_t depth() const { return (lcr_ >> 4U & 1U) != 0 ? 32 : 1; }
    std::size_t trigger(unsigned field) const;
    double baud() const;
    bool rate_fits() const;
    Picoseconds bits(unsigned count) const;
    void arrive();
    void take(std::uint32_t entry);
    void shift();
    void plan_receive();
    void plan();
    void update();
    std::uint32_t take_entry();

    Wiring wiring_;
    std::function<void(char)> receiver_;
    std::uint32_t ibrd_{0}, fbrd_{0}, lcr_{0}, cr_{0x300}, ifls_{0x12}, imsc_{0}, raw_{0},
        dmacr_{0}, errors_{0};
    std::uint32_t divisor_{0};  // in force: sixty-fourths
    std::deque<std::uint32_t> received_;
    std::deque<std::uint8_t> sent_, incoming_;
    std::uint8_t shifted_{0};
    Picoseconds shift_due_{kNever}, receive_due_{kNever}, silent_at_{kNever};
    std::uint32_t sender_baud_{115200};
    bool instant_{false}, mute_{false}, stuck_{false};
    std::uint64_t lost_{0};
};

}  // namespace cusp::cosim::rp2350
