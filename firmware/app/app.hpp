// App: the whole controller as one object over a Board; the only place where firmware meets a HAL.
//
//   Board board;
//   planner::PathQueue queue;
//   App<Board> app{board, queue};
//   main loop:   while (true) { app.poll(); }
//   servo tick:  app.tick();          every time a pulse frame has been played, lower priority
//
// The tick alone drives the outputs: what the main loop wants on is off there while a stop is pending,
// whatever the main loop does.
//
// Nothing here reads a clock: time is counted in servo ticks. The same bytes, in the same order
// with the ticks, give the same frames on every board and in the simulator.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>

#include "firmware/drives/drives.hpp"
#include "firmware/machine/machine.hpp"
#include "firmware/machine/settings_log.hpp"
#include "hal/contract/board.hpp"

namespace cusp::app {

template <class Board>
class App {
    static_assert(hal::is_board<Board>());

public:
    // Loads the settings and says hello on the line. Board, queue and factory settings must
    // outlive the App.
    //
    //   queue    the path ahead, in whatever memory the board has for it
    //   factory  the settings where the store holds none, and after `$RST=$`; those of Grbl where it
    //            is null
    App(Board& board,
        planner::PathQueue& queue,
        const machine::Settings* factory = nullptr) noexcept
        : board_{board}, log_{board.settings_store}, machine_{queue, factory, board_limits()}
    {
        machine_.start(machine::load_state(log_, machine_.stored()));
        wanted_ = machine_.outputs();
        driven_ = wanted_;
        board_.panel.set(driven_);
        board_.pulse_player.invert(driven_.inverted_lines);
    }
    App(const App&) = delete;
    App& operator=(const App&) = delete;

    // One slice of the main loop: takes bytes from the link, executes lines, fills the planner,
    // answers, keeps settings. A slice is short (a few dozen bytes or one move), so that realtime
    // bytes and the tick are never kept waiting.
    //
    // Returns whether it made progress. If it did not, nothing more happens until a byte
    // arrives, the link takes bytes, or tick() runs: a simulator polls until false, then ticks.
    // Context: main loop; tick() may interrupt it at any place.
    bool poll() noexcept;

    // Makes the next pulse frame and hands it to the player, where that has room; a frame that
    // finds no room is kept and offered again at the next call. Frames without edges are played
    // too: they are the machine's clock. Context: servo tick. Never called while it runs, nor while
    // poll() would be the interrupter.
    void tick() noexcept;

    // State, position and settings, for simulators and tests.
    const machine::Machine& machine() const noexcept { return machine_; }

private:
    static constexpr machine::BoardLimits board_limits() noexcept
    {
        machine::BoardLimits limits{Board::kMostStepsPerSecond, Board::kSecondMotor,
                                    Board::kAtSpeedInput, hal::has_spindle_wire<Board>};
        if constexpr (hal::has_drive_wire<Board>) {
            limits.drive_wires = Board::kDriveWires;
            limits.sense_milliohms = Board::kSenseMilliohms;
        }
        if constexpr (hal::has_drive_bus<Board>) {
            limits.drive_bus = true;
            limits.bus_sense_milliohms = Board::kBusSenseMilliohms;
        }
        return limits;
    }
    bool read_bytes() noexcept;
    void serve_drives() noexcept;
    void serve_spindle() noexcept;
    bool write_bytes() noexcept;
    void store_settings() noexcept;
    void want_outputs(const OutputLevels& outputs) noexcept;
    void scan_bytes() noexcept;
    void drive_laser() noexcept;
    void drive_outputs() noexcept;

