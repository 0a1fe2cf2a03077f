// The PIO pulse player against a model of channel, state machine and pins.
#include "hal/rp2350/pio_pulse_player.hpp"

#include <cstdio>
#include <random>
#include <vector>

#include "tests/unit/hal_rp2350/pico_model.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "tests/support/pulse_player_case.hpp"

using cusp::PulseFrame;
using cusp::hal::rp2350::GP;
using cusp::test::PicoChip;
using cusp::test::PicoModel;
using cusp::test::PinChange;
using cusp::test::PulsePlayerCase;
using cusp::test::pulses_at;
using cusp::test::raised_at;

namespace {

constexpr std::uint32_t kCoreHz = 150000000;

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

struct OnChip {
    using Model = PicoModel;
    using Player = PlayerOf<ScatteredTable>;
    // The words of the queue, and the one that plays.
    static constexpr unsigned kBehind = 9;
    static constexpr std::uint32_t kLowered = 7;
    static std::uint32_t pins_of(std::uint32_t lines) { return ::pins_of(lines); }
    static void start(Player& player, bool in_motion = false) { player.start(kCoreHz, in_motion); }
};

}  // namespace

TEST_GROUP_BASE(PioPulsePlayer, PulsePlayerCase<OnChip>){};

TEST(PioPulsePlayer, CallsForAServoTickEachMillisecondAndPlaysSilence)
{
    calls_for_a_tick_each_millisecond_and_plays_silence();
}

TEST(PioPulsePlayer, TakesExactlyTwoFrames) { takes_exactly_two_frames(); }

TEST(PioPulsePlayer, PlaysEachEdgeAtItsTickBackToBack) { plays_each_edge_at_its_tick(); }

TEST(PioPulsePlayer, MissingAFrameInMotionIsAnUnderrunWithTheStepsLow)
{
    missing_a_frame_in_motion_is_an_underrun_with_the_steps_low();
}

TEST(PioPulsePlayer, MissingAFrameAtRestIsNone) { missing_a_frame_at_rest_is_none(); }

TEST(PioPulsePlayer, StartsOnSilenceAfterAnUnderrunIsCleared)
{
    starts_on_silence_after_an_underrun_is_cleared();
}

TEST(PioPulsePlayer, KeepsDirectionsOverAnUnderrun)
{
    run_to_interrupt();
    const PulseFrame frame = raised_at(10, 0x21);
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
    const PulseFrame high = raised_at(10, 0x01);
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
    const PulseFrame high = raised_at(990, 0x09);
    CHECK_TRUE(player.try_play(high));
    run(1000);
    CHECK_TRUE(player.try_play(pulses_at({200})));
    run_alone(100000);
    // Up, and down at the end of the frame; the frame after it does not play.
    LONGS_EQUAL(2, chip.changes.size());
    LONGS_EQUAL(10, chip.changes[1].microsecond - chip.changes[0].microsecond);
    LONGS_EQUAL(pins_of(0x08), chip.changes[1].levels);
    run(1);
    CHECK_TRUE(player.underrun());
}

TEST(PioPulsePlayer, SurvivesALongHaltOfTheCoreAtRest)
{
    survives_a_long_halt_of_the_core_at_rest();
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
    const PulseFrame frame = raised_at(10, 0x49);
    CHECK_TRUE(inverted.try_play(frame));
    for (unsigned i = 0; i < 1500; ++i) {
        chip.run_microsecond();
        if (chip.interrupt_pending()) {
            inverted.on_interrupt();
        }
    }
    LONGS_EQUAL(0x08U << 2U, chip.levels() & 0x3FCU);
    run_alone(3000);
    LONGS_EQUAL(0x49U << 2U, chip.levels() & 0x3FCU);
    inverted.stop();
    LONGS_EQUAL(0x49U << 2U, chip.levels() & 0x3FCU);
}

TEST(PioPulsePlayer, TakesAResetAmidMotionForAnUnderrun)
{
    takes_a_reset_amid_motion_for_an_underrun();
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
        std::vector<PulseFrame> taken;
        run_late(model, fresh, random, late, slow,
                 [&](const PulseFrame& frame) { taken.push_back(frame); });
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
        // A frame that an underrun cuts short ends with the steps low.
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
