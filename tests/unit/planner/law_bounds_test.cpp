// Packed bounds are no less than what they stand for, and hardly more.
#include "firmware/planner/law_bounds.hpp"

#include <cmath>
#include <random>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::planner;

namespace {

constexpr std::uint64_t kBoundsSeed = 4242;
constexpr int kBoundsCases = 20'000;
constexpr float kPart = 0.01F;    // of a float that is packed
constexpr float kStep = 1e-4F;    // of the jerk
constexpr float kCoarse = 8e-3F;  // of the acceleration

}  // namespace

TEST_GROUP(PackedBounds){};

TEST(PackedBounds, are_outward_and_near)
{
    std::mt19937_64 random{kBoundsSeed};
    std::uniform_real_distribution<float> signed_share{-1.9F, 1.9F};
    std::uniform_real_distribution<float> of_plan{-kPlanShare, kPlanShare};
    std::uniform_real_distribution<float> share{0.0F, 1.9F};
    std::uniform_real_distribution<float> power{-12.0F, 3.0F};
    const auto vector_of = [&random](auto& numbers) {
        return AxisVecf{numbers(random), numbers(random), numbers(random)};
    };
    for (int n = 0; n < kBoundsCases; ++n) {
        const AxisVecf exponents = vector_of(power);
        const AxisVecf speed{std::exp(exponents.x), std::exp(exponents.y),
                             n % 7 == 0 ? 0 : std::exp(exponents.z)};
        const AxisVecf braking = vector_of(of_plan);
        const AxisVecf speeding = vector_of(of_plan);
        const AxisVecf falling = vector_of(signed_share);
        const AxisVecf rising = vector_of(signed_share);
        const AxisVecf joint = vector_of(share);
        const float time = std::exp(power(random));
        const WarpBounds bounds = PackedBounds{
            {to_lanes(speed), to_lanes(braking), to_lanes(speeding), to_lanes(falling),
             to_lanes(rising), to_lanes(joint),
             time}}.unpacked();
        for (unsigned i = 0; i < kAxisCount; ++i) {
            const float packed_speed = to_vec(bounds.speed)[i];
            CHECK(packed_speed >= speed[i] && packed_speed <= speed[i] * (1.0F + kPart) + 1e-30F);
            const float packed_braking = to_vec(bounds.braking)[i];
            CHECK(packed_braking <= braking[i] && packed_braking >= braking[i] - kCoarse);
            const float packed_speeding = to_vec(bounds.speeding)[i];
            CHECK(packed_speeding >= speeding[i] && packed_speeding <= speeding[i] + kCoarse);
            const float packed_falling = to_vec(bounds.falling)[i];
            CHECK(packed_falling <= falling[i] && packed_falling >= falling[i] - kStep);
            const float packed_rising = to_vec(bounds.rising)[i];
            CHECK(packed_rising >= rising[i] && packed_rising <= rising[i] + kStep);
            const float packed_joint = to_vec(bounds.joint)[i];
            CHECK(packed_joint >= joint[i] && packed_joint <= joint[i] + kStep);
        }
        // A shorter time is the careful one.
        CHECK(bounds.time <= time && bounds.time >= time * (1.0F - kPart));
    }
}
