// UsartModel: a serial port and the line at its pins, bit by bit in time or without any.
#pragma once

#include <deque>
#include <functional>

#include "tests/target/cosim/line_model.hpp"
#include "tests/target/cosim/model.hpp"

namespace cusp::cosim {

class UsartModel final : public Model, public SerialLine {
public:
    struct Wiring {
        std::function<std::uint32_t()> bus_hz;
        std::function<bool()> ask_receive_dma;   // whether a stream took the byte
        std::function<bool()> ask_transmit_dma;  // whether a stream gave one
        std::function<bool()> pins_ready;        // both pins are given to the port
        unsigned interrupt;
    };
    UsartModel(Circuit& circuit, std::string name, Wiring wiring);

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;
    void reset() override;
    void happen() override;

    // A stream was switched on.
    void stream_ready() { ask_for_transmit(); }

    // The other end of the line.
    void set_sender_baud(std::uint32_t baud) override { sender_baud_ = baud; }
    void set_instant(bool on) override;
    void send(const std::string& bytes) override;
    void set_receiver(std::function<void(char)> receiver) override
    {
        receiver_ = std::move(receiver);
    }
    std::size_t waiting() const override { return incoming_.size(); }
    bool quiet() const override { return incoming_.empty() && shift_due_ == kNever && !stuck_; }
    std::uint64_t lost() const override { return lost_; }
    void unplug() override { incoming_.clear(); }
    // The other end takes no more bytes: the one on its way stays in the port.
    void set_mute(bool on) override;
    void overrun() override;
    void damage() override;

private:
    Picoseconds byte_time() const;
    bool rate_fits() const;
    void arrive();
    void take_to_shift(std::uint8_t byte);
    void ask_for_transmit();
    void update_line();
    void plan_receive();

    std::string name_;
    Wiring wiring_;
    std::function<void(char)> receiver_;
    std::uint32_t sr_{0xC0}, brr_{0}, cr1_{0}, cr2_{0}, cr3_{0};
    std::uint8_t received_{0};
    bool flags_read_{false};
    bool holds_{false};
    std::uint8_t held_{0};
    std::uint8_t shifted_{0};
    void plan();
    Picoseconds shift_due_{kNever}, receive_due_{kNever};
    std::deque<std::uint8_t> incoming_;
    std::uint32_t sender_baud_{115200};
    bool instant_{false};
    bool mute_{false};
    bool stuck_{false};  // a byte in the port that the other end does not take
    bool asking_{false};
    std::uint64_t lost_{0};
};

}  // namespace cusp::cosim
