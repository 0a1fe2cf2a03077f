// The DMA pulse player against a model of timer, stream and port.
#include "hal/stm32f4/dma_pulse_player.hpp"

#include <cstdio>
#include <random>
#include <vector>

#include "tests/unit/hal_stm32f4/chip_model.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "tests/support/pulse_player_case.hpp"

using cusp::PulseFrame;
using cusp::test::ChipModel;
using cusp::test::ModelChip;
using cusp::test::PinChange;
using cusp::test::PulsePlayerCase;
using cusp::test::pulses_at;
using cusp::test::raised_at;

namespace {

constexpr std::uint32_t kTimerHz = 168000000;
constexpr std::uint32_t kGateHz = 84000000;

struct Table {
    static constexpr cusp::hal::stm32f4::LinePins kLines{
        {{'C', 0}, {'C', 1}, {'C', 2}, {'C', 3}, {'C', 4}, {'C', 5}}};
};
// A type of its own, since a player's inversion is a static.
struct InvertedTable : Table {};
template <class Table>
using PlayerOf =
    cusp::hal::stm32f4::DmaPulsePlayer<ModelChip, Table, cusp::hal::stm32f4::Timer8Pace<ModelChip>>;
using Player = PlayerOf<Table>;
static_assert(cusp::hal::is_pulse_player<Player>());

struct OnChip {
    using Model = ChipModel;
    using Player = PlayerOf<Table>;
    static constexpr unsigned kBehind = 0;
    static constexpr std::uint32_t kLowered = 0x3F;
    static std::uint32_t pins_of(std::uint32_t lines) { return lines; }
    static void start(Player& player, bool in_motion = false)
    {
        player.start(kTimerHz, kGateHz, in_motion);
    }
};

}  // namespace

TEST_GROUP_BASE(DmaPulsePlayer, PulsePlayerCase<OnChip>){};

TEST(DmaPulsePlayer, CallsForAServoTickEachMillisecondAndPlaysSilence)
{
    calls_for_a_tick_each_millisecond_and_plays_silence();
}

TEST(DmaPulsePlayer, TouchesTheStreamOnlyWhileItIsOff)
{
    run(3500);
    CHECK_TRUE(player.try_play(pulses_at({0, 500})));
    run(5000);
    player.clear_underrun();
    LONGS_EQUAL(0, chip.violations);
}

TEST(DmaPulsePlayer, TakesExactlyTwoFrames) { takes_exactly_two_frames(); }

TEST(DmaPulsePlayer, PlaysEachEdgeAtItsTick) { plays_each_edge_at_its_tick(); }

TEST(DmaPulsePlayer, MissingAFrameInMotionIsAnUnderrunWithTheStepsLow)
{
    missing_a_frame_in_motion_is_an_underrun_with_the_steps_low();
}

TEST(DmaPulsePlayer, MissingAFrameAtRestIsNone) { missing_a_frame_at_rest_is_none(); }

TEST(DmaPulsePlayer, RefusesAFrameThatComesTooLateInsteadOfTearingIt)
{
    run(1990);
    CHECK_FALSE(player.try_play(pulses_at({0, 100})));
    run(20);
    CHECK_FALSE(player.underrun());
    CHECK_TRUE(player.try_play(pulses_at({0, 100})));
    run(2000);
    LONGS_EQUAL(4, chip.changes.size());
}

TEST(DmaPulsePlayer, StartsOnSilenceAfterAnUnderrunIsCleared)
{
    starts_on_silence_after_an_underrun_is_cleared();
}

TEST(DmaPulsePlayer, StopsOnAnErrorOfTheBus)
{
    run(1000);
    const PulseFrame high = raised_at(10, 0x01);
    CHECK_TRUE(player.try_play(high));
    run(1500);
    chip.raise_transfer_error();
    run(10);
    CHECK_TRUE(player.underrun());
    LONGS_EQUAL(0, chip.changes.back().levels);
}

TEST(DmaPulsePlayer, SurvivesALongHaltOfTheCoreAtRest)
{
    survives_a_long_halt_of_the_core_at_rest();
}

