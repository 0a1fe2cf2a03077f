// The differences of wide cores: marks of ticks with edges, and the steps of several axes at once.
#include <cmath>
#include <random>
#include <set>

#include "CppUTest/TestHarness.h"

#include "firmware/pulse/edge_marks.hpp"
#include "firmware/pulse/steady_lanes.hpp"
#include "firmware/pulse/step_writer.hpp"

using namespace cusp;
using pulse::EdgeMarks;
using pulse::SteadyLanes;
using pulse::StepTimes;

TEST_GROUP(EdgeMarks){};

TEST(EdgeMarks, AreTakenInOrderAndTheLaterOnesMoveUp)
{
    constexpr std::uint32_t kTicks = 1512;
    std::mt19937_64 random{20261125};
    EdgeMarks<true, kTicks> marks;
    std::set<std::uint32_t> expected;
    for (int frame = 0; frame < 1000; ++frame) {
        for (auto i = random() % 300; i > 0; --i) {
            const auto tick = static_cast<std::uint32_t>(random() % kTicks);
            marks.mark(static_cast<std::int32_t>(tick));
            expected.insert(tick);
        }
        const auto end = static_cast<std::uint32_t>(frame % 3 == 0 ? random() % 1001 : 1000);
        auto next = expected.begin();
        marks.take(end, [&](std::uint32_t tick) {
            CHECK(next != expected.end());
            UNSIGNED_LONGS_EQUAL(*next, tick);
            ++next;
        });
        CHECK(next == expected.lower_bound(end));
        std::set<std::uint32_t> later;
        for (; next != expected.end(); ++next) {
            later.insert(*next - end);
        }
        expected = later;
    }
}

TEST_GROUP(SteadyLanes){};

// Bit by bit, at even speeds as well.
TEST(SteadyLanes, AreTheStepsOfEachAxis)
{
    std::mt19937_64 random{20261126};
    const auto between = [&random](double low, double high) {
        return static_cast<float>(std::uniform_real_distribution<double>{low, high}(random));
    };
    int runs = 0;
    for (int i = 0; i < 20000; ++i) {
        SteadyLanes lanes;
        StepTimes times[kAxisCount] = {{{}, true}, {{}, true}, {{}, true}, {{}, true}};
        bool all_steady = true;
        const bool even = i % 2 == 0;
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            const float sign = random() % 2 == 0 ? 1.0F : -1.0F;
            // Whole steps, so that no rounding bends an even speed.
            const float travel = sign * (even ? std::floor(between(10, 200)) : between(10, 200));
            const float bend = even ? 0.0F : between(-1e-3, 1e-3);
            const pulse::TickTravels travels{travel, 0, 0, travel - bend, travel + 2 * bend};
            times[axis] = StepTimes{travels.cubic_from(between(-0.5, 0.5)), sign > 0};
            static_cast<void>(times[axis].next());
            all_steady = all_steady && times[axis].steady();
            lanes.put(axis, times[axis]);
        }
        if (!all_steady) {
            continue;
        }
        ++runs;
        CHECK(!even || lanes.even());
        for (int step = 0; step < 7; ++step) {
            const SteadyLanes::Ticks ticks = lanes.even() ? lanes.next_even() : lanes.next();
            for (unsigned axis = 0; axis < kAxisCount; ++axis) {
                LONGS_EQUAL(pulse::to_pulse_tick(times[axis].next_steady()), ticks[axis]);
            }
        }
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            StepTimes back = times[axis];
            lanes.take(axis, back);
            CHECK(back.next_steady() == times[axis].next_steady());
        }
    }
    CHECK(runs > 15000);
}
