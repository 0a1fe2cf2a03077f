// Limits hold in the integer set points of every tick, whatever the program and whatever happens to
// it.
#include <cstdlib>
#include <memory>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/support/motion_rig.hpp"
#include "tests/support/random_moves.hpp"

using namespace cusp;
using cusp::test::MotionRig;
using cusp::test::RandomMoves;

namespace {

constexpr std::uint64_t kSeed = 20260;

// CUSP_MOTION_PROGRAMS sets how many random programs each test runs.
std::uint64_t program_count()
{
    const char* text = std::getenv("CUSP_MOTION_PROGRAMS");
    return text != nullptr ? std::strtoull(text, nullptr, 10) : 300;
}

void check_limits(const std::vector<Position>& samples, Position end, std::uint64_t seed)
{
    const std::string which = "seed " + std::to_string(seed);
    const test::LimitUse use = test::limit_use(samples, {}, MachineLimits{});
    for (unsigned axis = 0; axis < 3; ++axis) {
        CHECK_TEXT(use.velocity[axis] <= 1, (which + ": velocity").c_str());
        CHECK_TEXT(use.acceleration[axis] <= 1, (which + ": acceleration").c_str());
        CHECK_TEXT(use.jerk[axis] <= 1, (which + ": jerk").c_str());
    }
    CHECK_TEXT(samples.back() == end, (which + ": end").c_str());
}

}  // namespace

TEST_GROUP(MotionLimits){};

TEST(MotionLimits, HoldOverRandomPrograms)
{
    for (std::uint64_t i = 0; i < program_count(); ++i) {
        const auto moves = RandomMoves{kSeed + i}.program();
        if (moves.empty()) {
            continue;
        }
        MotionRig rig;
        rig.start_at({});
        check_limits(rig.run(moves), moves.back().end, kSeed + i);
    }
}

TEST(MotionLimits, HoldThroughHoldsOverridesAndStarvation)
{
    for (std::uint64_t i = 0; i < program_count(); ++i) {
        const auto moves = RandomMoves{kSeed + i}.program();
        if (moves.empty()) {
            continue;
        }
        MotionRig rig;
        rig.start_at({});
        const auto samples = rig.run_disturbed(moves, kSeed + i);
        check_limits(samples, moves.back().end, kSeed + i);
    }
}

TEST(MotionLimits, HoldWhenHeldAtAnyTickOfAProgram)
{
    const auto moves = RandomMoves{kSeed + 7}.program();
    MotionRig first;
    first.start_at({});
    const std::size_t ticks = first.run(moves).size();
    const std::size_t step = 1 + ticks / 2000;
    for (std::size_t tick = 0; tick < ticks; tick += step) {
        MotionRig rig;
        rig.start_at({});
        check_limits(rig.run_held(moves, tick), moves.back().end, tick);
    }
}
