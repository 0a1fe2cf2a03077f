// ClockTree: crystal, ring oscillator, both PLLs, the clock generators and the ticks (data sheet, chapter 8).
#pragma once

#include <memory>

#include "tests/target/cosim/rp2350/facet.hpp"

namespace cusp::cosim::rp2350 {

class ClockTree {
public:
    // `changed`: the rate of a clock is another one.
    ClockTree(Circuit& circuit, std::uint32_t crystal_hz, std::function<void()> changed);

    void reset();
    Model& crystal() { return crystal_; }
    Model& ring() { return ring_; }
    Model& generators() { return generators_; }
    Model& ticks() { return ticks_; }
    Model& pll(unsigned number) { return *plls_.at(number).registers; }

    std::uint32_t reference_hz() const;
    std::uint32_t system_hz() const;
    std::uint32_t peripheral_hz() const;
    std::uint32_t usb_hz() const;
    // Ticks a second of TIMER0 (2) and of the watchdog (4); 0: none.
    std::uint32_t tick_hz(unsigned generator) const;

private:
    struct Generator {
        std::uint32_t ctrl{0}, div{1U << 16U};
    };
    struct Pll {
        std::unique_ptr<Facet> registers;
        std::uint32_t cs{1}, pwr{0x2D}, feedback{0}, prim{0x77000};
        Picoseconds locked_at{kNever};
    };
    struct Tick {
        std::uint32_t ctrl{0}, cycles{0};
    };
    static constexpr unsigned kReference = 4;
    static constexpr unsigned kSystem = 5;
    static constexpr unsigned kPeripheral = 6;
    static constexpr unsigned kUsb = 8;

    bool crystal_stable() const;
    std::uint32_t crystal_status() const;
    void write_crystal(std::uint32_t offset, std::uint32_t value);
    std::uint32_t read_generator(std::uint32_t offset) const;
    void write_generator(std::uint32_t offset, std::uint32_t value);
    std::uint32_t read_pll(const Pll& pll, std::uint32_t offset) const;
    void write_pll(unsigned number, std::uint32_t offset, std::uint32_t value);
    std::uint32_t pll_hz(unsigned number) const;
    bool pll_used(unsigned number) const;
    std::uint32_t source_hz(unsigned source) const;
    std::uint32_t measured_khz() const;
    void look();

    Circuit& circuit_;
    std::uint32_t crystal_hz_;
    std::function<void()> changed_;
    Facet crystal_, ring_, generators_, ticks_;
    std::uint32_t crystal_ctrl_{0}, crystal_startup_{0};
    Picoseconds crystal_since_{kNever};
    std::array<Generator, 10> clocks_{};
    std::array<Pll, 2> plls_{};
    std::array<Tick, 6> tickers_{};
    std::uint32_t counter_source_{0};
    std::array<std::uint32_t, 4> rates_{};
};

}  // namespace cusp::cosim::rp2350
