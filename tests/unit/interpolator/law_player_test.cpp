// Travel by a time law: the place after any ticks against the integral of ds/v in long double.
#include "firmware/interpolator/law_player.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "CppUTest/TestHarness.h"

#include "firmware/base/path_units.hpp"

using namespace cusp;
using namespace cusp::interpolator;
using namespace cusp::planner;

namespace {

constexpr std::uint64_t kPlayerSeed = 4140;
constexpr int kPlayerCases = 300;

// A cell whose squared speed stays positive, passed in about 3 to 20 ticks.
LawCell any_cell(std::mt19937_64& random)
{
    const auto between = [&random](double low, double high) {
        return std::exp(
            std::uniform_real_distribution<double>{std::log(low), std::log(high)}(random));
    };
    const double v = between(0.5, 400);
    const double length = v * between(0.003, 0.02);
    const double x = v * v;
    const double part = std::uniform_real_distribution<double>{-0.4, 0.9}(random);
    const double bow = std::uniform_real_distribution<double>{-0.5, 0.8}(random);
    return {{static_cast<float>(x), static_cast<float>(part * x / length),
             static_cast<float>(bow * x / (length * length))},
            static_cast<std::uint32_t>(length * static_cast<double>(kPathUnitsPerMillimetre)),
            LawPiece::kCell};
}

// Time from the start of a cell to a place, s, by the middles of many small steps.
long double time_to(const LawCell& cell, long double place)
{
    constexpr int kSteps = 4000;
    long double time = 0;
    for (int i = 0; i < kSteps; ++i) {
        const long double s = place * (static_cast<long double>(i) + 0.5L) / kSteps;
        const long double x = static_cast<long double>(cell.start.value) +
                              s * (static_cast<long double>(cell.start.slope) +
                                   0.5L * s * static_cast<long double>(cell.start.bend));
        time += place / kSteps / std::sqrt(x);
    }
    return time;
}

}  // namespace

TEST_GROUP(LawPlayer){};

TEST(LawPlayer, is_where_the_integral_says_after_each_tick)
{
    std::mt19937_64 random{kPlayerSeed};
    for (int n = 0; n < kPlayerCases; ++n) {
        const LawCell cell = any_cell(random);
        const std::string which = "case " + std::to_string(n);
        LawPlayer player;
        player.play(cell);
        std::uint32_t gone = 0;
        double time = 0;
        while (!player.needs_cell()) {
            float left = kServoTick;
            gone += player.advance(left);
            time += static_cast<double>(kServoTick - left);
            const long double place =
                static_cast<long double>(gone) / static_cast<long double>(kPathUnitsPerMillimetre);
            // As a part of the way of a tick.
            const double late = time - static_cast<double>(time_to(cell, place));
            CHECK_TEXT(std::fabs(late) < 2e-3 * static_cast<double>(kServoTick), which.c_str());
        }
        LONGS_EQUAL(cell.travel, gone);
    }
}

TEST(LawPlayer, elements_start_and_stop_with_constant_jerk)
{
    constexpr double kJerk = 25000;
    constexpr double kLength = 0.05;
    const double time = std::cbrt(6 * kLength / kJerk);
    const double speed = kJerk * time * time / 2;
    for (const LawPiece piece : {LawPiece::kStart, LawPiece::kStop}) {
        const LawCell cell{{static_cast<float>(speed * speed), 0, 0},
                           static_cast<std::uint32_t>(kLength * 16e6),
                           piece};
        LawPlayer player;
        player.play(cell);
        std::uint32_t gone = 0;
        double at = 0;
        while (!player.needs_cell()) {
            float left = kServoTick;
            gone += player.advance(left);
            at = std::min(at + static_cast<double>(kServoTick), time);
            const double from_rest = piece == LawPiece::kStart ? at : time - at;
            const double way = kJerk * from_rest * from_rest * from_rest / 6;
            const double place = piece == LawPiece::kStart ? way : kLength - way;
            DOUBLES_EQUAL(place, static_cast<double>(gone) / 16e6, 4e-8);
        }
        LONGS_EQUAL(cell.travel, gone);
    }
}

TEST(LawPlayer, time_left_by_a_cell_is_for_the_next)
{
    std::mt19937_64 random{kPlayerSeed + 1};
    const LawCell cell = any_cell(random);
    LawPlayer player;
    player.play(cell);
    float left = 10.0F;
    LONGS_EQUAL(cell.travel, player.advance(left));
    CHECK(player.needs_cell());
    const long double whole = static_cast<long double>(cell.travel) / 16e6L;
    DOUBLES_EQUAL(10.0 - static_cast<double>(time_to(cell, whole)), static_cast<double>(left),
                  2e-5);
}

// v - w t^2/2 down to half of v, then w (2 t - t')^2/2 to rest.
TEST(LawPlayer, a_brake_and_a_stop_bring_a_steady_speed_to_rest)
{
    constexpr double kJerk = 12500;
    constexpr double kSpeed = 2.2;
    const double time = std::sqrt(kSpeed / kJerk);
    const auto cell = [&](double speed, double way, LawPiece piece) {
        return LawCell{{static_cast<float>(speed * speed), 0, 0},
                       static_cast<std::uint32_t>(way * 16e6 + 0.5),
                       piece};
    };
    LawPlayer player;
    player.play(cell(kSpeed, kSpeed * time * 5 / 6, LawPiece::kBrake));
    bool brakes = true;
    std::uint32_t gone = 0;
    double at = 0;
    while (!player.needs_cell()) {
        float left = kServoTick;
        gone += player.advance(left);
        if (player.needs_cell() && brakes) {
            player.play(cell(kSpeed / 2, kSpeed * time / 6, LawPiece::kStop));
            brakes = false;
            gone += player.advance(left);
        }
        at = std::min(at + static_cast<double>(kServoTick), 2 * time);
        const double to_rest = 2 * time - at;
        const double way = at < time ? kSpeed * at - kJerk * at * at * at / 6
                                     : kSpeed * time - kJerk * to_rest * to_rest * to_rest / 6;
        DOUBLES_EQUAL(way, static_cast<double>(gone) / 16e6, 2e-7);
    }
    CHECK(!brakes);
    DOUBLES_EQUAL(0, static_cast<double>(player.speed()), 0);
}

// Some nanometres from rest, over which the speed changes by as much as itself: the series turns back
// within a tick.
TEST(LawPlayer, cells_shorter_than_a_tick_end)
{
    std::mt19937_64 random{kPlayerSeed + 2};
    std::uniform_real_distribution<float> part{0, 1};
    for (int n = 0; n < 2000; ++n) {
        const float speed = 1e-3F + 0.2F * part(random);
        const auto travel = static_cast<std::uint32_t>(1 + random() % 100);
        const float length = static_cast<float>(travel) / 16e6F;
        // From x to at least a tenth of it at the end, falling all the way.
        const float fall = 0.9F * part(random) * speed * speed;
        const float bend = part(random) * fall / (length * length);
        const LawCell cell{
            {speed * speed, -fall / length - 0.5F * bend * length, bend}, travel, LawPiece::kCell};
        LawPlayer player;
        player.play(cell);
        std::uint32_t gone = 0;
        int ticks = 0;
        while (!player.needs_cell() && ticks < 1000) {
            float left = kServoTick;
            gone += player.advance(left);
            CHECK(left >= 0 && left <= kServoTick);
            ++ticks;
        }
        CHECK(player.needs_cell());
        LONGS_EQUAL(travel, gone);
    }
}
