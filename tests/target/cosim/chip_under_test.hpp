// ChipUnderTest: an STM32F4 put together of its models, with an image in its flash.
#pragma once

#include <map>
#include <memory>

#include "tests/target/cosim/bus_drive_model.hpp"
#include "tests/target/cosim/clock_model.hpp"
#include "tests/target/cosim/core_model.hpp"
#include "tests/target/cosim/dma_model.hpp"
#include "tests/target/cosim/drive_model.hpp"
#include "tests/target/cosim/flash_model.hpp"
#include "tests/target/cosim/port_model.hpp"
#include "tests/target/cosim/spindle_model.hpp"
#include "tests/target/cosim/timer_model.hpp"
#include "tests/target/cosim/usart_model.hpp"
#include "tests/target/cosim/usb_host.hpp"
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

class ChipUnderTest {
public:
    ChipUnderTest(const ChipKind& kind, const std::vector<std::uint8_t>& image);

    // Lets this much time pass. Ends early where `until` says so; it is asked when the core sleeps.
    void run(Picoseconds time, const std::function<bool()>& until = {});

    // run() ends when the core has executed this many: a core whose time does not advance would run
    // endlessly.
    void limit_instructions(std::uint64_t count)
    {
        last_instruction_ = core_->instructions() + count;
    }
    bool exhausted() const { return core_->instructions() >= last_instruction_; }

    Circuit& circuit() { return circuit_; }
    CoreModel& core() { return *core_; }
    FlashModel& flash() { return *flash_; }
    ClockModel& clocks() { return *clocks_; }
    UsartModel& serial() { return *usarts_.at(kind_.serial - 1); }
    UsbHost& usb() { return *host_; }
    // The one that is spoken to: the serial port, or USB.
    LineModel& line() { return usb_is_line_ ? static_cast<LineModel&>(*host_) : serial(); }
    void make_usb_the_line(bool on) { usb_is_line_ = on; }
    PortModel& port(char letter);
    // A drive whose single wire goes to this pin; or one on a bus: its select line, then clock, data to it and data
    // from it. They are told apart by their places.
    struct Place {
        char port;
        unsigned pin;
    };
    void add_drive(const std::string& name, const std::vector<Place>& wires);
    // A spindle's drive at a USART, whose transceiver has this pin.
    void add_spindle(vfd::Protocol protocol, unsigned usart, char port, unsigned pin);
    SpindleModel& spindle() { return *spindle_; }
    SocketModel& drive(std::size_t place) { return *drives_.at(place); }
    std::size_t drives() const { return drives_.size(); }
    std::map<char, std::unique_ptr<PortModel>>& ports() { return ports_; }
    // Duty cycle of a channel of timer 3, 1 to 4, in parts of a million; and its rate, Hz.
    std::uint32_t spindle_duty(unsigned channel) const
    {
        return timers_.at("TIM3")->duty_ppm(channel - 1);
    }
    std::vector<TimerModel::DutyChange> take_spindle_changes()
    {
        return timers_.at("TIM3")->take_duty_changes();
    }
    std::uint32_t spindle_hz() const { return timers_.at("TIM3")->pulses_hz(); }

    // The core executes nothing more; `debugger`: as a debugger halts it, which DBGMCU knows of.
    void stop_core(bool debugger);
    void go_on();
    // The main loop goes round in circles; interrupts are served. Amid whatever it does in
    // a few microseconds.
    void hang_main_loop();
    // The timer that asks for the pulses is frozen: no frame ends any more.
    void stop_pace();
    // Without power for a while: the memory is lost, the flash stays.
    void power_cycle();
    unsigned resets() const { return resets_; }
    // The power fails after this many more words or erases of the flash.
    void fail_power_after(std::uint64_t writes)
    {
        writes_left_ = static_cast<std::int64_t>(writes);
    }
    bool powered() const { return powered_; }

    // Called at each change of half of the pulse stream, that is each servo tick.
    void set_tick_listener(std::function<void()> listener) { tick_listener_ = std::move(listener); }

private:
    static constexpr std::uint32_t kBlock = 0x400;  // bytes of addresses that a block has
    struct Block {
        Model* model;
        std::string name;
        std::function<bool()> clocked;
    };
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
    void happen_until_now();
    void find_next();
    void reset(ClockModel::ResetCause cause);
    void advance(Picoseconds to);
    void listen_for_ticks();

    ChipKind kind_;
    Circuit circuit_;
    std::unique_ptr<ClockModel> clocks_;
    std::unique_ptr<FlashModel> flash_;
    std::unique_ptr<Model> power_;
    std::unique_ptr<WatchdogModel> watchdog_;
    std::unique_ptr<DmaModel> dma1_, dma2_;
    std::array<std::unique_ptr<UsartModel>, 3> usarts_;
    std::unique_ptr<SpindleModel> spindle_;
    std::unique_ptr<UsbModel> usb_;
    std::unique_ptr<UsbHost> host_;
    bool usb_is_line_{false};
    std::map<char, std::unique_ptr<PortModel>> ports_;
    std::map<std::string, std::unique_ptr<TimerModel>> timers_;
    std::vector<std::unique_ptr<SocketModel>> drives_;
    std::unique_ptr<CoreModel> core_;
    std::map<std::uint32_t, Block> blocks_;
    std::vector<Model*> active_;  // those that do something by themselves
    std::uint32_t clock_changes_{0};
    std::uint32_t freeze_1_{0}, freeze_2_{0};
    Picoseconds end_{0};
    std::uint64_t last_instruction_{std::numeric_limits<std::uint64_t>::max()};
    bool held_{false};
    bool powered_{true};
    std::int64_t writes_left_{-1};
    std::uint32_t torn_place_{0}, torn_word_{0};  // where the power failed
    unsigned resets_{0};
    bool pace_line_{false};
    std::function<void()> tick_listener_;
};

}  // namespace cusp::cosim
