// The PIO pulse player against a model of channel, state machine and pins.
#include "hal/rp2350/pio_pulse_player.hpp"

#include <cstdio>
#include <random>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/unit/hal_rp2350/pico_model.hpp"

using cusp::PulseEdge;
using cusp::PulseFrame;
using cusp::hal::rp2350::GP;
using cusp::test::PicoChip;
using cusp::test::PicoModel;
using cusp::test::PinChange;

namespace {

constexpr std::uint32_t kCoreHz = 150000000;
// A frame is behind its interrupt by the words of the queue, and the one that plays.
constexpr unsigned kBehind = 9;

// The lines lie apart and in no order.
struct ScatteredTable {
    static constexpr cusp::hal::rp2350::LinePins kLines{
        {GP(9), GP(4), GP(6), GP(17), GP(2), GP(12)}};
};
struct OrderedTable {
    static constexpr cusp::hal::rp2350::LinePins kLines{
        {GP(2), GP(3), GP(4), GP(5), GP(6), GP(7), GP(8), GP(9)}};
};
template <class Table>
using PlayerOf = cusp::hal::rp2350::PioPulsePlayer<PicoChip, Table>;
using Player = PlayerOf<ScatteredTable>;
static_assert(cusp::hal::is_pulse_player<Player>());

std::uint32_t pins_of(std::uint32_t lines)
{
    std::uint32_t pins = 0;
    for (unsigned line = 0; line < 6; ++line) {
        pins |= (lines >> line & 1U) << ScatteredTable::kLines[line].number;
    }
    return pins;
}

PulseFrame pulses_at(std::initializer_list<std::uint16_t> ticks)
{
    PulseFrame frame;
    for (const std::uint16_t tick : ticks) {
        frame.edges.try_push_back({tick, 1, 0});
        frame.edges.try_push_back({static_cast<std::uint16_t>(tick + 2), 0, 1});
    }
    return frame;
}

// A frame of random edges that leaves the steps low, and directions as they come.
PulseFrame random_frame(std::mt19937& random, std::uint32_t& lines)
{
    PulseFrame frame;
    auto tick = static_cast<std::uint32_t>(random() % 100);
    while (tick < 990) {
        const std::uint32_t next = random() & 0x3FU;
        frame.edges.try_push_back({static_cast<std::uint16_t>(tick),
                                   static_cast<std::uint8_t>(next & ~lines),
                                   static_cast<std::uint8_t>(lines & ~next)});
        lines = next;
        tick += 1 + static_cast<std::uint32_t>(random() % 60);
    }
    frame.edges.try_push_back({999, 0, static_cast<std::uint8_t>(lines & 7U)});
    lines &= ~7U;
    return frame;
}

void append(std::vector<PinChange>& changes, std::uint64_t start, const PulseFrame& frame)
{
    std::uint32_t levels = changes.empty() ? 0 : changes.back().levels;
    for (const PulseEdge& edge : frame.edges) {
        const std::uint32_t next = (levels | pins_of(edge.raise)) & ~pins_of(edge.lower);
        if (next != levels) {
            changes.push_back({start + edge.tick, next});
        }
        levels = next;
    }
}

}  // namespace

TEST_GROUP(PioPulsePlayer)
{
    PicoModel chip;
    Player player;

    void setup() override
    {
        player.start(kCoreHz);
        chip.changes.clear();
    }
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
    // Until the interrupt: the begin of what the model calls a frame.
    void run_to_interrupt()
    {
        while (run(1) == 0) {
        }
    }
};

TEST(PioPulsePlayer, CallsForAServoTickEachMillisecondAndPlaysSilence)
{
    LONGS_EQUAL(50, run(50000));
    CHECK_FALSE(player.underrun());
    LONGS_EQUAL(0, chip.changes.size());
    LONGS_EQUAL(0, chip.violations);
}

TEST(PioPulsePlayer, TakesExactlyTwoFrames)
{
    run(1100);
    CHECK_TRUE(player.try_play(pulses_at({10})));
    CHECK_FALSE(player.try_play(pulses_at({20})));
    run(1000);
    CHECK_TRUE(player.try_play(pulses_at({20})));
    CHECK_FALSE(player.try_play(pulses_at({30})));
}

TEST(PioPulsePlayer, PlaysEachEdgeAtItsTickBackToBack)
{
    run_to_interrupt();
    std::vector<PinChange> expected;
    std::mt19937 random{20240917};
    std::uint32_t lines = 0;
    for (unsigned k = 0; k < 40; ++k) {
        const PulseFrame frame = random_frame(random, lines);
        CHECK_TRUE(player.try_play(frame));
        append(expected, chip.now() + 1000 + kBehind, frame);
        run(1000);
    }
    CHECK_TRUE(player.try_play({}));
    run(2000);
    CHECK_FALSE(player.underrun());
    LONGS_EQUAL(expected.size(), chip.changes.size());
    CHECK_TRUE(expected == chip.changes);
    LONGS_EQUAL(0, chip.violations);
}

