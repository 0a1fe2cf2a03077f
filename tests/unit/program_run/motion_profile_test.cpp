// Profiles against the statistics of the same set points.
#include "host_tools/controller/program_run/motion_profile.hpp"

#include <algorithm>
#include <cmath>

#include "CppUTest/TestHarness.h"

#include "host_tools/controller/program_run/motion_statistics.hpp"

using namespace cusp;
using program_run::MotionProfile;
using program_run::ProfileStretch;

namespace {

// A swing of the X axis that grows with time.
Position swing(int tick)
{
    return {static_cast<std::int64_t>(1000.0 * tick * std::sin(0.01 * tick)), tick, 0};
}

}  // namespace

TEST_GROUP(MotionProfile){};

TEST(MotionProfile, HasAStretchATickWhileTheyAreFew)
{
    MotionProfile profile;
    for (int tick = 0; tick <= 100; ++tick) {
        profile.add(swing(tick), 7);
    }
    LONGS_EQUAL(100, profile.stretches().size());
    DOUBLES_EQUAL(0.001, profile.seconds_each(), 1e-12);
    DOUBLES_EQUAL(0.1, profile.seconds(), 1e-12);
    DOUBLES_EQUAL(0.001, profile.stretches()[50].velocity.y, 1e-12);
    LONGS_EQUAL(7, profile.stretches()[50].first_line);
}

TEST(MotionProfile, KeepsTheGreatestOfEachStretchHoweverLong)
{
    constexpr int kTicks = 100'000;
    MotionProfile profile;
    program_run::MotionStatistics statistics{swing(0)};
    profile.add(swing(0), 0);
    for (int tick = 1; tick <= kTicks; ++tick) {
        profile.add(swing(tick), static_cast<std::uint32_t>(tick));
        statistics.add(swing(tick));
    }
    CHECK(profile.stretches().size() <= MotionProfile::kMostStretches);
    CHECK(profile.stretches().size() > MotionProfile::kMostStretches / 2);
    ProfileStretch greatest;
    for (const ProfileStretch& stretch : profile.stretches()) {
        greatest.velocity.x = std::max(greatest.velocity.x, stretch.velocity.x);
        greatest.acceleration.x = std::max(greatest.acceleration.x, stretch.acceleration.x);
        greatest.jerk.x = std::max(greatest.jerk.x, stretch.jerk.x);
    }
    DOUBLES_EQUAL(statistics.max_velocity().x, greatest.velocity.x, 1e-6);
    DOUBLES_EQUAL(statistics.max_acceleration().x, greatest.acceleration.x, 1e-6);
    DOUBLES_EQUAL(statistics.max_jerk().x, greatest.jerk.x, 1e-3);
    const auto each = static_cast<std::uint32_t>(std::lround(profile.seconds_each() * 1000));
    LONGS_EQUAL(10 * each + 1, profile.stretches()[10].first_line);
}
