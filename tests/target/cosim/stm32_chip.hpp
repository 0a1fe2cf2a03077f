// Stm32Chip: an STM32F4.
#pragma once

#include "tests/target/cosim/bus_drive_model.hpp"
#include "tests/target/cosim/chip_under_test.hpp"
#include "tests/target/cosim/clock_model.hpp"
#include "tests/target/cosim/dma_model.hpp"
#include "tests/target/cosim/drive_model.hpp"
#include "tests/target/cosim/flash_model.hpp"
#include "tests/target/cosim/port_model.hpp"
#include "tests/target/cosim/spindle_model.hpp"
#include "tests/target/cosim/timer_model.hpp"
#include "tests/target/cosim/usart_model.hpp"
#include "tests/target/cosim/usb_model.hpp"
#include "tests/target/cosim/watchdog_model.hpp"

namespace cusp::cosim {

struct ChipKind {
    ClockFacts clocks;
    std::uint32_t flash_bytes;
    std::uint32_t ram_bytes;
    std::uint32_t coupled_bytes;  // CCM
    bool has_timer8;
    std::string ports;
    unsigned serial{1};  // which USART is the board's line
    bool overrides_usb_session{false};
};
// stm32f405, stm32f407, stm32f411, stm32f429, stm32f446. Throws std::runtime_error for another.
ChipKind chip_kind(const std::string& name);

class Stm32Chip final : public ChipUnderTest {
public:
    Stm32Chip(const ChipKind& kind, const std::vector<std::uint8_t>& image);

    FlashModel& flash() { return *flash_; }
    PortModel& port_model(char letter);
    // A drive whose single wire goes to this pin; or one on a bus: its select line, then clock, data to it and data
    // from it. They are told apart by their places.
    struct Place {
        char port;
        unsigned pin;
    };
    void add_drive(const std::string& name, const std::vector<Place>& wires);
    // A spindle's drive at a USART, whose transceiver has this pin.
    void add_spindle(vfd::Protocol protocol, unsigned usart, char port, unsigned pin);

    // ChipUnderTest
    SerialLine& serial() override { return *usarts_.at(kind_.serial - 1); }
    SpindleModel& spindle() override { return *spindle_; }
    // Of timer 3.
    std::uint32_t spindle_duty(unsigned channel) const override
    {
        return timers_.at("TIM3")->duty_ppm(channel - 1);
    }
    std::vector<Duty> take_spindle_changes() override;
    std::uint32_t spindle_hz() const override { return timers_.at("TIM3")->pulses_hz(); }
    std::uint32_t core_hz() const override { return clocks_->core_hz(); }
    void set_flash_times(Picoseconds erase, Picoseconds program) override
    {
        flash_->set_times(erase, program);
    }
    std::uint64_t erases() const override { return flash_->erases(); }
    std::uint64_t words() const override { return flash_->words(); }
    void kill_crystal() override { clocks_->kill_crystal(); }
    // The timer that asks for the pulses is frozen.
    void stop_pace() override { timers_.at(kind_.has_timer8 ? "TIM8" : "TIM1")->freeze(true); }
    // The stream's first word follows the change of halves by one tick, a frame behind.
    Picoseconds frame_delay() const override { return 1001 * kMicrosecond; }

private:
    static constexpr std::uint32_t kBlock = 0x400;  // bytes of addresses that a block has
    struct Block {
        Model* model;
        std::string name;
        std::function<bool()> clocked;
    };
    void reset_blocks(Start start) override;
    bool watchdog_bites() const override { return watchdog_->bitten(); }
    Picoseconds stalled_until() const override { return flash_->busy_until(); }
    void freeze(bool on) override;
    void lose_power() override;
    void make_blocks();
    void make_timers();
    void make_serial();
    void make_usb();
    struct SerialWiring;
    void add_serial(const SerialWiring& wiring);
    void add(std::uint32_t address,
             const std::string& name,
             Model& model,
             std::function<bool()> clocked);
    void add_timer(const std::string& name,
                   std::uint32_t address,
                   TimerModel::Wiring wiring,
                   std::function<bool()> clocked);
    std::uint32_t read(std::uint32_t address, unsigned size);
    void write(std::uint32_t address, unsigned size, std::uint32_t value);
    bool usb_on(std::uint32_t address, unsigned size);
    Block* block_of(std::uint32_t address, unsigned size, const char* what);
    void write_by_dma(std::uint32_t address, std::uint32_t value);
    void store_flash(std::uint32_t address, unsigned size, std::uint32_t value);

    ChipKind kind_;
    std::unique_ptr<ClockModel> clocks_;
    std::unique_ptr<FlashModel> flash_;
    std::unique_ptr<Model> power_;
    std::unique_ptr<WatchdogModel> watchdog_;
    std::unique_ptr<DmaModel> dma1_, dma2_;
    std::array<std::unique_ptr<UsartModel>, 3> usarts_;
    std::unique_ptr<SpindleModel> spindle_;
    std::unique_ptr<UsbModel> usb_;
    std::map<char, std::unique_ptr<PortModel>> ports_;
    std::map<std::string, std::unique_ptr<TimerModel>> timers_;
    std::map<std::uint32_t, Block> blocks_;
    std::uint32_t clock_changes_{0};
    std::uint32_t freeze_1_{0}, freeze_2_{0};
    bool torn_{false};
    std::uint32_t torn_place_{0}, torn_word_{0};  // where the power failed
};

}  // namespace cusp::cosim
