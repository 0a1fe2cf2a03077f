// DriveModel: a TMC2209 as its single wire sees it: bits in, registers, bits out.
//
// It knows nothing of the firmware: it takes the length of a bit from the sync nibble of each datagram, as the
// data sheet (revision 1.09, section 4) says, and answers 8 bits after the last stop bit.
#pragma once

#include <functional>
#include <map>

#include "tests/target/cosim/port_model.hpp"
#include "tests/target/cosim/socket_model.hpp"

namespace cusp::cosim {

class DriveModel final : public SocketModel {
public:
    // `pin`: of the port that the wire goes to.
    DriveModel(Circuit& circuit, std::string name, PortModel& port, unsigned pin);

    std::uint32_t read(std::uint32_t place) override;
    void write(std::uint32_t place, std::uint32_t value) override;
    // As after power-up.
    void reset() override;
    void happen() override;
    // The port's levels may have changed.
    void look();

    void set_missing(bool on) override;
    void garble_answers(unsigned count) override { garbled_ = count; }
    void set_version(std::uint32_t version) override { version_ = version; }
    void set_deaf(bool on) override { deaf_ = on; }
    void set_drift(std::int32_t parts_per_thousand) override { drift_ = parts_per_thousand; }
    void set_status(std::uint32_t bits) override;

    const std::map<std::uint32_t, std::uint32_t>& registers() const override { return registers_; }
    std::uint64_t answers() const override { return answers_; }
    std::uint64_t damaged() const override { return damaged_; }
    Picoseconds written_at() const override { return written_at_; }
    double baud() const override { return bit_ > 0 ? 1e12 / static_cast<double>(bit_) : 0; }

private:
    enum class State { kIdle, kSync, kBits, kBetween, kAnswer };

    bool level() const;
    void begin_byte();
    void take_byte();
    void take_datagram();
    void send_bit();
    void plan(Picoseconds at);

    std::string name_;
    PortModel& port_;
    unsigned pin_;
    State state_{State::kIdle};
    bool was_high_{true};
    std::vector<Picoseconds> edges_;  // of the sync nibble
    Picoseconds bit_{0};
    Picoseconds start_{0};  // falling edge of the start bit
    unsigned bits_taken_{0};
    unsigned byte_{0};
    std::vector<std::uint8_t> bytes_;
    std::vector<bool> answer_;
    std::size_t sent_{0};

    std::map<std::uint32_t, std::uint32_t> registers_;
    bool missing_{false};
    bool deaf_{false};
    std::int32_t drift_{0};
    unsigned garbled_{0};
    std::uint32_t version_{0x21};
    std::uint32_t status_{0};
    std::uint64_t answers_{0};
    std::uint64_t damaged_{0};
    Picoseconds written_at_{-1};
};

}  // namespace cusp::cosim