    Board& board_;
    machine::SettingsLog<decltype(Board::settings_store)> log_;
    machine::Machine machine_;
    OutputLevels wanted_;  // the main loop's
    std::atomic<bool> wants_other_{false};
    OutputLevels driven_;  // the tick's, before it cuts them
    std::uint16_t laser_duty_{0};
    bool cut_{false};
    bool drives_cut_{false};
    std::atomic<std::uint32_t> slices_{0};  // that the main loop has ended; wraps
    std::uint32_t slices_seen_{0};          // by the last tick
    PulseFrame frame_;
    bool frame_waits_{false};
};

template <class Board>
bool App<Board>::poll() noexcept
{
    machine_.begin_slice();
    const bool read = read_bytes();
    const bool missed = board_.pulse_player.underrun();
    if (missed) {
        machine_.frame_missed();
    }
    serve_drives();
    serve_spindle();
    const bool worked = machine_.poll();
    const OutputLevels outputs = machine_.outputs();
    if (!(outputs == wanted_)) {
        want_outputs(outputs);
    }
    machine_.end_slice();
    if (missed) {
        // Only now, with the machine's stop in force: until then the underrun cuts the outputs.
        board_.pulse_player.clear_underrun();
    }
    slices_.store(slices_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
    const bool stores = machine_.wants_store();
    if (stores) {
        store_settings();
    }
    return write_bytes() || read || worked || stores;
}

template <class Board>
void App<Board>::tick() noexcept
{
    drive_laser();
    scan_bytes();
    if (!frame_waits_) {
        frame_.edges.clear();
        machine_.tick(board_.panel.inputs(), frame_);
    }
    frame_waits_ = !board_.pulse_player.try_play(frame_);
    drive_outputs();
}

template <class Board>
bool App<Board>::read_bytes() noexcept
{
    constexpr unsigned kBytesPerSlice = 64;
    constexpr bool kFollows = hal::follows_lines<decltype(Board::byte_link)>;
    if constexpr (kFollows) {
        if (board_.byte_link.sender_left()) {
            machine_.sender_left();
        }
        board_.byte_link.follow({machine_.all_answered(), machine_.replies().pending().empty(),
                                 machine_.room(), machine_.motion().ticks()});
    }
    if (board_.byte_link.overrun()) {
        machine_.bytes_lost();
    }
    std::uint8_t byte = 0;
    unsigned count = 0;
    while (count < kBytesPerSlice && board_.byte_link.try_read(byte)) {
        machine_.receive(byte);
        ++count;
    }
    // A sender that is held back has more.
    if (count < kBytesPerSlice && (!kFollows || machine_.room() > 0)) {
        machine_.link_empty();
    }
    return count > 0;
}

// A datagram that has ended is taken, the next one begun.
template <class Board>
void App<Board>::serve_drives() noexcept
{
    if constexpr (hal::has_drive_wire<Board>) {
        auto& wire = board_.drive_wire;
        drives::Drives& drives = machine_.drives();
        const std::uint32_t tick = machine_.motion().ticks();
        if (drives.waits()) {
            const bool busy = wire.busy();
            if (busy && !drives.overdue(tick)) {
                return;
            }
            std::array<std::uint8_t, drives::kMostBytes> answer{};
            const std::size_t size = busy ? 0 : wire.take(answer);
            drives.take(Span<const std::uint8_t>{answer}.first(size), tick);
        }
        const std::optional<drives::DriveRequest> request = drives.next(tick);
        if (!request) {
            return;
        }
        if constexpr (hal::has_drive_bus<Board>) {
            if (request->kind == drives::DriveKind::kTmc5160) {
                std::array<std::uint8_t, drives::kMostBytes> answer{};
                const auto bytes = Span<std::uint8_t>{answer}.first(request->bytes.size());
                board_.drive_bus.ask(request->drive, request->bytes.span(), bytes);
                drives.take({bytes.data(), bytes.size()}, tick);
                return;
            }
        }
        wire.begin(request->drive, request->bytes.span(), request->replies);
    }
}

// As above, for the spindle's drive.
template <class Board>
void App<Board>::serve_spindle() noexcept
{
    if constexpr (hal::has_spindle_wire<Board>) {
        auto& wire = board_.spindle_wire;
        vfd::Vfd& vfd = machine_.told_vfd();
        const std::uint32_t tick = machine_.motion().ticks();
        if (vfd.waits()) {
            constexpr std::size_t kMost = 16;
            std::array<std::uint8_t, kMost> answer{};
            const Span<const std::uint8_t> bytes =
                Span<const std::uint8_t>{answer}.first(wire.heard(answer));
            if (!vfd.is_over(bytes, tick)) {
                return;
            }
            vfd.take(bytes, tick);
        }
        if (const std::optional<vfd::Message> message = vfd.next(tick)) {
            wire.begin(message->span(), machine_.settings().vfd_baud());
        }
    }
}

// For the tick to drive. It does not look while they are written.
template <class Board>
void App<Board>::want_outputs(const OutputLevels& outputs) noexcept
{
    wants_other_.store(false, std::memory_order_relaxed);
    std::atomic_signal_fence(std::memory_order_seq_cst);
    wanted_ = outputs;
    wants_other_.store(true, std::memory_order_release);
    board_.pulse_player.invert(outputs.inverted_lines);
}

// A stop in the bytes that the main loop does not come to read. If it has ended a slice since the last
// tick it reads them next, and what follows is the same on every board.
template <class Board>
void App<Board>::scan_bytes() noexcept
{
    constexpr unsigned kBytesPerTick = 128;  // at 1 Mbaud 100 come
    const std::uint32_t slices = slices_.load(std::memory_order_acquire);
    const bool reads = slices != slices_seen_;
    slices_seen_ = slices;
    if (reads) {
        return;
    }
    std::uint8_t byte = 0;
    for (unsigned i = 0; i < kBytesPerTick && board_.byte_link.try_scan(byte); ++i) {
        machine_.notice(byte);
    }
}

// In step with the pulses: before all else that the tick does.
template <class Board>
void App<Board>::drive_laser() noexcept
{
    if (!driven_.follows_speed || frame_waits_) {
        return;
    }
    const std::uint16_t duty = cut_ ? driven_.spindle_off_pwm : machine_.laser_duty();
    if (duty != laser_duty_) {
        laser_duty_ = duty;
        board_.panel.set_duty(duty);
    }
}

template <class Board>
void App<Board>::drive_outputs() noexcept
{
    // No tick follows an underrun until the main loop acts.
    const bool cut = machine_.cuts_outputs() || board_.pulse_player.underrun();
    const bool drives_cut = machine_.cuts_drives();
    const bool other = wants_other_.load(std::memory_order_acquire);
    if (!other && cut == cut_ && drives_cut == drives_cut_) {
        return;
    }
    if (other) {
        driven_ = wanted_;
        wants_other_.store(false, std::memory_order_relaxed);
    }
    cut_ = cut;
    drives_cut_ = drives_cut;
    OutputLevels levels = driven_;
    if (levels.follows_speed) {
        levels.spindle_pwm = laser_duty_;
    } else {
        laser_duty_ = levels.spindle_off_pwm;
    }
    if (cut) {
        levels.spindle_on = false;
        levels.spindle_reverse = false;
        levels.spindle_pwm = levels.spindle_off_pwm;
        levels.flood = false;
        levels.mist = false;
    }
    if (drives_cut) {
        levels.drives_on = 0;
    }
    board_.panel.set(levels);
}

template <class Board>
bool App<Board>::write_bytes() noexcept
{
    const Span<const std::uint8_t> pending = machine_.replies().pending();
    const std::uint32_t room = board_.byte_link.write_room();
    const std::size_t count = pending.size() < room ? pending.size() : room;
    if (count == 0) {
        return false;
    }
    board_.byte_link.write(pending.first(count));
    machine_.replies().drop(static_cast<std::uint32_t>(count));
    return true;
}

template <class Board>
void App<Board>::store_settings() noexcept
{
    if constexpr (hal::has_drive_wire<Board>) {
        // An erase stalls the core. The store doesn't wait: a program takes the same time on every board.
        if (board_.drive_wire.let_go()) {
            machine_.drives().put_off(machine_.motion().ticks());
        }
    }
    if constexpr (hal::has_spindle_wire<Board>) {
        if (board_.spindle_wire.let_go()) {
            machine_.told_vfd().put_off(machine_.motion().ticks());
        }
    }
    const machine::StoredState& stored = machine_.stored();
    machine_.store_done(log_.append(stored.bytes()));
}

}  // namespace cusp::app
