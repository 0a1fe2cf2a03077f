// QemuTraits: the mill controller on QEMU's netduinoplus2 (an STM32F405 without its DMA, its
// clocks, its flash controller and most of its timers): all differences from the chip are here.
//
// Arguments (-semihosting-config arg=...): `program FILE`, `script FILE`, `trace FILE`, `real`.
// With a program the run is that of the simulator: the main loop runs until nothing is left to do,
// then comes one servo tick, and so on to the program's end; with `real` the servo tick interrupts
// the main loop instead, each millisecond. Without a program the serial line is live.
#pragma once

#include <array>
#include <cstdint>

#include "boards/mill3_f405/mill_table.hpp"
#include "firmware/machine/machine.hpp"
#include "hal/cortex_m/reset_report.hpp"
#include "hal/cortex_m/vectors.hpp"
#include "hal/qemu/edge_player.hpp"
#include "hal/qemu/edge_trace.hpp"
#include "hal/qemu/memory_settings.hpp"
#include "hal/qemu/qemu_link.hpp"
#include "hal/qemu/run_arguments.hpp"
#include "hal/qemu/semihosting.hpp"
#include "hal/stm32f4/chip.hpp"

namespace cusp::boards {

struct QemuTraits {
    using Chip = hal::stm32f4::Chip;
    using PulsePlayer = hal::qemu::EdgePlayer<Chip, MillTable, hal::qemu::EdgeTrace>;
    using ByteLink = hal::qemu::QemuLink<Chip>;
    using Panel = MillPanel<QemuTraits>;
    using Pins = hal::stm32f4::PinAccess<Chip>;
    using SettingsStore = hal::qemu::MemorySettings;

    // Its timer 3 would count nanoseconds.
    static constexpr bool kSpindleTimer = false;
    static constexpr const PanelPins& kPanelPins = MillTable::kPanelPins;

    static constexpr std::uint32_t kMostStepsPerSecond = MillTable::kMostStepsPerSecond;
    static constexpr bool kSecondMotor = false;
    static constexpr bool kAtSpeedInput = false;
    static constexpr std::uint8_t kDriveWires = 0;

    // Clocks and peripheral clocks are not modelled: nothing to switch on, nothing to wait for.
    template <class Board>
    static void start(Board& board) noexcept
    {
        using namespace hal::stm32f4;
        const hal::qemu::RunArguments arguments;
        Panel::start();
        set_field(Chip::system().shpr3, 16, 8, kServoTickPriority);
        if (arguments.trace()[0] != '\0') {
            board.pulse_player.trace().open(arguments.trace());
        }
        if (arguments.program()[0] != '\0') {
            board.byte_link.program().open(arguments.program(), arguments.script());
        } else {
            enable_interrupt<Chip>(kUsart1Interrupt, kSerialPriority);
            board.byte_link.line().start(84000000, 115200);
        }
        board.pulse_player.start(arguments.real_pace());
    }

    template <class Board>
    static void after_tick(const Board& /*board*/) noexcept
    {
    }

    // QEMU's virtual time is exact to the instruction only where the core never sleeps.
    static void idle() noexcept { __asm volatile("nop"); }

    template <class Board, class Application>
    [[noreturn]] static void run(Board& board, Application& application) noexcept
    {
        const bool has_program = board.byte_link.program().is_open();
        if (has_program && !board.pulse_player.real_pace()) {
            hal::qemu::exit_qemu(run_program(board, application));
        }
        live_ = true;
        hal::stm32f4::pend_servo_tick<Chip>();
        if (has_program) {
            hal::qemu::exit_qemu(play_program(board, application));
        }
        for (;;) {
            if (!application.poll()) {
                idle();
            }
        }
    }

    // The pins of QEMU's machine drive nothing.
    static void rest() noexcept {}

    // After a fault: the reason on the terminal, the end of the run.
    [[noreturn]] static void stop() noexcept
    {
        constexpr std::uint32_t kFaultStatus = 3;
        PulsePlayer::stop();
        hal::qemu::Console console;
        hal::cortex_m::report_last_fault(console);
        hal::qemu::exit_qemu(kFaultStatus);
    }

    static constexpr bool kUsb = false;
    // True if the player's interrupt calls for the servo tick; a program's run makes its own.
    static bool live() noexcept { return live_; }
    static constexpr unsigned kInterruptCount = hal::stm32f4::kInterruptCount;
    // QEMU's port sends without an interrupt.
    static constexpr std::array<hal::cortex_m::InterruptEntry, 3> interrupts() noexcept
    {
        return {{{hal::stm32f4::kTimer2Interrupt, cusp_player_interrupt},
                 {hal::stm32f4::kUsart1Interrupt, cusp_serial_interrupt},
                 {hal::stm32f4::dma2_interrupt(7), cusp_serial_interrupt}}};
    }

private:
    static inline bool live_{false};

    // The simulator's run, step by step (host_tools/controller/simulate): the same order of bytes and servo
    // ticks gives the same frames. Returns 0 for a program that is done, 1 after an error or alarm.
    template <class Board, class Application>
    static std::uint32_t run_program(Board& board, Application& application) noexcept
    {
        auto& program = board.byte_link.program();
        const machine::Machine& machine = application.machine();
        for (std::uint64_t tick = 0; !program.refused(); ++tick) {
            program.set_tick(tick);
            settle(application);
            if (held(machine) && !program.script_waits()) {
                program.send('~');
                settle(application);
            }
            if (program.finished() && machine.idle() && machine.motion().settled()) {
                break;
            }
            play_tick(board, application);
        }
        // After an error, lines already taken are still executed.
        while (!machine.motion().settled() && !held(machine)) {
            settle(application);
            play_tick(board, application);
        }
        while (!board.pulse_player.silent()) {
            idle();
        }
        board.pulse_player.trace().flush();
        return program.refused() ? 1 : 0;
    }

    // A program at its real pace: the servo tick interrupts planning, as on the chip.
    template <class Board, class Application>
    static std::uint32_t play_program(Board& board, Application& application) noexcept
    {
        auto& program = board.byte_link.program();
        const machine::Machine& machine = application.machine();
        while (!program.refused() &&
               !(program.finished() && machine.idle() && machine.motion().settled())) {
            program.set_tick(board.pulse_player.frames());
            if (application.poll()) {
                continue;
            }
            if (held(machine) && !program.script_waits()) {
                program.send('~');
            } else {
                idle();
            }
        }
        while (!machine.motion().settled() && !held(machine)) {
            if (!application.poll()) {
                idle();
            }
        }
        constexpr std::uint32_t kFramesInFlight = 3;
        const std::uint32_t last = board.pulse_player.frames() + kFramesInFlight;
        while (static_cast<std::int32_t>(board.pulse_player.frames() - last) < 0) {
            idle();
        }
        __asm volatile("cpsid i" ::: "memory");
        board.pulse_player.trace().flush();
        return program.refused() ? 1 : 0;
    }

    template <class Application>
    static void settle(Application& application) noexcept
    {
        while (application.poll()) {
        }
    }
    template <class Board, class Application>
    static void play_tick(Board& board, Application& application) noexcept
    {
        while (!board.pulse_player.has_room()) {
            idle();
        }
        application.tick();
    }
    static bool held(const machine::Machine& machine) noexcept
    {
        return machine.state() == machine::State::kHold && machine.motion().at_rest();
    }
};

}  // namespace cusp::boards
