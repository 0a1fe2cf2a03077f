// SimulatedController: the whole firmware on the simulated board, in virtual time.
//
// The order of events is fixed, so that runs repeat and the board under QEMU gives the same frames:
// poll() until it makes no more progress, then one tick(), and so on.
#pragma once

#include <optional>

#include "firmware/app/app.hpp"
#include "hal/sim/simulated_board.hpp"

namespace cusp::board_sim {

class SimulatedController {
public:
    // Powered off: the store may be filled first.
    explicit SimulatedController(const hal::MillGeometry& geometry) : board_{geometry} {}
    SimulatedController(const SimulatedController&) = delete;
    SimulatedController& operator=(const SimulatedController&) = delete;

    using App = app::App<hal::SimulatedBoard>;

    hal::SimulatedBoard& board() noexcept { return board_; }
    const hal::SimulatedBoard& board() const noexcept { return board_; }
    // Precondition: is_on().
    App& app() noexcept { return *app_; }
    const App& app() const noexcept { return *app_; }

    // The main loop until nothing more happens.
    void settle();

    // settle(), then one servo tick of the firmware and of the simulated mill.
    void tick();
    // The two halves of tick(), for callers that act between them.
    void tick_firmware();
    void tick_world() { board_.advance(); }

    // In real time: so many slices of the main loop, and a tick whatever is left to do. Returns
    // whether there is.
    bool work(unsigned slices);
    void tick_amid_work();

    bool is_on() const noexcept { return app_.has_value(); }
    // The firmware stops at once; the settings store and the position of the mill stay.
    void power_off();
    void power_on();

    // The firmware behind the App. Precondition: is_on().
    const machine::Machine& machine() const noexcept { return app_->machine(); }

private:
    hal::SimulatedBoard board_;
    std::optional<planner::PathQueue> queue_;  // empty at each power-up
    std::optional<App> app_;
    // True if poll() has nothing to do before the next tick or byte.
    bool settled_{false};
};

}  // namespace cusp::board_sim