TEST(PioPulsePlayer, MissingAFrameInMotionIsAnUnderrunWithTheStepsLow)
{
    run_to_interrupt();
    PulseFrame high;
    high.edges.try_push_back({10, 0x09, 0});
    CHECK_TRUE(player.try_play(high));
    run(2100);
    CHECK_TRUE(player.underrun());
    LONGS_EQUAL(pins_of(0x08), chip.changes.back().levels);
    const auto changes = chip.changes.size();
    LONGS_EQUAL(0, run(10000));
    LONGS_EQUAL(changes, chip.changes.size());
    LONGS_EQUAL(0, chip.violations);
}

TEST(PioPulsePlayer, MissingAFrameAtRestIsNone)
{
    run_to_interrupt();
    CHECK_TRUE(player.try_play(pulses_at({10})));
    run(1000);
    CHECK_TRUE(player.try_play({}));
    run(5000);
    CHECK_FALSE(player.underrun());
    LONGS_EQUAL(2, chip.changes.size());
}

TEST(PioPulsePlayer, StartsOnSilenceAfterAnUnderrunIsCleared)
{
    run_to_interrupt();
    CHECK_TRUE(player.try_play(pulses_at({10, 990})));
    run(2100);
    CHECK_TRUE(player.underrun());
    CHECK_TRUE(player.try_play(pulses_at({30})));
    player.clear_underrun();
    const auto changes = chip.changes.size();
    LONGS_EQUAL(4, run(4000));
    LONGS_EQUAL(changes, chip.changes.size());
    CHECK_TRUE(player.try_play(pulses_at({30})));
    run(1000);
    CHECK_TRUE(player.try_play({}));
    run(1100);
    LONGS_EQUAL(changes + 2, chip.changes.size());
    LONGS_EQUAL(0, chip.violations);
}

TEST(PioPulsePlayer, KeepsDirectionsOverAnUnderrun)
{
    run_to_interrupt();
    PulseFrame frame;
    frame.edges.try_push_back({10, 0x21, 0});
    CHECK_TRUE(player.try_play(frame));
    run(2100);
    CHECK_TRUE(player.underrun());
    player.clear_underrun();
    run(2000);
    LONGS_EQUAL(pins_of(0x20), chip.changes.back().levels);
    LONGS_EQUAL(pins_of(0x20), chip.levels() & pins_of(0x3F));
}

TEST(PioPulsePlayer, StopsOnAnErrorOfTheBus)
{
    run_to_interrupt();
    PulseFrame high;
    high.edges.try_push_back({10, 0x01, 0});
    CHECK_TRUE(player.try_play(high));
    run(1500);
    CHECK_TRUE(player.try_play({}));
    chip.raise_bus_error();
    run(600);
    CHECK_TRUE(player.underrun());
    LONGS_EQUAL(0, chip.changes.back().levels);
    player.clear_underrun();
    LONGS_EQUAL(5, run(5000));
    CHECK_FALSE(player.underrun());
}

TEST(PioPulsePlayer, LowersTheStepsByItselfWhereTheCoreStaysAway)
{
    run_to_interrupt();
    PulseFrame high;
    high.edges.try_push_back({990, 0x09, 0});
    CHECK_TRUE(player.try_play(high));
    run(1000);
    CHECK_TRUE(player.try_play(pulses_at({200})));
    for (unsigned i = 0; i < 100000; ++i) {
        chip.run_microsecond();
    }
    // Up, and down at the end of the frame; the frame after it does not play.
    LONGS_EQUAL(2, chip.changes.size());
    LONGS_EQUAL(10, chip.changes[1].microsecond - chip.changes[0].microsecond);
    LONGS_EQUAL(pins_of(0x08), chip.changes[1].levels);
    run(1);
    CHECK_TRUE(player.underrun());
}

TEST(PioPulsePlayer, SurvivesALongHaltOfTheCoreAtRest)
{
    run_to_interrupt();
    for (unsigned i = 0; i < 800300; ++i) {
        chip.run_microsecond();
    }
    LONGS_EQUAL(1, run(1));
    CHECK_FALSE(player.underrun());
    CHECK_TRUE(player.try_play(pulses_at({10})));
    run(1000);
    CHECK_TRUE(player.try_play({}));
    run(1100);
    LONGS_EQUAL(2, chip.changes.size());
}

TEST(PioPulsePlayer, TurnsInvertedLinesRoundInASilence)
{
    run_to_interrupt();
    player.invert(0x09);
    CHECK_TRUE(player.try_play(pulses_at({10})));
    run(1000);
    CHECK_TRUE(player.try_play({}));
    run(1100);
    LONGS_EQUAL(2, chip.changes.size());
    CHECK_TRUE(player.try_play({}));
    run(1000);
    LONGS_EQUAL(3, chip.changes.size());
    LONGS_EQUAL(pins_of(0x09), chip.changes.back().levels);
    CHECK_TRUE(player.try_play(pulses_at({10})));
    run(1000);
    CHECK_TRUE(player.try_play({}));
    run(1100);
    LONGS_EQUAL(5, chip.changes.size());
    LONGS_EQUAL(pins_of(0x08), chip.changes[3].levels);
    player.invert(0);
    run(1000);
}

