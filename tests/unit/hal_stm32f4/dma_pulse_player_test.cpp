// The DMA pulse player against a model of timer, stream and port.
#include "hal/stm32f4/dma_pulse_player.hpp"

#include <cstdio>
#include <map>
#include <random>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/unit/hal_stm32f4/chip_model.hpp"

using cusp::PulseEdge;
using cusp::PulseFrame;
using cusp::test::ChipModel;
using cusp::test::ModelChip;
using cusp::test::PortChange;

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

PulseFrame pulses_at(std::initializer_list<std::uint16_t> ticks)
{
    PulseFrame frame;
    for (const std::uint16_t tick : ticks) {
        frame.edges.try_push_back({tick, 1, 0});
        frame.edges.try_push_back({static_cast<std::uint16_t>(tick + 2), 0, 1});
    }
    return frame;
}

// A frame of random edges that leaves all lines low.
PulseFrame random_frame(std::mt19937& random)
{
    PulseFrame frame;
    std::uint8_t levels = 0;
    auto tick = static_cast<std::uint32_t>(random() % 100);
    while (tick < 990) {
        const auto next = static_cast<std::uint8_t>(random() & 0x3FU);
        frame.edges.try_push_back({static_cast<std::uint16_t>(tick),
                                   static_cast<std::uint8_t>(next & ~levels),
                                   static_cast<std::uint8_t>(levels & ~next)});
        levels = next;
        tick += static_cast<std::uint32_t>(1 + random() % 60);
    }
    frame.edges.try_push_back({999, 0, levels});
    return frame;
}

void append(std::vector<PortChange>& changes, std::uint64_t start, const PulseFrame& frame)
{
    std::uint16_t levels = changes.empty() ? std::uint16_t{0} : changes.back().levels;
    for (const PulseEdge& edge : frame.edges) {
        const auto next = static_cast<std::uint16_t>((levels | edge.raise) & ~unsigned{edge.lower});
        if (next != levels) {
            changes.push_back({start + edge.tick, next});
        }
        levels = next;
    }
}

}  // namespace

TEST_GROUP(DmaPulsePlayer)
{
    ChipModel chip;
    Player player;

    void setup() override { player.start(kTimerHz, kGateHz); }

    // Runs this long; the interrupt is served at once.
    unsigned run(unsigned microseconds)
    {
        unsigned ticks = 0;
        for (unsigned i = 0; i < microseconds; ++i) {
            chip.run_microsecond();
            if (chip.interrupt_pending() && player.on_interrupt()) {
                ++ticks;
            }
        }
        return ticks;
    }
};

TEST(DmaPulsePlayer, CallsForAServoTickEachMillisecondAndPlaysSilence)
{
    LONGS_EQUAL(50, run(50000));
    CHECK_FALSE(player.underrun());
    LONGS_EQUAL(0, chip.changes.size());
}

TEST(DmaPulsePlayer, TouchesTheStreamOnlyWhileItIsOff)
{
    run(3500);
    CHECK_TRUE(player.try_play(pulses_at({0, 500})));
    run(5000);
    player.clear_underrun();
    LONGS_EQUAL(0, chip.violations);
}

TEST(DmaPulsePlayer, TakesExactlyTwoFrames)
{
    run(1100);
    CHECK_TRUE(player.try_play(pulses_at({10})));
    CHECK_FALSE(player.try_play(pulses_at({20})));
    run(1000);
    CHECK_TRUE(player.try_play(pulses_at({20})));
    CHECK_FALSE(player.try_play(pulses_at({30})));
}

TEST(DmaPulsePlayer, PlaysEachEdgeAtItsTick)
{
    run(1000);
    std::vector<PortChange> expected;
    std::mt19937 random{20240917};
    for (unsigned k = 0; k < 40; ++k) {
        const PulseFrame frame = random_frame(random);
        CHECK_TRUE(player.try_play(frame));
        append(expected, (k + 2) * 1000U, frame);
        run(1000);
    }
    run(1000);
    LONGS_EQUAL(expected.size(), chip.changes.size());
    CHECK_TRUE(expected == chip.changes);
}

TEST(DmaPulsePlayer, MissingAFrameInMotionIsAnUnderrunWithTheStepsLow)
{
    run(1000);
    PulseFrame high;
    high.edges.try_push_back({10, 0x09, 0});
    CHECK_TRUE(player.try_play(high));
    run(2000);
    CHECK_TRUE(player.underrun());
    LONGS_EQUAL(0x08, chip.changes.back().levels);
    const auto changes = chip.changes.size();
    LONGS_EQUAL(0, run(10000));
    LONGS_EQUAL(changes, chip.changes.size());
}

