// DriveModel: a TMC2209 as its single wire sees it: bits in, registers, bits out.
//
// It knows nothing of the firmware: it takes the length of a bit from the sync nibble of each datagram, as the
// data sheet (revision 1.09, section 4) says, and answers 8 bits after the last stop bit.
#pragma once

#include <functional>
#include <map>

#include "tests/target/cosim/port_model.hpp"

namespace cusp::cosim {

class DriveModel final : public Model {
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

    // Faults: no module, or none with power; a wrong checksum in so many answers; another chip; writes that
    // are lost; bits of DRV_STATUS.
    void set_missing(bool on);
    void garble_answers(unsigned count) { garbled_ = count; }
    void set_version(std::uint32_t version) { version_ = version; }
    void set_deaf(bool on) { deaf_ = on; }
    // By how much its bits are longer than those of the request.
    void set_drift(std::int32_t parts_per_thousand) { drift_ = parts_per_thousand; }
    void set_status(std::uint32_t bits);

    const std::map<std::uint32_t, std::uint32_t>& registers() const { return registers_; }
    const std::string& name() const { return name_; }
    std::uint64_t answers() const { return answers_; }
    std::uint64_t damaged() const { return damaged_; }  // requests that came with a wrong checksum
    Picoseconds written_at() const { return written_at_; }
    // Of the last datagram, bits a second.
    double baud() const { return bit_ > 0 ? 1e12 / static_cast<double>(bit_) : 0; }

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
