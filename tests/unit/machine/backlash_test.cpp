// Backlash against a model of a screw with play: limits of the motors, lag of the slides; and the virtual mill.
#include "firmware/machine/backlash.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/generators/random_moves.hpp"
#include "tests/support/controller_bench.hpp"
#include "tests/support/motion_rig.hpp"
#include "tests/support/property_cases.hpp"

using namespace cusp;
using machine::Backlash;

namespace {

// The slide of an axis: it follows its motor once the play is used up, nm.
class Screw {
public:
    Screw(std::int64_t play, std::int64_t slide) : play_{play}, slide_{slide} {}
    std::int64_t follow(std::int64_t motor)
    {
        slide_ = std::clamp(slide_, motor, motor + play_);
        return slide_;
    }

private:
    std::int64_t play_;
    std::int64_t slide_;
};

// 1 if the way goes towards plus at first, -1 towards minus, 0 if it stays.
int first_side(const std::vector<Position>& way, unsigned axis)
{
    for (const Position& at : way) {
        if (std::llabs(at[axis]) > Backlash::kTurn) {
            return at[axis] > 0 ? 1 : -1;
        }
    }
    return 0;
}

constexpr std::uint64_t kSeed = 20260716;
// Seeds of random programs.
std::uint64_t programs() { return static_cast<std::uint64_t>(test::property_cases(60)); }

struct Followed {
    std::vector<Position> way;
    std::vector<Position> motors;
    AxisVecf play;
};

Followed follow_program(std::uint64_t seed, Backlash& backlash)
{
    test::RandomMoves random{seed};
    const auto moves = random.program();
    const MachineLimits limits = test::random_limits(seed);
    Followed followed;
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        followed.play[axis] = axis == seed % 4 ? 0 : static_cast<float>(random.between(0.002, 0.4));
    }
    test::MotionRig rig{Backlash::left_of(limits, followed.play)};
    rig.start_at({});
    if (!moves.empty()) {
        followed.way = rig.run_disturbed(moves, seed);
    }
    backlash.configure(followed.play, limits);
    backlash.rest({});
    for (const Position& way : followed.way) {
        followed.motors.push_back(backlash.follow(way));
    }
    for (unsigned i = 0; i < 5000 && !backlash.idle(); ++i) {
        followed.motors.push_back(backlash.follow(followed.way.back()));
        followed.way.push_back(followed.way.back());
    }
    CHECK(backlash.idle());
    return followed;
}

}  // namespace

TEST_GROUP(Backlash){};

TEST(Backlash, HoldsTheLimitsOfTheMotors)
{
    for (std::uint64_t seed = kSeed; seed < kSeed + programs(); ++seed) {
        Backlash backlash;
        const Followed followed = follow_program(seed, backlash);
        const test::LimitUse use =
            test::limit_use(followed.motors, {}, test::random_limits(seed), 2);
        const std::string which = "seed " + std::to_string(seed);
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            CHECK_TEXT(use.velocity[axis] <= 1, (which + ": velocity").c_str());
            CHECK_TEXT(use.acceleration[axis] <= 1, (which + ": acceleration").c_str());
            CHECK_TEXT(use.jerk[axis] <= 1, (which + ": jerk").c_str());
        }
    }
}

// Every slide is where the way is, but for the play while a turn is being taken up.
TEST(Backlash, LeavesAnAxisThatTheMachineLacksTheLimitsOfX)
{
    const MachineLimits limits{};
    AxisVecf play{};
    play[0] = 0.05F;
    const MachineLimits left = Backlash::left_of(limits, play);
    CHECK(left.velocity[0] < limits.velocity[0]);
    for (unsigned axis = kLinearAxes; axis < kAxisCount; ++axis) {
        DOUBLES_EQUAL(left.velocity[0], left.velocity[axis], 0);
        DOUBLES_EQUAL(left.acceleration[0], left.acceleration[axis], 0);
        DOUBLES_EQUAL(left.jerk[0], left.jerk[axis], 0);
    }
}

TEST(Backlash, LeavesTheSlidesWhereTheWayIsButForTheTimeOfATurn)
{
    std::uint64_t turns = 0;
    for (std::uint64_t seed = kSeed; seed < kSeed + programs(); ++seed) {
        Backlash backlash;
        const Followed followed = follow_program(seed, backlash);
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            const std::int64_t play = std::lround(followed.play[axis] * 1e6F);
            int side = first_side(followed.way, axis);
            // It touches on that side already.
            const std::int64_t offset = side < 0 ? play : 0;
            Screw screw{play, offset};
            std::int64_t extreme = 0;
            long long worst = 0;
            long long worst_later = 0;
            std::size_t taken_up = 0;  // at this tick, what has turned so far
            for (std::size_t i = 0; i < followed.way.size(); ++i) {
                const std::int64_t way = followed.way[i][axis];
                const std::int64_t slide = screw.follow(followed.motors[i][axis]);
                if ((way - extreme) * side > 0) {
                    extreme = way;
                } else if ((way - extreme) * side < -Backlash::kTurn) {
                    side = -side;
                    extreme = way;
                    // It waits for the one before.
                    taken_up = std::max(i, taken_up) + backlash.take_up_ticks(axis);
                    ++turns;
                }
                const long long lag = std::llabs(slide - offset - way);
                worst = std::max(worst, lag);
                worst_later = std::max(worst_later, i <= taken_up ? 0 : lag);
            }
            CHECK(worst <= play + Backlash::kTurn + 2);
            CHECK(worst_later <= Backlash::kTurn + 2);
        }
    }
    CHECK(turns > 17 * programs());
}

