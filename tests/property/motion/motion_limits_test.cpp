// Limits hold in the integer set points of every tick, for random programs and random events during
// it.
#include "tests/judges/motion_limits.hpp"

#include <memory>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/generators/random_moves.hpp"

using namespace cusp;
using cusp::test::MotionRig;
using cusp::test::RandomMoves;

namespace {

const std::uint64_t kSeed = test::first_motion_seed(20260);

}  // namespace

TEST_GROUP(MotionLimits){};

TEST(MotionLimits, HoldOverRandomPrograms)
{
    for (std::uint64_t i = 0; i < test::motion_program_count(); ++i) {
        const auto moves = RandomMoves{kSeed + i}.program();
        if (moves.empty()) {
            continue;
        }
        const MachineLimits limits = test::random_limits(kSeed + i);
        MotionRig rig{limits};
        rig.start_at({});
        test::check_motion(rig.run(moves), moves.back().end, limits, kSeed + i);
    }
}

// The greatest speed is left a few ticks before the stop: held one tick too long, the ticks that are left
// would take more than the limits. Jerk and acceleration both bind: the filter is a whole number of ticks.
TEST(MotionLimits, HoldWhereFewTicksBrakeFromTheGreatestSpeed)
{
    for (std::uint64_t i = 0; i < 30 * test::motion_program_count(); ++i) {
        RandomMoves random{kSeed + i};
        MachineLimits limits = test::random_limits(kSeed + i);
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            const float in_a_tick = limits.acceleration[axis] * 1e-3F;
            limits.velocity[axis] = in_a_tick * static_cast<float>(random.between(0.5, 9));
            limits.jerk[axis] = limits.acceleration[axis] * 1000.5F / static_cast<float>(2 + i % 9);
        }
        path::Move move;
        move.kind = path::MoveKind::kRapid;
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            move.end[axis] = static_cast<std::int64_t>(random.between(-1e6, 1e6));
        }
        move.line = 1;
        MotionRig rig{limits};
        rig.start_at({});
        test::check_motion(rig.run({move}), move.end, limits, kSeed + i);
    }
}

TEST(MotionLimits, HoldThroughHoldsOverridesAndStarvation)
{
    for (std::uint64_t i = 0; i < test::motion_program_count(); ++i) {
        const auto moves = RandomMoves{kSeed + i}.program();
        if (moves.empty()) {
            continue;
        }
        const MachineLimits limits = test::random_limits(kSeed + i);
        MotionRig rig{limits};
        rig.start_at({});
        const auto samples = rig.run_disturbed(moves, kSeed + i);
        test::check_motion(samples, moves.back().end, limits, kSeed + i);
    }
}

TEST(MotionLimits, HoldBehindAnInputShaper)
{
    for (std::uint64_t i = 0; i < test::motion_program_count(); ++i) {
        const auto moves = RandomMoves{kSeed + i}.program();
        if (moves.empty()) {
            continue;
        }
        const MachineLimits limits = test::random_limits(kSeed + i);
        MotionRig rig{limits};
        rig.planner->set_shaper(test::random_shaper(kSeed + i));
        rig.start_at({});
        const auto samples = i % 2 == 0 ? rig.run(moves) : rig.run_disturbed(moves, kSeed + i);
        test::check_motion(samples, moves.back().end, limits, kSeed + i);
    }
}

// Arcs of 6 um behind a line of 30 mm: their limits once split it into more pieces than the servo
// reads in a tick.
TEST(MotionLimits, HoldWhereTinyArcsReachIntoALine)
{
    constexpr std::uint64_t kTinyArcs = 80942;
    const auto moves = RandomMoves{kTinyArcs}.program();
    MotionRig rig;
    rig.start_at({});
    test::check_motion(rig.run(moves), moves.back().end, {}, kTinyArcs);
}

// Disturbed programs that once were over the jerk: by a turn within a piece of 0.2 um, by a start element that
// bends, by a rest of a cell that was counted with the next.
TEST(MotionLimits, HoldWhereTheRateChangesOverShortPieces)
{
    for (const std::uint64_t seed : {71000366U, 71016607U, 71032330U}) {
        const auto moves = RandomMoves{seed}.program();
        const MachineLimits limits = test::random_limits(seed);
        MotionRig rig{limits};
        rig.start_at({});
        test::check_motion(rig.run_disturbed(moves, seed), moves.back().end, limits, seed);
    }
}

// Programs of a second each: 55 moves of all kinds within 0.01 mm, and 25 on the exact path.
TEST(MotionLimits, HoldWhateverHappensAtAnyTickOfAProgram)
{
    for (const std::uint64_t seed : {20347U, 20288U}) {
        const auto moves = RandomMoves{seed}.program();
        MotionRig first;
        first.start_at({});
        const std::size_t ticks = first.run(moves).size();
        using Event = MotionRig::Event;
        for (const Event event : {Event::kHold, Event::kSlower, Event::kFaster, Event::kStarve}) {
            for (std::size_t tick = 0; tick < ticks; ++tick) {
                MotionRig rig;
                rig.start_at({});
                test::check_motion(rig.run_struck(moves, tick, event), moves.back().end, {}, tick);
            }
        }
    }
}

TEST(MotionLimits, AHoldSlowsTheSetPointsWithinTwoTicks)
{
    path::Move line;
    line.end = {200'000'000, 0, 0};
    line.feed = 100;
    line.tolerance = 0.01F;
    MotionRig free;
    free.start_at({});
    const auto undisturbed = free.run({line});
    for (std::size_t tick = 5; tick + 160 < undisturbed.size(); tick += 7) {
        MotionRig rig;
        rig.start_at({});
        const auto held = rig.run_struck({line}, tick, MotionRig::Event::kHold);
        // While speeding up ends, acceleration falls as fast as jerk allows: nothing is slower
        // then.
        const auto speed_up = [&undisturbed](std::size_t k) {
            return undisturbed[k + 1].x - 2 * undisturbed[k].x + undisturbed[k - 1].x;
        };
        const bool already_falling = speed_up(tick) > 0 && speed_up(tick + 1) < speed_up(tick) - 40;
        const bool ends_speeding_up = speed_up(tick + 12) < speed_up(tick + 2) - 40;
        if (!already_falling && !ends_speeding_up) {
            CHECK_TEXT(held[tick + 1].x < undisturbed[tick + 1].x, std::to_string(tick).c_str());
        }
    }
}
