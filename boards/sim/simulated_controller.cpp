// Main loop, tick and power of the simulated controller.
#include "boards/sim/simulated_controller.hpp"

namespace cusp::board_sim {

void SimulatedController::settle()
{
    while (app_ && app_->poll()) {
    }
    // Replies wait only where the link has no room.
    settled_ = board_.byte_link.write_room() > 0;
}

void SimulatedController::tick()
{
    tick_firmware();
    tick_world();
}

void SimulatedController::tick_firmware()
{
    if (!settled_ || board_.byte_link.unread() > 0) {
        settle();
    }
    settled_ = false;
    if (app_) {
        app_->tick();
    }
}

bool SimulatedController::work(unsigned slices)
{
    for (unsigned i = 0; i < slices; ++i) {
        if (!app_ || !app_->poll()) {
            return false;
        }
    }
    return true;
}

void SimulatedController::tick_amid_work()
{
    settled_ = false;
    if (app_) {
        app_->tick();
    }
    tick_world();
}

void SimulatedController::power_off()
{
    app_.reset();
    board_.byte_link.clear();
    board_.pulse_player.power_off();
    board_.panel.set({});
}

void SimulatedController::power_on()
{
    if (!app_) {
        app_.emplace(board_, queue_.emplace());
        settled_ = false;
    }
}

}  // namespace cusp::board_sim
