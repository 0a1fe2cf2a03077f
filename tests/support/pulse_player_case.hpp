// Tests that every pulse player passes, on a model of its chip, and frames for them.
//
//     struct OnChip {
//         using Model = ChipModel;                        // run_microsecond(), interrupt_pending(), now(), changes, violations
//         using Player = PlayerOf<Table>;
//         static constexpr unsigned kBehind = 0;          // us by which a frame is behind its interrupt
//         static constexpr std::uint32_t kLowered = 0x3F; // lines that random frames leave low
//         static std::uint32_t pins_of(std::uint32_t lines);
//         static void start(Player& player, bool in_motion = false);
//     };
//     TEST_GROUP_BASE(Player, PulsePlayerCase<OnChip>) {};
//     TEST(Player, TakesExactlyTwoFrames) { takes_exactly_two_frames(); }
#pragma once

#include <cstdint>
#include <initializer_list>
#include <random>
#include <vector>

#include "firmware/base/pulse_frame.hpp"
#include "tests/support/pin_change.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

inline PulseFrame pulses_at(std::initializer_list<std::uint16_t> ticks)
{
    PulseFrame frame;
    for (const std::uint16_t tick : ticks) {
        frame.edges.try_push_back({tick, 1, 0});
        frame.edges.try_push_back({static_cast<std::uint16_t>(tick + 2), 0, 1});
    }
    return frame;
}

inline PulseFrame raised_at(std::uint16_t tick, std::uint8_t lines)
{
    PulseFrame frame;
    frame.edges.try_push_back({tick, lines, 0});
    return frame;
}

template <class OnChip>
struct PulsePlayerCase : Utest {
    typename OnChip::Model chip;
    typename OnChip::Player player;

    void setup() override
    {
        OnChip::start(player);
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

    // The core does nothing meanwhile.
    void run_alone(unsigned microseconds)
    {
        for (unsigned i = 0; i < microseconds; ++i) {
            chip.run_microsecond();
        }
    }

    // Until the interrupt: the begin of what the model calls a frame.
    void run_to_interrupt()
    {
        while (run(1) == 0) {
        }
    }

    // A frame of random edges; directions stay as they come.
    //
    // lines  levels before it, and after it
    static PulseFrame random_frame(std::mt19937& random, std::uint32_t& lines)
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
        frame.edges.try_push_back({999, 0, static_cast<std::uint8_t>(lines & OnChip::kLowered)});
        lines &= ~OnChip::kLowered;
        return frame;
    }

    static void append(std::vector<PinChange>& changes,
                       std::uint64_t start,
                       const PulseFrame& frame)
    {
        std::uint32_t levels = changes.empty() ? 0 : changes.back().levels;
        for (const PulseEdge& edge : frame.edges) {
            const std::uint32_t next =
                (levels | OnChip::pins_of(edge.raise)) & ~OnChip::pins_of(edge.lower);
            if (next != levels) {
                changes.push_back({start + edge.tick, next});
            }
            levels = next;
        }
    }

    void calls_for_a_tick_each_millisecond_and_plays_silence()
    {
        LONGS_EQUAL(50, run(50000));
        CHECK_FALSE(player.underrun());
        LONGS_EQUAL(0, chip.changes.size());
        LONGS_EQUAL(0, chip.violations);
    }

    void takes_exactly_two_frames()
    {
        run(1100);
        CHECK_TRUE(player.try_play(pulses_at({10})));
        CHECK_FALSE(player.try_play(pulses_at({20})));
        run(1000);
        CHECK_TRUE(player.try_play(pulses_at({20})));
        CHECK_FALSE(player.try_play(pulses_at({30})));
    }

    void plays_each_edge_at_its_tick()
    {
        run_to_interrupt();
        std::vector<PinChange> expected;
        std::mt19937 random{20240917};
        std::uint32_t lines = 0;
        for (unsigned k = 0; k < 40; ++k) {
            const PulseFrame frame = random_frame(random, lines);
            CHECK_TRUE(player.try_play(frame));
            append(expected, chip.now() + 1000 + OnChip::kBehind, frame);
            run(1000);
        }
        CHECK_TRUE(player.try_play({}));
        run(2000);
        CHECK_FALSE(player.underrun());
        LONGS_EQUAL(expected.size(), chip.changes.size());
        CHECK_TRUE(expected == chip.changes);
        LONGS_EQUAL(0, chip.violations);
    }

    void missing_a_frame_in_motion_is_an_underrun_with_the_steps_low()
    {
        run_to_interrupt();
        CHECK_TRUE(player.try_play(raised_at(10, 0x09)));
        run(2100);
        CHECK_TRUE(player.underrun());
        LONGS_EQUAL(OnChip::pins_of(0x08), chip.changes.back().levels);
        const auto changes = chip.changes.size();
        LONGS_EQUAL(0, run(10000));
        LONGS_EQUAL(changes, chip.changes.size());
        LONGS_EQUAL(0, chip.violations);
    }

    void missing_a_frame_at_rest_is_none()
    {
        run_to_interrupt();
        CHECK_TRUE(player.try_play(pulses_at({10})));
        run(1000);
        CHECK_TRUE(player.try_play({}));
        run(5000);
        CHECK_FALSE(player.underrun());
        LONGS_EQUAL(2, chip.changes.size());
    }

    void starts_on_silence_after_an_underrun_is_cleared()
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

    void survives_a_long_halt_of_the_core_at_rest()
    {
        run_to_interrupt();
        run_alone(800300);
        LONGS_EQUAL(1, run(1));
        CHECK_FALSE(player.underrun());
        CHECK_TRUE(player.try_play(pulses_at({10})));
        run(1000);
        CHECK_TRUE(player.try_play({}));
        run(1100);
        LONGS_EQUAL(2, chip.changes.size());
    }

    void takes_a_reset_amid_motion_for_an_underrun()
    {
        OnChip::start(player, true);
        CHECK_TRUE(player.underrun());
        player.clear_underrun();
        CHECK_FALSE(player.underrun());
    }

    // A player whose interrupt and servo tick are late, for 20 ms: `taken(frame)` for each frame it took.
    //
    // late, slow  us, most, of the interrupt, and of the tick after it
    template <class Taken>
    static void run_late(typename OnChip::Model& model,
                         typename OnChip::Player& fresh,
                         std::mt19937& random,
                         unsigned late,
                         unsigned slow,
                         const Taken& taken)
    {
        std::uint32_t lines = 0;
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
                    taken(frame);
                    frame = random_frame(random, lines);
                }
            }
        }
    }
};

}  // namespace cusp::test
