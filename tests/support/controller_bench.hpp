// ControllerBench: the whole firmware on the simulated board, driven byte by byte and tick by tick.
#pragma once

#include <string>
#include <string_view>

#include "firmware/app/app.hpp"
#include "hal/sim/simulated_board.hpp"

namespace cusp {

// True if what the controller sent contains a text.
inline bool has_text(const std::string& answers, const std::string& text)
{
    return answers.find(text) != std::string::npos;
}

class ControllerBench {
public:
    explicit ControllerBench(const hal::MillGeometry& geometry = {},
                             const machine::Settings& factory = {})
        : board{geometry}, factory_{factory}, app{board, queue, &factory_}
    {
    }

    // Runs the main loop until it is idle, then one servo tick; `ticks` times.
    void run(unsigned ticks)
    {
        poll();
        for (unsigned i = 0; i < ticks; ++i) {
            app.tick();
            board.advance();
            poll();
        }
    }

    // Sends bytes, runs `ticks` ticks, and returns the controller's output.
    std::string exchange(std::string_view bytes, unsigned ticks = 20)
    {
        board.byte_link.send(bytes);
        run(ticks);
        return board.byte_link.take_answers();
    }

    // Runs until nothing moves and no line waits, at most `most_ticks`; returns the output.
    std::string finish(unsigned most_ticks = 200000)
    {
        unsigned ticks = 0;
        do {
            run(1);
            ++ticks;
        } while (ticks < most_ticks && !(app.machine().idle() && board.byte_link.unread() == 0));
        return board.byte_link.take_answers();
    }

    // Machine position, mm.
    Vec3d position() const { return xyz(to_millimetres(app.machine().motion().position())); }
    // Degrees of the rotary axis.
    double turned() const { return to_millimetres(app.machine().motion().position())[kLinearAxes]; }

    hal::SimulatedBoard board;
    planner::PathQueue queue;

private:
    const machine::Settings factory_;

public:
    app::App<hal::SimulatedBoard> app;

private:
    void poll()
    {
        // The bound turns an endless slice into a failure instead of a hang.
        constexpr unsigned kMostSlices = 1000000;
        for (unsigned i = 0; i < kMostSlices; ++i) {
            if (!app.poll()) {
                return;
            }
        }
        CUSP_ASSERT(false);
    }
};

}  // namespace cusp
