// App: the whole controller as one object over a Board; the only place where firmware meets a HAL.
//
//   Board board;
//   App<Board> app{board};
//   main loop:   while (true) { app.poll(); }
//   servo tick:  app.tick();          every time a pulse frame has been played, lower priority
//
// Nothing here reads a clock: time is counted in servo ticks. The same bytes, in the same order
// with the ticks, give the same frames on every board and in the simulator.
#pragma once

#include "hal/contract/board.hpp"

namespace cusp::app {

template <class Board>
class App {
    static_assert(hal::is_board<Board>());

public:
    // Loads the settings and says hello on the line. The board must outlive the App.
    explicit App(Board& board) noexcept;

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
};

}  // namespace cusp::app
