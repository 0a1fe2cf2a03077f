// Rp2350Chip: an RP2350 with 4 MB of flash, as on a Pico 2.
#pragma once

#include "tests/target/cosim/chip_under_test.hpp"
#include "tests/target/cosim/rp2350/boot_rom.hpp"
#include "tests/target/cosim/rp2350/clock_tree.hpp"
#include "tests/target/cosim/rp2350/dma_channels.hpp"
#include "tests/target/cosim/rp2350/gpio_model.hpp"
#include "tests/target/cosim/rp2350/pio_model.hpp"
#include "tests/target/cosim/rp2350/timers.hpp"
#include "tests/target/cosim/rp2350/uart_model.hpp"
#include "tests/target/cosim/rp2350/usb_controller.hpp"

namespace cusp::cosim::rp2350 {

class Rp2350Chip final : public ChipUnderTest {
public:
    static constexpr std::uint32_t kMostHz = 150000000;
    Rp2350Chip(std::uint32_t crystal_hz, const std::vector<std::uint8_t>& image);

    // ChipUnderTest
    SerialLine& serial() override { return *uart_; }
    std::uint32_t spindle_duty(unsigned channel) const override;
    std::uint32_t spindle_hz() const override;
    std::vector<Duty> take_spindle_changes() override;
    std::uint32_t core_hz() const override { return clocks_->system_hz(); }
    void set_flash_times(Picoseconds erase, Picoseconds program) override
    {
        rom_->set_times(erase, program);
    }
    std::uint64_t erases() const override { return rom_->erases(); }
    std::uint64_t words() const override { return rom_->words(); }
    void kill_crystal() override
    {
        throw std::runtime_error{"a crystal that dies is not modelled on this chip"};
    }
    void stop_pace() override { paced_ = false; }
    Picoseconds frame_delay() const override;

private:
    struct Block {
        Model* model;
        std::string name;
        int reset;  // its bit; -1: it has none
    };
    void reset_blocks(Start start) override;
    bool watchdog_bites() const override { return watchdog_->bitten(); }
    void freeze(bool on) override { watchdog_->freeze(on); }
    void lose_power() override { watchdog_->power_up(); }
    void make_blocks();
    void make_pio();
    void make_core();
    void add(std::uint32_t address, const std::string& name, Model& model, int reset = -1);
    Block* block_of(std::uint32_t address, const char* what);
    bool in_reset(int bit) const { return bit >= 0 && (resets_word_ >> bit & 1U) != 0; }
    void write_resets(std::uint32_t value);
    std::uint32_t read(std::uint32_t address, unsigned size);
    void write(std::uint32_t address, unsigned size, std::uint32_t value);
    std::uint32_t read_by_dma(std::uint32_t address, unsigned size);
    void write_by_dma(std::uint32_t address, unsigned size, std::uint32_t value);
    bool asks(unsigned request) const;
    void clocks_changed();
    // The output of a pulse-width slice that a pin has; -1: none has.
    int spindle_output() const;

    std::unique_ptr<ClockTree> clocks_;
    std::unique_ptr<GpioModel> gpio_;
    std::array<std::unique_ptr<PioModel>, 3> pio_;
    std::unique_ptr<DmaChannels> dma_;
    std::unique_ptr<UartModel> uart_;
    std::unique_ptr<Watchdog> watchdog_;
    std::unique_ptr<Timer0> timer_;
    std::unique_ptr<PulseWidths> widths_;
    std::unique_ptr<UsbController> usb_;
    std::unique_ptr<BootRom> rom_;
    std::vector<std::unique_ptr<Facet>> facets_;
    std::map<std::uint32_t, Block> blocks_;
    std::uint32_t resets_word_{0x1FFFFFFF};
    bool paced_{true};
};

}  // namespace cusp::cosim::rp2350
