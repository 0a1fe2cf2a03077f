// SimulatedBoard: the four parts of the simulated controller, wired to the simulated mill.
#pragma once

#include "hal/contract/board.hpp"
#include "hal/sim/simulated_link.hpp"
#include "hal/sim/simulated_mill.hpp"
#include "hal/sim/simulated_player.hpp"
#include "hal/sim/simulated_store.hpp"

namespace cusp::hal {

// The mill as the firmware sees it.
class SimulatedPanel {
public:
    explicit SimulatedPanel(SimulatedMill& mill) noexcept : mill_{&mill} {}
    std::uint16_t inputs() const noexcept { return mill_->inputs(); }
    void set(const OutputLevels& levels) noexcept { mill_->set(levels); }
    void set_duty(std::uint16_t pwm) noexcept { mill_->set_duty(pwm); }

private:
    SimulatedMill* mill_;
};

static_assert(is_panel<SimulatedPanel>());

// Neither copied nor moved: its parts point at each other.
struct SimulatedBoard {
    explicit SimulatedBoard(const MillGeometry& geometry) : mill{geometry}, panel{mill}
    {
        pulse_player.add_listener(mill);
    }
    SimulatedBoard(const SimulatedBoard&) = delete;
    SimulatedBoard& operator=(const SimulatedBoard&) = delete;

    // Advances mill and serial line by one servo tick. Call after the firmware's tick().
    void advance()
    {
        pulse_player.advance();
        byte_link.advance();
    }

    // Bounded by the pulse's width alone.
    static constexpr std::uint32_t kMostStepsPerSecond = 1000000;
    static constexpr bool kSecondMotor = true;
    static constexpr bool kAtSpeedInput = true;

    SimulatedMill mill;
    SimulatedPlayer pulse_player;
    SimulatedLink byte_link;
    SimulatedPanel panel;
    SimulatedStore settings_store;
};

static_assert(is_board<SimulatedBoard>());

}  // namespace cusp::hal
