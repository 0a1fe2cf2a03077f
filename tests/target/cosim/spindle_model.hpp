// SpindleModel: a spindle's drive and its transceiver at a serial port of the chip.
//
// It takes as a message what ends in a pause of 3.5 characters, as Modbus says, and answers by
// tests/support/spindle_slave.hpp. While the chip sends its pin must be high, or nobody hears it; while the
// drive answers low.
#pragma once

#include <string>

#include "tests/support/spindle_slave.hpp"
#include "tests/target/cosim/port_model.hpp"
#include "tests/target/cosim/usart_model.hpp"

namespace cusp::cosim {

class SpindleModel final : public Model {
public:
    SpindleModel(Circuit& circuit,
                 UsartModel& usart,
                 PortModel& port,
                 unsigned pin,
                 vfd::Protocol protocol,
                 std::uint32_t baud);

    std::uint32_t read(std::uint32_t /*place*/) override { return 0; }
    void write(std::uint32_t /*place*/, std::uint32_t /*value*/) override {}
    // The drive has a supply of its own.
    void reset() override {}
    void happen() override;

    test::SpindleSlave& slave() { return slave_; }
    void set_baud(std::uint32_t baud);

private:
    void hear(char byte);

    UsartModel& usart_;
    PortModel& port_;
    unsigned pin_;
    std::uint32_t baud_;
    test::SpindleSlave slave_;
    test::SpindleSlave::Bytes message_;
    Picoseconds last_{0};  // byte
    bool answered_{true};
};

}  // namespace cusp::cosim
