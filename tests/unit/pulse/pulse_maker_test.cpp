#include "firmware/pulse/pulse_maker.hpp"

#include <cmath>
#include <random>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/pulse/step_times.hpp"

using namespace cusp;
using cusp::pulse::PulseMaker;
using cusp::pulse::StepSettings;

namespace {

struct Edge {
    std::int64_t time;
    PulseLines raise, lower;
};

// Plays set points to rest and collects all edges on one clock.
struct Player {
    explicit Player(const StepSettings& settings) : maker{settings} { maker.reset({}); }

    void play(Position at)
    {
        maker.make_frame(at, frame);
        for (const PulseEdge& edge : frame.edges) {
            edges.push_back({clock + edge.tick, edge.raise, edge.lower});
        }
        clock += kPulseTicksPerFrame;
        last = at;
    }
    void finish()
    {
        for (int i = 0; i < 4; ++i) {
            play(last);
        }
    }

    PulseMaker maker;
    PulseFrame frame;
    std::vector<Edge> edges;
    std::int64_t clock{0};
    Position last{};
};

// A smooth random walk of one axis: speeds up to `fastest` nm a tick.
std::vector<Position> random_walk(std::mt19937_64& random, double fastest, int ticks)
{
    std::vector<Position> walk;
    double speed = 0;
    double at = 0;
    for (int i = 0; i < ticks; ++i) {
        speed += std::uniform_real_distribution<double>{-0.05, 0.05}(random)*fastest;
        speed = std::max(-fastest, std::min(fastest, speed));
        at += speed;
        const auto nm = static_cast<std::int64_t>(at);
        walk.push_back({nm, -nm / 3, nm / 7});
    }
    return walk;
}

// The cubic from 0 to `way` with these slopes at its ends.
pulse::TickCubic cubic_of(double first, double way, double last)
{
    pulse::TickTravels travels;
    travels.now = static_cast<float>(way);
    travels.start_slope = static_cast<float>(first);
    travels.end_slope = static_cast<float>(last);
    return travels.cubic_from(0);
}

// A motion of one axis whose jerk changes at random times, 4 ticks apart at least, in steps and ticks. Closed form.
struct JerkyMotion {
    struct Piece {
        double from, place, speed, acceleration, jerk;
    };
    // Wanders about between speeds of this order.
    JerkyMotion(std::mt19937_64& random, double fastest, double jerk, double ticks)
    {
        Piece piece{0, 0, 0, 0, jerk};
        while (piece.from < ticks) {
            pieces.push_back(piece);
            const double t = std::uniform_real_distribution<double>{4, 9}(random);
            Piece next{piece.from + t, place_in(piece, t),
                       piece.speed + t * (piece.acceleration + 0.5 * t * piece.jerk),
                       piece.acceleration + t * piece.jerk, 0};
            const double wanted = std::uniform_real_distribution<double>{-fastest, fastest}(random);
            next.jerk = (wanted - next.speed > 12 * next.acceleration ? 1 : -1) * jerk;
            piece = next;
        }
    }
    static double place_in(const Piece& piece, double t)
    {
        return piece.place +
               t * (piece.speed + t * (0.5 * piece.acceleration + t * piece.jerk / 6));
    }
    double at(double time) const
    {
        std::size_t k = 0;
        while (k + 1 < pieces.size() && pieces[k + 1].from <= time) {
            ++k;
        }
        return place_in(pieces[k], time - pieces[k].from);
    }
    std::vector<Piece> pieces;
};

}  // namespace

TEST_GROUP(PulseMaker) { std::mt19937_64 random{3}; };
TEST_GROUP(StepTimes) { std::mt19937_64 random{4}; };

TEST(PulseMaker, EndsAtTheSetPointRoundedToSteps)
{
    for (int round = 0; round < 200; ++round) {
        const StepSettings settings{{800000, 157480, 1600123}, 2, 5};
        Player player{settings};
        for (const Position& at : random_walk(random, 80000, 60)) {
            player.play(at);
        }
        player.finish();
        CHECK(player.maker.idle());
        for (unsigned i = 0; i < kAxisCount; ++i) {
            const double steps =
                static_cast<double>(player.last[i]) * settings.millisteps_per_mm[i] * 1e-9;
            LONGS_EQUAL(static_cast<long>(std::floor(steps + 0.5)),
                        player.maker.position_steps()[i]);
        }
    }
}

TEST(PulseMaker, KeepsPulseWidthLowTimeAndDirectionSetup)
{
    for (int round = 0; round < 200; ++round) {
        Player player{{{800000, 800000, 800000}, 3, 7}};
        for (const Position& at : random_walk(random, 150000, 60)) {
            player.play(at);
        }
        player.finish();
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            std::int64_t rose = -1000;
            std::int64_t fell = -1000;
            std::int64_t turned = -1000;
            for (const Edge& edge : player.edges) {
                if (((edge.raise | edge.lower) & direction_line(axis)) != 0) {
                    turned = edge.time;
                    CHECK(edge.time - rose >= 3);
                }
                if ((edge.raise & step_line(axis)) != 0) {
                    CHECK(edge.time - fell >= 3);
                    CHECK(edge.time - turned >= 7);
                    rose = edge.time;
                }
                if ((edge.lower & step_line(axis)) != 0) {
                    LONGS_EQUAL(3, edge.time - rose);
                    fell = edge.time;
                }
            }
        }
    }
}

