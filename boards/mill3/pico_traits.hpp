// PicoTraits: a mill controller with an RP2350 on a Pico 2, made of the table of its board.
//
// A board's table, such as boards/pico2_terminals/pico2_table.hpp, defines:
//   kLines              pins of the step and direction lines, 16 neighbouring ones at most
//   kPanelPins          pins of inputs, spindle, coolant and drives
//   kBaud               of UART0, on GP0 and GP1
//   kUsb                hal/usb_serial/usb_descriptors.hpp: how the board is called on the bus
//   kFlashBytes         of the flash, whose last two sectors are the settings'
//   kMostStepsPerSecond of each axis while all three move: what the core has time for
//
// boards/mill3/chip_traits.hpp, which is that of the STM32F4 family, says what a traits type is for.
#pragma once

#include <array>
#include <cstdint>

#include "boards/mill3/main_loop.hpp"
#include "boards/mill3/mill_panel.hpp"
#include "boards/mill3/pico_pin_rules.hpp"
#include "boards/mill3/two_links.hpp"
#include "firmware/base/assert.hpp"
#include "firmware/machine/accessories.hpp"
#include "firmware/machine/stored_state.hpp"
#include "hal/cortex_m/vectors.hpp"
#include "hal/rp2350/chip_clocks.hpp"
#include "hal/rp2350/chip_reset.hpp"
#include "hal/rp2350/chip_watchdog.hpp"
#include "hal/rp2350/gp_pins.hpp"
#include "hal/rp2350/pio_pulse_player.hpp"
#include "hal/rp2350/pwm_pulses.hpp"
#include "hal/rp2350/rom_settings.hpp"
#include "hal/rp2350/rp2350.hpp"
#include "hal/rp2350/uart_link.hpp"
#include "hal/rp2350/usb_device.hpp"

namespace cusp::boards {

template <class Table>
struct PicoTraits {
    using Chip = hal::rp2350::Chip;
    using PulsePlayer = hal::rp2350::PioPulsePlayer<Chip, Table>;
    using SerialLink = hal::rp2350::UartLink<Chip>;
    static constexpr bool kUsb = true;
    using ByteLink = TwoLinks<SerialLink, hal::rp2350::UsbLink<Chip, Table>>;
    using Panel = MillPanel<PicoTraits>;
    using SettingsStore = hal::rp2350::FlashSettings<Chip, Table::kFlashBytes>;

    static_assert(PicoPinRules<Table, SerialLink>::kHold);

    // Members that MillPanel needs.
    using Pins = hal::rp2350::PinAccess<Chip>;
    using SpindlePulses = hal::rp2350::SpindlePulses<Chip, PicoTraits>;
    static constexpr bool kSpindleTimer = true;
    static constexpr const PicoPanelPins& kPanelPins = Table::kPanelPins;
    static constexpr const hal::rp2350::PulsePin& kPulses = kPanelPins.spindle_pulses;
    static constexpr std::uint32_t kPulseClockHz = hal::rp2350::kCoreHz;

    static constexpr std::uint32_t kMostStepsPerSecond = Table::kMostStepsPerSecond;
    static constexpr bool kSecondMotor = hal::rp2350::PulseWords<Table>::kSecondMotor;
    static constexpr bool kAtSpeedInput = is_there(kPanelPins.at_speed);
    static constexpr std::uint8_t kDriveWires = 0;

    // True if the end of a frame calls for the servo tick.
    static constexpr bool live() noexcept { return true; }
    static constexpr unsigned kInterruptCount = hal::rp2350::kInterruptCount;
    static constexpr std::array<hal::cortex_m::InterruptEntry, 3> interrupts() noexcept
    {
        return {{{hal::rp2350::kDmaInterrupt, cusp_player_interrupt},
                 {hal::rp2350::kUart0Interrupt, cusp_serial_interrupt},
                 {hal::rp2350::kUsbInterrupt, cusp_usb_interrupt}}};
    }

    // Outputs and lines at rest, as the settings invert them; left as they are where the store holds
    // something that can't be read. Context: before statics have their values.
    static void rest() noexcept
    {
        // For tests/checks/image.py.
        __asm volatile(
            ".global cusp_settings, cusp_settings_sector\n"
            ".set cusp_settings, %c0\n"
            ".set cusp_settings_sector, %c1" ::"i"(SettingsStore::kAddress),
            "i"(hal::rp2350::kFlashSector));
        SettingsStore store;
        if (const auto settings = machine::glimpse_settings(store)) {
            const OutputLevels off = machine::output_levels({}, 100, {}, *settings);
            static_cast<void>(hal::rp2350::release_blocks<Chip>(hal::rp2350::kPinBlocks));
            Panel::rest(off);
            PulsePlayer::rest(off.inverted_lines);
        }
    }

    template <class Board>
    static void start(Board& board) noexcept
    {
        using namespace hal::rp2350;
        note_reset_cause<Chip>();
        // Started by cusp_boot().
        if (!clocks_run<Chip>()) {
            fault("the clock did not start", __FILE__, __LINE__);
        }
        constexpr std::uint32_t kBlocks =
            kDmaBlock | kPio0Block | kPwmBlock | kUart0Block | kUsbBlock;
        if (!release_blocks<Chip>(kPinBlocks) || !restart_blocks<Chip>(kBlocks)) {
            fault("a block stays in reset", __FILE__, __LINE__);
        }
        Panel::start();
        set_pin_function<Chip>(SerialLink::kTransmit, PinFunction::kUart, kPadOutput);
        set_pin_function<Chip>(SerialLink::kReceive, PinFunction::kUart,
                               kPadOutput | kPadInput | kPadPullUp);
        board.byte_link.serial.start(kCoreHz, Table::kBaud);
        enable_interrupt<Chip>(kUart0Interrupt, kSerialPriority);
        board.byte_link.usb.start();
        enable_interrupt<Chip>(kUsbInterrupt, kUsbPriority);
        set_field(Chip::system().shpr3, 16, 8, kServoTickPriority);
    }

    // After a fault: switches off everything that moves, then restarts, which reports the reason.
    [[noreturn]] static void stop() noexcept
    {
        PulsePlayer::stop();
        Panel::switch_everything_off();
        hal::rp2350::reset_chip<Chip>();
    }

    // After each servo tick: records whether a reset would lose the position.
    template <class Board>
    static void after_tick(const Board& board) noexcept
    {
        hal::cortex_m::mark_motion(board.pulse_player.moving());
    }

    template <class Board, class Application>
    [[noreturn]] static void run(Board& board, Application& application) noexcept
    {
        using namespace hal::rp2350;
        report_reset(board.byte_link);
        board.byte_link.usb.connect();
        enable_interrupt<Chip>(kDmaInterrupt, kPlayerPriority);
        board.pulse_player.start(kCoreHz, reset_amid_motion());
        start_watchdog<Chip>();
        run_fed<feed_watchdog<Chip>>(application);
    }
};

}  // namespace cusp::boards
