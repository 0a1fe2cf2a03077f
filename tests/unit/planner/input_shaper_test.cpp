#include "firmware/planner/input_shaper.hpp"

#include <cmath>
#include <complex>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"

using namespace cusp;
using namespace cusp::planner;

namespace {

constexpr double kOne = 1 << kShaperBits;

// The vibration at the end of the shaper's response to an impulse, over that without a shaper.
double left_of(const InputShaper& shaper, double frequency, double damping)
{
    const double omega = 2 * kPi * frequency * 1e-3;
    const std::complex<double> exponent{damping * omega, omega * std::sqrt(1 - damping * damping)};
    std::complex<double> product = 1;
    double ticks = 0;
    for (const ShaperStage& stage : shaper.stages) {
        product *=
            (double(stage.now) + double(stage.later) * std::exp(exponent * double(stage.ticks)) +
             double(stage.last) * std::exp(exponent * double(stage.ticks + 1))) /
            kOne;
        ticks += stage.ticks + 1;
    }
    return std::abs(product) * std::exp(-damping * omega * ticks);
}

}  // namespace

TEST_GROUP(InputShapers){};

TEST(InputShapers, AreOffByDefault)
{
    const InputShaper shaper = make_input_shaper({});
    CHECK_FALSE(shaper.on());
    UNSIGNED_LONGS_EQUAL(0, shaper.ticks);
    DOUBLES_EQUAL(0, shaper.square, 0);
}

TEST(InputShapers, HaveWeightsThatSumToOneAndAreNeverNegative)
{
    for (float frequency = 10; frequency <= 200; frequency += 0.37F) {
        for (const float damping : {0.0F, 0.01F, 0.1F, 0.3F, 0.6F, 0.9F, 0.99F}) {
            for (unsigned type = 1; type <= 3; ++type) {
                const InputShaper shaper =
                    make_input_shaper({AxisVibration{ShaperType(type), frequency, damping}});
                for (const ShaperStage& stage : shaper.stages) {
                    CHECK(stage.ticks >= 1);
                    CHECK(stage.now >= 0 && stage.later >= 0 && stage.last >= 0);
                    LONGS_EQUAL(1 << kShaperBits, stage.now + stage.later + stage.last);
                }
            }
        }
    }
}

TEST(InputShapers, RemoveTheVibrationOfEachAxis)
{
    for (double frequency = 10; frequency <= 200; frequency += 0.7) {
        for (const double damping : {0.0, 0.05, 0.3}) {
            const AxisVibration x{ShaperType::kZeroVibration, float(frequency), float(damping)};
            const AxisVibration y{ShaperType::kZeroVibrationDerivative, 61, 0.1F};
            const AxisVibration z{ShaperType::kExtraInsensitive, 120, 0.0F};
            const InputShaper shaper = make_input_shaper({x, y, z});
            UNSIGNED_LONGS_EQUAL(5, shaper.stages.size());
            CHECK(left_of(shaper, frequency, damping) < 1e-5);
            CHECK(left_of(shaper, 61, 0.1) < 1e-5);
            CHECK(left_of(shaper, 120, 0) < 0.055);
        }
    }
}

// Singhose: 5 % at the frequency and its insensitivity, none in between at two places.
TEST(InputShapers, AreInsensitiveAsPublished)
{
    const InputShaper wide =
        make_input_shaper({AxisVibration{ShaperType::kExtraInsensitive, 25, 0}});
    DOUBLES_EQUAL(0.05, left_of(wide, 25, 0), 0.004);
    for (double factor = 0.81; factor <= 1.19; factor += 0.01) {
        CHECK(left_of(wide, 25 * factor, 0) < 0.056);
    }
    const InputShaper twice =
        make_input_shaper({AxisVibration{ShaperType::kZeroVibrationDerivative, 25, 0}});
    for (double factor = 0.86; factor <= 1.14; factor += 0.01) {
        CHECK(left_of(twice, 25 * factor, 0) < 0.05);
    }
}

TEST(InputShapers, OfEqualAxesAreOne)
{
    const AxisVibration same{ShaperType::kZeroVibration, 30, 0.05F};
    UNSIGNED_LONGS_EQUAL(1, make_input_shaper({same, same, same}).stages.size());
}

// Two impulses of a half, 20 ms apart, have a variance of (10 ms)^2.
TEST(InputShapers, HaveTheMomentsOfTheirImpulses)
{
    const InputShaper shaper =
        make_input_shaper({AxisVibration{ShaperType::kZeroVibration, 25, 0}});
    UNSIGNED_LONGS_EQUAL(20, shaper.ticks);
    DOUBLES_EQUAL(1e-4, shaper.square, 1e-8);
    DOUBLES_EQUAL(0.01, shaper.mean_time, 1e-6);
    DOUBLES_EQUAL(0.010, shaper.reach, 1e-5);
}