TEST(Backlash, StopsAtOnceAndTakesUpTheRestOnceTheWayGoesOn)
{
    Backlash backlash;
    const MachineLimits limits;
    backlash.configure({0.1F, 0, 0}, limits);
    backlash.rest({});
    (void)backlash.follow({1000, 0, 0});
    Position last{};
    const auto ticks = static_cast<unsigned>(backlash.take_up_ticks(0));
    for (unsigned i = 0; i < ticks / 2; ++i) {
        last = backlash.follow({-1000, 0, 0});
        CHECK_FALSE(backlash.idle());
    }
    const Position stopped = last;
    backlash.stop();
    CHECK(backlash.idle());
    for (unsigned i = 0; i < 10; ++i) {
        CHECK(backlash.follow({-1000, 0, 0}) == stopped);
    }
    for (unsigned i = 0; i <= ticks; ++i) {
        last = backlash.follow({-2000 - static_cast<std::int64_t>(i), 0, 0});
    }
    LONGS_EQUAL(-2000 - static_cast<std::int64_t>(ticks) - 100000, last.x);
}

namespace {

struct MillWithPlay : ControllerBench {
    MillWithPlay() : ControllerBench{geometry(), settings()} { (void)exchange("$X\n"); }
    static hal::MillGeometry geometry()
    {
        hal::MillGeometry geometry;
        geometry.play = {0.08, 0.05, 0.12};
        geometry.start = {-20, -30, -10};
        return geometry;
    }
    static machine::Settings settings()
    {
        machine::Settings settings;
        CHECK(!settings.put(22, 1) && !settings.put(24, 100) && !settings.put(25, 3000));
        CHECK(!settings.put(26, 5));
        CHECK(!settings.put(160, 0.08F) && !settings.put(161, 0.05F) && !settings.put(162, 0.12F));
        return settings;
    }
    std::string say(const std::string& text)
    {
        board.byte_link.send(text);
        return finish();
    }
    void check_place(Vec3d offset = {})
    {
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            DOUBLES_EQUAL(position()[axis] + offset[axis], board.mill.place()[axis], kAccuracy);
        }
    }
    static constexpr double kAccuracy = 1.5 / 800 + 100.0 / 60 / 1000;  // of a switch: a tick
};

}  // namespace

// The way turns by less than what is taken up, and turns again before that is done: the slide is behind
// the way once both are over.
TEST(Backlash, ATurnBackDuringATakeUpEndsOnTheSideOfTheWay)
{
    constexpr float kPlay = 0.1F;
    for (unsigned wait = 1; wait < 200; ++wait) {
        Backlash backlash;
        backlash.configure({kPlay, 0, 0}, MachineLimits{});
        backlash.rest({});
        Position way{};
        Screw slide{100'000, -100'000};
        const auto go = [&](std::int64_t step, unsigned ticks) {
            std::int64_t at = 0;
            for (unsigned i = 0; i < ticks; ++i) {
                way.x += step;
                at = slide.follow(backlash.follow(way).x);
            }
            return at;
        };
        go(2000, 50);
        go(-2000, wait);  // turns; the take-up goes on while the way turns twice more
        go(2000, 3);
        go(-2000, 3);
        const std::int64_t at = go(-2000, 2 * backlash.take_up_ticks(0) + 10);
        CHECK_TEXT(std::llabs(at - way.x) <= Backlash::kTurn, std::to_string(wait).c_str());
    }
}

TEST(Backlash, IsNotSeenAtTheSlidesOfAHomedMill)
{
    MillWithPlay mill;
    CHECK(has_text(mill.say("$H\n"), "ok"));
    mill.check_place();
    for (const char* line : {"G53 G0 X-20 Y-30 Z-5\n", "G53 G1 X-10 F3000\n", "G53 G1 X-12 Y-20\n",
                             "G53 G1 Z-8\n", "G53 G1 X-11 Y-30 Z-7.9\n", "G91 G2 I4 F2000\n"}) {
        CHECK(has_text(mill.say(line), "ok"));
        mill.check_place();
    }
    // Homed again from the other side: the same place.
    (void)mill.say("G90 G53 G0 X-3 Y-3 Z-3\nG53 G0 X-2.9 Y-3.1 Z-2.9\n");
    CHECK(has_text(mill.say("$H\n"), "ok"));
    mill.check_place();
}

TEST(Backlash, IsSeenWithoutTheSetting)
{
    MillWithPlay mill;
    (void)mill.say("$H\n");
    (void)mill.exchange("$160=0\n", 400);
    (void)mill.say("G53 G0 X-20\nG53 G0 X-10\n");
    DOUBLES_EQUAL(-10.08, mill.board.mill.place().x, MillWithPlay::kAccuracy);
}

// No step comes after what a stop leaves over, whenever it comes; and the play is right again thereafter.
TEST(Backlash, EndsWithAStop)
{
    for (unsigned after = 1; after < 90; after += 8) {
        MillWithPlay mill;
        (void)mill.say("$H\nG53 G0 X-20\nG53 G0 X-10\n");
        (void)mill.exchange("G53 G1 X-10.3 F6000\n", after);
        (void)mill.exchange("\x18", 8);
        const std::uint64_t taken = mill.board.mill.steps_taken()[0];
        mill.run(200);
        LONGS_EQUAL(taken, mill.board.mill.steps_taken()[0]);
        (void)mill.say("$X\nG53 G0 X-20\n");
        mill.check_place();
        (void)mill.say("G53 G0 X-15\n");
        mill.check_place();
    }
}