TEST(DmaPulsePlayer, TakesAHaltOfTheCoreInMotionForAnUnderrun)
{
    run(1000);
    CHECK_TRUE(player.try_play(pulses_at({10})));
    run(1000);
    CHECK_TRUE(player.try_play(pulses_at({10})));
    run_alone(2500);
    run(1);
    CHECK_TRUE(player.underrun());
}

TEST(DmaPulsePlayer, PlaysNoWordTwiceWhereTheCoreStaysAway)
{
    run(1000);
    CHECK_TRUE(player.try_play(pulses_at({100, 500, 900})));
    run(1000);
    CHECK_TRUE(player.try_play(pulses_at({200})));
    run_alone(100000);
    // The half that plays to its end, and no more.
    LONGS_EQUAL(6, chip.changes.size());
}

TEST(DmaPulsePlayer, TurnsInvertedLinesRoundInASilence)
{
    run(1000);
    player.invert(0x09);
    CHECK_TRUE(player.try_play(pulses_at({10})));
    run(1000);
    CHECK_TRUE(player.try_play({}));
    run(1000);
    LONGS_EQUAL(2, chip.changes.size());
    CHECK_TRUE(player.try_play({}));
    LONGS_EQUAL(0x09, chip.changes.back().levels);
    run(1000);
    player.invert(0);
    CHECK_TRUE(player.try_play({}));
    LONGS_EQUAL(0x00, chip.changes.back().levels);
}

TEST(DmaPulsePlayer, TakesAResetAmidMotionForAnUnderrun)
{
    takes_a_reset_amid_motion_for_an_underrun();
}

TEST(DmaPulsePlayer, SwapsTheLevelsOfInvertedLines)
{
    PlayerOf<InvertedTable> inverted;
    inverted.invert(0x21);
    inverted.start(kTimerHz, kGateHz);
    LONGS_EQUAL(0x21, chip.changes.back().levels);
    const PulseFrame frame = raised_at(10, 0x21);
    CHECK_TRUE(inverted.try_play(frame));
    run_alone(1100);
    LONGS_EQUAL(0x00, chip.changes.back().levels);
}

// For all delays of interrupt and servo tick: the frames taken are played, in
// order, each edge once and at its tick; a frame cut short is reported.
TEST(DmaPulsePlayer, PlaysWhatItTookOrSaysSoWhateverTheDelays)
{
    const unsigned seed = 4711;
    std::printf(" seed %u", seed);
    std::mt19937 random{seed};
    unsigned underruns = 0;
    for (unsigned round = 0; round < 200; ++round) {
        ChipModel model;
        Player fresh;
        fresh.start(kTimerHz, kGateHz);
        const unsigned slow = round % 4 == 0 ? 1200 : 800;
        std::vector<PinChange> expected;
        run_late(model, fresh, random, 20, slow, [&](const PulseFrame& frame) {
            append(expected, (model.now() / 1000 + 1) * 1000, frame);
        });
        underruns += fresh.underrun() ? 1U : 0U;
        CHECK_TRUE(model.changes.size() <= expected.size());
        expected.resize(model.changes.size());
        CHECK_TRUE(expected == model.changes);
        LONGS_EQUAL(0, model.violations);
        CHECK_TRUE(slow == 1200 || !fresh.underrun());
    }
    CHECK_TRUE(underruns > 0);
}

TEST_GROUP(ChipModel) { ChipModel chip; };

TEST(ChipModel, CountsAChangeOfTheStreamWhileItRuns)
{
    Player player;
    player.start(kTimerHz, kGateHz);
    LONGS_EQUAL(0, chip.violations);
    ModelChip::dma2().stream[1].ndtr.write(12);
    LONGS_EQUAL(1, chip.violations);
    LONGS_EQUAL(2000, ModelChip::dma2().stream[1].ndtr.read());
}

TEST(ChipModel, CountsAStartWithFlagsLeftSet)
{
    Player player;
    player.start(kTimerHz, kGateHz);
    for (unsigned i = 0; i < 1500; ++i) {
        chip.run_microsecond();
    }
    auto& control = ModelChip::dma2().stream[1].cr;
    const std::uint32_t settings = control.read();
    control.write(0);
    control.write(settings);
    LONGS_EQUAL(1, chip.violations);
}
