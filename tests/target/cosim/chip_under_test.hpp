// ChipUnderTest: a chip put together of its models, with an image in its flash: time, and what the core meets.
#pragma once

#include <map>
#include <memory>
#include <stdexcept>

#include "tests/target/cosim/core_model.hpp"
#include "tests/target/cosim/pins.hpp"
#include "tests/target/cosim/socket_model.hpp"
#include "tests/target/cosim/usb_host.hpp"

namespace cusp::cosim {

class SpindleModel;

class ChipUnderTest {
public:
    ChipUnderTest() = default;
    ChipUnderTest(const ChipUnderTest&) = delete;
    ChipUnderTest& operator=(const ChipUnderTest&) = delete;
    virtual ~ChipUnderTest() = default;

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
    virtual SerialLine& serial() = 0;
    UsbHost& usb() { return *host_; }
    // The one that is spoken to: the serial port, or USB.
    LineModel& line() { return usb_is_line_ ? static_cast<LineModel&>(*host_) : serial(); }
    void make_usb_the_line(bool on) { usb_is_line_ = on; }
    const std::map<char, Pins*>& ports() const { return pins_; }
    Pins& port(char letter) const;
    SocketModel& drive(std::size_t place) { return *drives_.at(place); }
    std::size_t drives() const { return drives_.size(); }
    virtual SpindleModel& spindle()
    {
        throw std::runtime_error{"a chip without a spindle's drive"};
    }

    // Pulses of the spindle: duty cycle of a channel, 1 to 4, in parts of a million; their rate, Hz;
    // each change of a duty: when, channel 1 to 4, parts of a million.
    struct Duty {
        Picoseconds time;
        unsigned channel;
        std::uint32_t ppm;
    };
    virtual std::uint32_t spindle_duty(unsigned channel) const = 0;
    virtual std::uint32_t spindle_hz() const = 0;
    virtual std::vector<Duty> take_spindle_changes() = 0;

    virtual std::uint32_t core_hz() const = 0;
    // Of the flash: how long it takes, and what it has done.
    virtual void set_flash_times(Picoseconds erase, Picoseconds program) = 0;
    virtual std::uint64_t erases() const = 0;
    virtual std::uint64_t words() const = 0;
    // The crystal stops, while it runs.
    virtual void kill_crystal() = 0;

    // The core executes nothing more; `debugger`: as a debugger halts it, which the chip knows of.
    void stop_core(bool debugger);
    void go_on();
    // The main loop goes round in circles; interrupts are served. Amid whatever it does in
    // a few microseconds.
    void hang_main_loop();
    // No frame ends any more.
    virtual void stop_pace() = 0;
    // Without power for a while: the memory is lost, the flash stays.
    void power_cycle();
    unsigned resets() const { return resets_; }
    // The power fails after this many more words or erases of the flash.
    void fail_power_after(std::uint64_t writes)
    {
        writes_left_ = static_cast<std::int64_t>(writes);
    }
    bool powered() const { return powered_; }

    // Called at each servo tick. The first edge of its frame comes so much later at the pins.
    void set_tick_listener(std::function<void()> listener) { tick_listener_ = std::move(listener); }
    virtual Picoseconds frame_delay() const = 0;

protected:
    enum class Start : std::uint8_t { kPowerUp, kSoftware, kWatchdog };
    virtual void reset_blocks(Start start) = 0;
    virtual bool watchdog_bites() const = 0;
    // The core does not run until then: its memory is busy.
    virtual Picoseconds stalled_until() const { return 0; }
    virtual void freeze(bool on) = 0;
    virtual void lose_power() = 0;

    void reset(Start start);
    void happen_until_now();
    bool must_stop() const { return circuit_.now >= end_ || !powered_ || exhausted(); }
    // Whether a write or an erase of the flash is still to be done whole.
    bool has_power_for_write();

    Circuit circuit_;
    std::unique_ptr<CoreModel> core_;
    std::unique_ptr<UsbHost> host_;
    std::map<char, Pins*> pins_;
    std::vector<std::unique_ptr<SocketModel>> drives_;
    std::vector<Model*> active_;  // those that do something by themselves
    unsigned tick_line_{0};       // the interrupt that a servo tick raises
    unsigned resets_{0};

private:
    void find_next();
    void advance(Picoseconds to);
    void listen_for_ticks();

    bool usb_is_line_{false};
    Picoseconds end_{0};
    std::uint64_t last_instruction_{std::numeric_limits<std::uint64_t>::max()};
    bool held_{false};
    bool powered_{true};
    std::int64_t writes_left_{-1};
    bool pace_line_{false};
    std::function<void()> tick_listener_;
};

}  // namespace cusp::cosim
