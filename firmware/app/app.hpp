// App: the whole controller as one object over a Board; the only place where firmware meets a HAL.
//
//   Board board;
//   planner::PathQueue queue;
//   App<Board> app{board, queue};
//   main loop:   while (true) { app.poll(); }
//   servo tick:  app.tick();          every time a pulse frame has been played, lower priority
//
// Nothing here reads a clock: time is counted in servo ticks. The same bytes, in the same order
// with the ticks, give the same frames on every board and in the simulator.
#pragma once

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
        : board_{board},
          log_{board.settings_store},
          machine_{queue, factory, {Board::kMostStepsPerSecond, Board::kSecondMotor}}
    {
        machine_.start(log_.load(machine_.stored().bytes()));
        set_outputs(machine_.outputs());
    }
    App(const App&) = delete;
    App& operator=(const App&) = delete;

    // One slice of the main loop: takes bytes from the link, executes lines, fills the planner,
    // answers, keeps settings. A slice is short (a few dozen bytes or one move), so that realtime
    // bytes and the tick are never kept waiting.
    //
    // Returns whether it made progress. Where it did not, nothing more happens until a byte
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
    bool read_bytes() noexcept;
    bool write_bytes() noexcept;
    void store_settings() noexcept;
    void set_outputs(const OutputLevels& outputs) noexcept
    {
        outputs_ = outputs;
        board_.panel.set(outputs);
        board_.pulse_player.invert(outputs.inverted_lines);
    }

    Board& board_;
    machine::SettingsLog<decltype(Board::settings_store)> log_;
    machine::Machine machine_;
    OutputLevels outputs_;
    PulseFrame frame_;
    bool frame_waits_{false};
};

template <class Board>
bool App<Board>::poll() noexcept
{
    const bool read = read_bytes();
    if (board_.pulse_player.underrun()) {
        machine_.frame_missed();
        board_.pulse_player.clear_underrun();
    }
    const bool worked = machine_.poll();
    const OutputLevels outputs = machine_.outputs();
    if (!(outputs == outputs_)) {
        set_outputs(outputs);
    }
    const bool stores = machine_.wants_store();
    if (stores) {
        store_settings();
    }
    return write_bytes() || read || worked || stores;
}

template <class Board>
void App<Board>::tick() noexcept
{
    if (!frame_waits_) {
        frame_.edges.clear();
        machine_.tick(board_.panel.inputs(), frame_);
    }
    frame_waits_ = !board_.pulse_player.try_play(frame_);
}

template <class Board>
bool App<Board>::read_bytes() noexcept
{
    constexpr unsigned kBytesPerSlice = 64;
    if (board_.byte_link.overrun()) {
        machine_.bytes_lost();
    }
    std::uint8_t byte = 0;
    unsigned count = 0;
    while (count < kBytesPerSlice && board_.byte_link.try_read(byte)) {
        machine_.receive(byte);
        ++count;
    }
    return count > 0;
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
    const machine::StoredState& stored = machine_.stored();
    machine_.store_done(log_.append(stored.bytes()));
}

}  // namespace cusp::app
