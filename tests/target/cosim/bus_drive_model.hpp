// BusDriveModel: a TMC5160 (tests/support/tmc5160_model.hpp) at the pins of the chip, in time.
#pragma once

#include <array>

#include "tests/support/tmc5160_model.hpp"
#include "tests/target/cosim/port_model.hpp"
#include "tests/target/cosim/socket_model.hpp"

namespace cusp::cosim {

class BusDriveModel final : public SocketModel {
public:
    struct Wire {
        PortModel& port;
        unsigned pin;

        bool high() const { return port.wire_high(pin); }
        bool driven() const { return port.driven(pin); }
    };

    // The chip's pins for CSN, SCK, SDI and SDO.
    BusDriveModel(Circuit& circuit,
                  std::string name,
                  Wire select,
                  Wire clock,
                  Wire to_drive,
                  Wire from_drive);

    std::uint32_t read(std::uint32_t /*place*/) override { return 0; }
    void write(std::uint32_t /*place*/, std::uint32_t /*value*/) override {}
    // As after power-up.
    void reset() override;
    void happen() override {}

    void set_missing(bool on) override;
    void garble_answers(unsigned count) override { chip_.garbled = count; }
    void set_version(std::uint32_t version) override { chip_.version = version; }
    void set_deaf(bool on) override { chip_.deaf = on; }
    void set_status(std::uint32_t bits) override { chip_.set_status(bits); }
    void starve() override { chip_.starve(); }

    const std::map<std::uint32_t, std::uint32_t>& registers() const override
    {
        return chip_.registers();
    }
    std::uint64_t answers() const override { return chip_.answers(); }
    std::uint64_t damaged() const override { return chip_.damaged(); }
    Picoseconds written_at() const override { return written_at_; }
    double baud() const override;

private:
    // The levels of the wires may have changed.
    void look();
    // An edge of a pin that the chip lets go, at its reset, is no edge of the driver's.
    void judge_times(bool selects, bool clocks);
    void answer();

    std::string name_;
    Wire select_;
    Wire clock_;
    Wire to_drive_;
    Wire from_drive_;
    test::Tmc5160Model chip_;
    std::size_t told_{0};  // violations
    bool was_selected_{false};
    bool clock_was_high_{true};
    bool holds_line_{false};
    Picoseconds last_edge_{0};  // of clock or select line
    Picoseconds rose_{0};       // the clock
    Picoseconds bit_{0};
    Picoseconds written_at_{-1};
};

}  // namespace cusp::cosim
