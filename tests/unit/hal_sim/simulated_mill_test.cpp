// Axes, switches and outputs of the virtual machine tool.
#include "hal/sim/simulated_mill.hpp"

#include "CppUTest/TestHarness.h"

#include "hal/sim/simulated_board.hpp"

namespace {

using namespace cusp;

void take_steps(hal::SimulatedMill& mill, unsigned axis, int count)
{
    PulseFrame direction;
    const PulseLines line = direction_line(axis);
    direction.edges.try_push_back(
        {0, count > 0 ? line : PulseLines{0}, count > 0 ? PulseLines{0} : line});
    mill.frame_played(0, direction);
    for (int i = 0; i < (count < 0 ? -count : count); ++i) {
        PulseFrame pulse;
        pulse.edges.try_push_back({10, step_line(axis), 0});
        pulse.edges.try_push_back({12, 0, step_line(axis)});
        mill.frame_played(0, pulse);
    }
}

hal::MillGeometry geometry()
{
    hal::MillGeometry g;
    g.steps_per_mm = {10.0, 10.0, 10.0};
    g.travel = {30.0, 20.0, 10.0};
    g.start = {-5.0, -5.0, -5.0};
    return g;
}

}  // namespace

TEST_GROUP(SimulatedMill) { hal::SimulatedMill mill{geometry()}; };

TEST(SimulatedMill, FollowsThePulses)
{
    take_steps(mill, 0, -37);
    take_steps(mill, 2, 12);
    DOUBLES_EQUAL(-8.7, mill.place().x, 1e-12);
    DOUBLES_EQUAL(-5.0, mill.place().y, 1e-12);
    DOUBLES_EQUAL(-3.8, mill.place().z, 1e-12);
    LONGS_EQUAL(37, mill.steps_taken()[0]);
}

TEST(SimulatedMill, TripsASwitchAtEachEndOfTheTravel)
{
    LONGS_EQUAL(0, mill.inputs());
    take_steps(mill, 1, 49);
    LONGS_EQUAL(0, mill.inputs());
    take_steps(mill, 1, 1);
    LONGS_EQUAL(hal::kLimitY, mill.inputs());
    take_steps(mill, 1, -199);
    LONGS_EQUAL(0, mill.inputs());
    take_steps(mill, 1, -1);
    LONGS_EQUAL(hal::kLimitY, mill.inputs());
}

TEST(SimulatedMill, TouchesThePlateFromAbove)
{
    hal::MillGeometry with_plate = geometry();
    with_plate.plate_above_start = -2.0;
    mill.set_geometry(with_plate);
    take_steps(mill, 2, -19);
    LONGS_EQUAL(0, mill.inputs());
    take_steps(mill, 2, -1);
    LONGS_EQUAL(hal::kProbe, mill.inputs());
}

TEST(SimulatedMill, ReadsAStuckSwitchAsItIsStuck)
{
    mill.force_high(hal::kLimitZ);
    LONGS_EQUAL(hal::kLimitZ, mill.inputs());
    mill.force_low(hal::kLimitZ);
    LONGS_EQUAL(0, mill.inputs());
}

TEST(SimulatedMill, SeesThePulsesOfItsBoard)
{
    hal::SimulatedBoard board{geometry()};
    PulseFrame frame;
    frame.edges.try_push_back({3, step_line(0), 0});
    board.pulse_player.try_play(frame);
    board.advance();
    board.advance();
    LONGS_EQUAL(-1, board.mill.steps()[0]);
}