TEST(PioPulsePlayer, LeavesInvertedStepsHighWhereAFrameIsMissing)
{
    PlayerOf<OrderedTable> inverted;
    inverted.invert(0x41);
    inverted.start(kCoreHz);
    LONGS_EQUAL(0x41U << 2U, chip.levels() & 0x3FCU);
    PulseFrame frame;
    frame.edges.try_push_back({10, 0x49, 0});
    CHECK_TRUE(inverted.try_play(frame));
    for (unsigned i = 0; i < 1500; ++i) {
        chip.run_microsecond();
        if (chip.interrupt_pending()) {
            inverted.on_interrupt();
        }
    }
    LONGS_EQUAL(0x08U << 2U, chip.levels() & 0x3FCU);
    for (unsigned i = 0; i < 3000; ++i) {
        chip.run_microsecond();
    }
    LONGS_EQUAL(0x49U << 2U, chip.levels() & 0x3FCU);
    inverted.stop();
    LONGS_EQUAL(0x49U << 2U, chip.levels() & 0x3FCU);
}

TEST(PioPulsePlayer, TakesAResetAmidMotionForAnUnderrun)
{
    player.start(kCoreHz, true);
    CHECK_TRUE(player.underrun());
    player.clear_underrun();
    CHECK_FALSE(player.underrun());
}

// For all delays of interrupt and servo tick: the frames taken are played, in order, each edge once and at its tick, back to
// back or after whole silences; a frame cut short is reported.
TEST(PioPulsePlayer, PlaysWhatItTookOrSaysSoWhateverTheDelays)
{
    const unsigned seed = 4711;
    std::printf(" seed %u", seed);
    std::mt19937 random{seed};
    unsigned underruns = 0;
    for (unsigned round = 0; round < 100; ++round) {
        PicoModel model;
        Player fresh;
        fresh.start(kCoreHz);
        model.changes.clear();
        const unsigned slow = round % 4 == 0 ? 1200 : 800;
        const unsigned late = round % 5 == 0 ? 12 : 6;
        std::uint32_t lines = 0;
        std::vector<PulseFrame> taken;
        std::uint64_t interrupt_at = 0;
        std::uint64_t tick_at = 0;
        PulseFrame frame = random_frame(random, lines);
        for (unsigned i = 0; i < 20000 && !fresh.underrun(); ++i) {
            model.run_microsecond();
            if (model.interrupt_pending() && interrupt_at == 0) {
                interrupt_at = model.now() + random() % late;
            }
            if (interrupt_at != 0 && model.now() >= interrupt_at) {
                interrupt_at = 0;
                tick_at = fresh.on_interrupt() ? model.now() + random() % slow : tick_at;
            }
            if (tick_at != 0 && model.now() >= tick_at && !fresh.underrun()) {
                tick_at = 0;
                if (fresh.try_play(frame)) {
                    taken.push_back(frame);
                    frame = random_frame(random, lines);
                }
            }
        }
        underruns += fresh.underrun() ? 1U : 0U;
        // The first begins whenever it was taken, the next exactly a frame later.
        std::vector<PinChange> expected;
        std::uint64_t start = 0;
        for (const PulseFrame& one : taken) {
            append(expected, start, one);
            start += 1000;
        }
        for (auto at = expected.rbegin(); at != expected.rend() && !model.changes.empty(); ++at) {
            at->microsecond += model.changes[0].microsecond - expected[0].microsecond;
        }
        // What an underrun leaves out ends with the steps low.
        auto& changes = model.changes;
        const bool cut = fresh.underrun() && !changes.empty() &&
                         changes.size() <= expected.size() &&
                         !(changes.back() == expected[changes.size() - 1]);
        if (cut) {
            CHECK_EQUAL(0U, changes.back().levels & pins_of(7));
            changes.pop_back();
        }
        CHECK_TRUE(changes.size() <= expected.size());
        expected.resize(changes.size());
        CHECK_TRUE(expected == changes);
        LONGS_EQUAL(0, model.violations);
        CHECK_TRUE(slow == 1200 || late == 12 || !fresh.underrun());
    }
    CHECK_TRUE(underruns > 0);
    PicoModel::current = &chip;
}

TEST_GROUP(PicoModel) { PicoModel chip; };

TEST(PicoModel, CountsAChangeOfTheChannelWhileItRuns)
{
    Player player;
    player.start(kCoreHz);
    LONGS_EQUAL(0, chip.violations);
    PicoChip::dma().channel[0].count.write(12);
    LONGS_EQUAL(1, chip.violations);
}

TEST(PicoModel, CountsAnAbortOfAChannelThatIsOn)
{
    Player player;
    player.start(kCoreHz);
    PicoChip::dma().abort.write(1);
    LONGS_EQUAL(1, chip.violations);
}