TEST(PulseMaker, EdgesFollowTheMotionBetweenItsSetPoints)
{
    constexpr double kJerk = 0.5;  // steps a tick^3: 6e5 mm/s^3 at 800 steps/mm
    constexpr double kNanometres = 1e9 / 800e3;
    constexpr double kSetup = 5;
    double worst = 0;
    for (int round = 0; round < 100; ++round) {
        const JerkyMotion motion{random, 50, kJerk, 120};
        Player player{{}};
        for (int tick = 1; tick <= 120; ++tick) {
            player.play(
                {static_cast<std::int64_t>(std::floor(motion.at(tick) * kNanometres + 0.5)), 0, 0});
        }
        double place = 0;
        bool forward = false;
        for (const Edge& edge : player.edges) {
            forward = (edge.raise & direction_line(0)) != 0 ||
                      (forward && (edge.lower & direction_line(0)) == 0);
            if ((edge.raise & step_line(0)) == 0) {
                continue;
            }
            const double middle = place + (forward ? 0.5 : -0.5);
            place += forward ? 1 : -1;
            const double time = (static_cast<double>(edge.time) - kSetup) / kPulseTicksPerFrame;
            // Half a pulse tick on both sides is rounding.
            constexpr double kHalf = 0.5 / kPulseTicksPerFrame;
            const double early = motion.at(time - kHalf) - middle;
            const double late = motion.at(time + kHalf) - middle;
            if (early * late > 0) {
                worst = std::max(worst, std::min(std::fabs(early), std::fabs(late)));
            }
        }
    }
    CHECK(worst < 0.03 * 2 * kJerk);
    CHECK(worst > 0);
}

TEST(PulseMaker, CountsEveryEdgeIntoThePosition)
{
    Player player{{}};
    for (const Position& at : random_walk(random, 150000, 400)) {
        player.play(at);
    }
    player.finish();
    PerAxis<std::int32_t> count{};
    PerAxis<bool> forward{};
    for (const Edge& edge : player.edges) {
        for (unsigned axis = 0; axis < kAxisCount; ++axis) {
            if ((edge.raise & direction_line(axis)) != 0) {
                forward[axis] = true;
            }
            if ((edge.lower & direction_line(axis)) != 0) {
                forward[axis] = false;
            }
            if ((edge.raise & step_line(axis)) != 0) {
                count[axis] += forward[axis] ? 1 : -1;
            }
        }
    }
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        LONGS_EQUAL(player.maker.position_steps()[axis], count[axis]);
    }
}

TEST(StepTimes, AreWithinAFifthOfAMicrosecondOfTheCubic)
{
    std::uniform_real_distribution<double> travel{0.02, 240};
    for (int i = 0; i < 20000; ++i) {
        const double now = travel(random);
        const double first = now * std::uniform_real_distribution<double>{0.8, 1.2}(random);
        const double last = now * std::uniform_real_distribution<double>{0.8, 1.2}(random);
        const pulse::TickCubic cubic = cubic_of(first, now, last);
        const double level = now * std::uniform_real_distribution<double>{0, 1}(random);
        const double time =
            static_cast<double>(pulse::crossing_time(cubic, static_cast<float>(level), 0.0F, true));
        double low = 0;
        double high = 1;
        for (int k = 0; k < 60; ++k) {
            const double t = 0.5 * (low + high);
            const double at =
                t * (first + t * (3 * now - 2 * first - last + t * (first + last - 2 * now)));
            (at < level ? low : high) = t;
        }
        DOUBLES_EQUAL(low, time, 0.2e-3);
    }
}

TEST(StepTimes, AreAllCrossingsOfATickInOrder)
{
    unsigned steady_ticks = 0;
    for (int i = 0; i < 2000; ++i) {
        const double now = std::uniform_real_distribution<double>{1, 250}(random);
        const double spread = i % 2 == 0 ? 0.02 : 1.0;
        std::uniform_real_distribution<double> change{1 - spread, 1 + spread};
        const bool rising = i % 3 != 0;
        const float sign = rising ? 1.0F : -1.0F;
        const double way = rising ? now : -now;
        const pulse::TickCubic cubic = cubic_of(way * change(random), way, way * change(random));
        pulse::StepTimes times{cubic, rising};
        steady_ticks += times.steady() ? 1U : 0U;
        const int count = static_cast<int>(now + 0.5);
        float last = 0.0F;
        for (int k = 0; k < count; ++k) {
            const bool amid = k > 0 && k + 1 < count;
            const float time = amid && times.steady() ? times.next_steady() : times.next();
            const float level = sign * (static_cast<float>(k) + 0.5F);
            // 2e-5 of a tick, plus the rounding of the level in float.
            const float least = std::fabs(cubic.slope_at(time)) * 2.1e-5F + 1e-4F;
            DOUBLES_EQUAL(level, cubic.at(time), least);
            CHECK(time >= last && time <= 1.0F);
            last = time;
        }
    }
    CHECK(steady_ticks > 500 && steady_ticks < 1500);
}

TEST(StepTimes, AtTheEndOfATickIsTheEnd)
{
    const pulse::TickCubic cubic{-0.5F, 20, 0, 0};
    DOUBLES_EQUAL(1, pulse::crossing_time(cubic, 19.5F, 0.9F, true), 1e-5);
}