TEST(DmaPulsePlayer, MissingAFrameAtRestIsNone)
{
    run(1000);
    CHECK_TRUE(player.try_play(pulses_at({10})));
    run(1000);
    CHECK_TRUE(player.try_play({}));
    run(5000);
    CHECK_FALSE(player.underrun());
    LONGS_EQUAL(2, chip.changes.size());
}

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
    run(1000);
    CHECK_TRUE(player.try_play(pulses_at({10, 990})));
    run(2000);
    CHECK_TRUE(player.underrun());
    CHECK_TRUE(player.try_play(pulses_at({30})));
    player.clear_underrun();
    const auto changes = chip.changes.size();
    LONGS_EQUAL(4, run(4000));
    LONGS_EQUAL(changes, chip.changes.size());
    CHECK_TRUE(player.try_play(pulses_at({30})));
    run(2000);
    LONGS_EQUAL(changes + 2, chip.changes.size());
    LONGS_EQUAL(0, chip.violations);
}

TEST(DmaPulsePlayer, StopsOnAnErrorOfTheBus)
{
    run(1000);
    PulseFrame high;
    high.edges.try_push_back({10, 0x01, 0});
    CHECK_TRUE(player.try_play(high));
    run(1500);
    chip.raise_transfer_error();
    run(10);
    CHECK_TRUE(player.underrun());
    LONGS_EQUAL(0, chip.changes.back().levels);
}

TEST(DmaPulsePlayer, SurvivesALongHaltOfTheCoreAtRest)
{
    run(1000);
    for (unsigned i = 0; i < 800300; ++i) {
        chip.run_microsecond();
    }
    LONGS_EQUAL(1, run(1));
    CHECK_FALSE(player.underrun());
    CHECK_TRUE(player.try_play(pulses_at({10})));
    run(2000);
    LONGS_EQUAL(2, chip.changes.size());
}

TEST(DmaPulsePlayer, TakesAHaltOfTheCoreInMotionForAnUnderrun)
{
    run(1000);
    CHECK_TRUE(player.try_play(pulses_at({10})));
    run(1000);
    CHECK_TRUE(player.try_play(pulses_at({10})));
    for (unsigned i = 0; i < 2500; ++i) {
        chip.run_microsecond();
    }
    run(1);
    CHECK_TRUE(player.underrun());
}

TEST(DmaPulsePlayer, PlaysNoWordTwiceWhereTheCoreStaysAway)
{
    run(1000);
    CHECK_TRUE(player.try_play(pulses_at({100, 500, 900})));
    run(1000);
    CHECK_TRUE(player.try_play(pulses_at({200})));
    for (unsigned i = 0; i < 100000; ++i) {
        chip.run_microsecond();
    }
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
    player.start(kTimerHz, kGateHz, true);
    CHECK_TRUE(player.underrun());
    player.clear_underrun();
    CHECK_FALSE(player.underrun());
}

TEST(DmaPulsePlayer, SwapsTheLevelsOfInvertedLines)
{
    PlayerOf<InvertedTable> inverted;
    inverted.invert(0x21);
    inverted.start(kTimerHz, kGateHz);
    LONGS_EQUAL(0x21, chip.changes.back().levels);
    PulseFrame frame;
    frame.edges.try_push_back({10, 0x21, 0});
    CHECK_TRUE(inverted.try_play(frame));
    for (unsigned i = 0; i < 1100; ++i) {
        chip.run_microsecond();
    }
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
        std::vector<PortChange> expected;
        std::uint64_t interrupt_at = 0;
        std::uint64_t tick_at = 0;
        PulseFrame frame = random_frame(random);
        for (unsigned i = 0; i < 20000 && !fresh.underrun(); ++i) {
            model.run_microsecond();
            if (model.interrupt_pending() && interrupt_at == 0) {
                interrupt_at = model.now() + random() % 20;
            }
            if (interrupt_at != 0 && model.now() >= interrupt_at) {
                interrupt_at = 0;
                tick_at = fresh.on_interrupt() ? model.now() + random() % slow : tick_at;
            }
            if (tick_at != 0 && model.now() >= tick_at && !fresh.underrun()) {
                tick_at = 0;
                if (fresh.try_play(frame)) {
                    append(expected, (model.now() / 1000 + 1) * 1000, frame);
                    frame = random_frame(random);
                }
            }
        }
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
