// The vibration left after a move, with each shaper and without, and its cost in time.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/support/motion_rig.hpp"
#include "tests/support/oscillator.hpp"

using namespace cusp;
using cusp::planner::AxisVibration;
using cusp::planner::make_input_shaper;
using cusp::planner::ShaperType;
using cusp::test::MotionRig;
using cusp::test::Oscillator;
using cusp::test::residual_vibration;

namespace {

struct Outcome {
    double vibration{0};  // mm, the most after any of the moves
    std::size_t ticks{0};
};

// Moves of X from rest to rest, 1 to 60 mm long.
Outcome play(const AxisVibration& shaped, const Oscillator& oscillator)
{
    Outcome outcome;
    for (double length = 1; length < 60; length *= 1.23) {
        path::Move move;
        move.end = to_position({length, 0, 0});
        move.feed = 100;
        move.tolerance = 0.01F;
        MotionRig rig;
        rig.planner->set_shaper(make_input_shaper({shaped, {}, {}}));
        rig.start_at({});
        const auto samples = rig.run({move});
        CHECK(samples.back() == move.end);
        outcome.vibration = std::max(outcome.vibration, residual_vibration(samples, 0, oscillator));
        outcome.ticks = samples.size();
    }
    return outcome;
}

const char* name_of(ShaperType type)
{
    constexpr const char* kNames[] = {"none", "ZV", "ZVD", "EI"};
    return kNames[static_cast<unsigned>(type)];
}

// The part of the vibration left by a shaper when the machine's frequency is `factor` times the one
// that it is set to.
double part_left(ShaperType type, float frequency, float damping, double factor)
{
    const Oscillator oscillator{static_cast<double>(frequency) * factor,
                                static_cast<double>(damping)};
    const Outcome plain = play({}, oscillator);
    const Outcome shaped = play({type, frequency, damping}, oscillator);
    const double part = shaped.vibration / plain.vibration;
    std::printf(
        "%4s %5.1f Hz, damping %.2f, machine at %4.1f %%: %8.5f mm of %8.5f mm left, "
        "%5.2f %%; %zu ms longer\n",
        name_of(type), static_cast<double>(frequency), static_cast<double>(damping), 100.0 * factor,
        shaped.vibration, plain.vibration, 100.0 * part, shaped.ticks - plain.ticks);
    return part;
}

constexpr ShaperType kTypes[] = {ShaperType::kZeroVibration, ShaperType::kZeroVibrationDerivative,
                                 ShaperType::kExtraInsensitive};

}  // namespace

TEST_GROUP(Vibration){};

// Extra insensitive shapers let 5 % pass at the frequency on purpose.
TEST(Vibration, IsGoneAtTheFrequency)
{
    for (const ShaperType type : kTypes) {
        for (const float frequency : {18.7F, 33.0F, 41.0F, 62.0F}) {
            for (const float damping : {0.0F, 0.05F, 0.2F}) {
                const double most = type == ShaperType::kExtraInsensitive ? 0.07 : 0.01;
                CHECK(part_left(type, frequency, damping, 1.0) < most);
            }
        }
    }
}

TEST(Vibration, IsSmallWhereTheFrequencyIsNotKnownWell)
{
    for (const double factor : {0.9, 1.1}) {
        CHECK(part_left(ShaperType::kZeroVibration, 33.0F, 0.02F, factor) < 0.2);
        CHECK(part_left(ShaperType::kZeroVibrationDerivative, 33.0F, 0.02F, factor) < 0.04);
        CHECK(part_left(ShaperType::kExtraInsensitive, 33.0F, 0.02F, factor) < 0.06);
    }
    for (const double factor : {0.8, 1.2}) {
        CHECK(part_left(ShaperType::kZeroVibrationDerivative, 33.0F, 0.02F, factor) < 0.13);
        CHECK(part_left(ShaperType::kExtraInsensitive, 33.0F, 0.02F, factor) < 0.08);
    }
}

TEST(Vibration, OfTwoAxesIsGoneInBoth)
{
    const AxisVibration x{ShaperType::kZeroVibration, 31.0F, 0.03F};
    const AxisVibration y{ShaperType::kZeroVibration, 37.0F, 0.05F};
    path::Move move;
    move.end = {23'000'000, 21'000'000, 0};
    move.feed = 100;
    const auto vibration = [&](const planner::InputShaper& shaper, unsigned axis) {
        MotionRig rig;
        rig.planner->set_shaper(shaper);
        rig.start_at({});
        const Oscillator oscillator{axis == 0 ? 31.0 : 37.0, axis == 0 ? 0.03 : 0.05};
        return residual_vibration(rig.run({move}), axis, oscillator);
    };
    for (const unsigned axis : {0U, 1U}) {
        const double plain = vibration({}, axis);
        CHECK(plain > 1e-3);
        CHECK(vibration(make_input_shaper({x, y, {}}), axis) < 0.01 * plain);
    }
}
