// Timers: the watchdog with the power-on sequencer, TIMER0, and the pulse-width slices.
#pragma once

#include "tests/target/cosim/rp2350/facet.hpp"

namespace cusp::cosim::rp2350 {

class Watchdog final : public Model {
public:
    Watchdog(Circuit& circuit, std::function<std::uint32_t()> tick_hz);

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;
    // Its scratch words and the reason stay.
    void reset() override;
    void happen() override;

    Model& sequencer() { return sequencer_; }
    bool bitten() const { return bitten_; }
    void power_up();
    void freeze(bool on);
    void look_again();

private:
    std::uint32_t left() const;
    void bite(std::uint32_t reason);
    void plan();

    std::function<std::uint32_t()> tick_hz_;
    Facet sequencer_;
    std::uint32_t ctrl_{0x07000000}, reason_{0}, selected_{0};
    std::array<std::uint32_t, 8> scratch_{};
    std::uint32_t count_{0};
    Picoseconds since_{0};
    bool bitten_{false}, frozen_{false};
};

class Timer0 final : public Model {
public:
    Timer0(Circuit& circuit, std::function<std::uint32_t()> tick_hz);

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;
    void reset() override;
    void happen() override;

private:
    std::uint64_t time() const;
    void update();

    std::function<std::uint32_t()> tick_hz_;
    std::array<std::uint32_t, 4> alarms_{};
    std::uint32_t armed_{0}, raised_{0}, enabled_{0}, forced_{0}, latched_{0};
    Picoseconds since_{0};
};

class PulseWidths final : public Model {
public:
    struct Change {
        Picoseconds time;
        unsigned output;  // slice and channel: 2 * slice + channel
        std::uint32_t ppm;
    };
    PulseWidths(Circuit& circuit, std::function<std::uint32_t()> clock_hz);

    std::uint32_t read(std::uint32_t offset) override;
    void write(std::uint32_t offset, std::uint32_t value) override;
    void reset() override { slices_ = {}; }

    // Parts of a million that an output is high; and its pulses a second.
    std::uint32_t duty_ppm(unsigned output) const;
    std::uint32_t pulses_hz(unsigned output) const;
    std::vector<Change> take_changes() { return std::exchange(changes_, {}); }

private:
    static constexpr unsigned kSlices = 12;
    struct Slice {
        std::uint32_t csr{0}, div{16}, counter{0}, compare{0}, top{0xFFFF};
    };
    std::function<std::uint32_t()> clock_hz_;
    std::array<Slice, kSlices> slices_{};
    std::vector<Change> changes_;
};

}  // namespace cusp::cosim::rp2350
