// The power of a laser, tick by tick, against the set points and against the steps at the pins.
#include "firmware/machine/laser.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"

using namespace cusp;
using machine::State;

namespace {

constexpr double kMostRpm = 1000;  // $30
constexpr double kPerCent = 0.01;

// A millisecond at the pins.
struct Millisecond {
    double power;   // 0 to 1
    Position at;    // the set point that its tick has made
    double travel;  // mm, of the steps in it
};

class LaserMill {
public:
    explicit LaserMill(const std::vector<std::pair<unsigned, float>>& more = {})
        : bench_{{}, settings(more)}
    {
        bench_.run(5);
    }

    static machine::Settings settings(const std::vector<std::pair<unsigned, float>>& more)
    {
        machine::Settings settings;
        CHECK(!settings.put(32, 1));
        CHECK(!settings.put(30, static_cast<float>(kMostRpm)));
        for (const auto& [number, value] : more) {
            CHECK(!settings.put(number, value));
        }
        return settings;
    }

    void send(const std::string& bytes) { bench_.board.byte_link.send(bytes); }
    void run(unsigned ticks)
    {
        for (unsigned i = 0; i < ticks; ++i) {
            const PerAxis<std::int64_t> before = bench_.board.mill.steps();
            bench_.run(1);
            double square = 0;
            for (unsigned axis = 0; axis < kAxisCount; ++axis) {
                const auto steps =
                    static_cast<double>(bench_.board.mill.steps()[axis] - before[axis]);
                square += steps * steps;
            }
            record_.push_back({bench_.board.mill.outputs().spindle_pwm / double{kFullDuty},
                               bench_.app.machine().motion().position(),
                               std::sqrt(square) / 800.0});
        }
    }
    // Runs a program to its end.
    void finish(const std::string& program)
    {
        send(program);
        unsigned ticks = 0;
        do {
            run(1);
            ++ticks;
        } while (ticks < 100000 &&
                 !(bench_.app.machine().idle() && bench_.board.byte_link.unread() == 0));
        run(10);
        const std::string said = bench_.board.byte_link.take_answers();
        CHECK_TEXT(said.find("error") == std::string::npos, said.c_str());
    }

    const std::vector<Millisecond>& record() const { return record_; }
    State state() const { return bench_.app.machine().state(); }
    // mm/s of the set point whose motion plays in millisecond i.
    double speed(std::size_t i) const
    {
        if (i < 2) {
            return 0;
        }
        const Position moved = record_[i - 1].at - record_[i - 2].at;
        return std::sqrt(
                   static_cast<double>(moved.x * moved.x + moved.y * moved.y + moved.z * moved.z)) *
               1e-3;
    }
    double power(std::size_t i) const { return record_[i].power; }
    Position at(std::size_t i) const { return i < 1 ? Position{} : record_[i - 1].at; }
    ControllerBench& bench() { return bench_; }

private:
    ControllerBench bench_;
    std::vector<Millisecond> record_;
};

// Power is `ratio` times the speed within 1 %, wherever the speed is 5 % of the feed at least. Returns the
// number of ticks that were judged.
unsigned judge_ratio(const LaserMill& mill, double ratio, double feed)
{
    unsigned judged = 0;
    for (std::size_t i = 2; i < mill.record().size(); ++i) {
        const double v = mill.speed(i);
        if (v > 0.05 * feed) {
            DOUBLES_EQUAL(1.0, mill.power(i) / v / ratio, kPerCent);
            ++judged;
        }
        CHECK(v > 0 || mill.power(i) == 0);
    }
    return judged;
}

}  // namespace

TEST_GROUP(LaserMode){};

TEST(LaserMode, HasPowerInProportionToTheSpeedAtCorners)
{
    for (const char* path_control : {"G61\n", "G64P0.02\n", "G64P0.2\n"}) {
        for (const double shaper : {0.0, 1.0}) {
            LaserMill mill{{{810, static_cast<float>(shaper)}, {820, 30.0F}}};
            mill.finish(std::string{path_control} +
                        "M4S500F3000\nG1X10\nY10\nX0\nY0\nG2X6Y0I3J0\nG1X9Y4\nG3X9Y9J2.5I0\n"
                        "G1X9.3Y9.1\nX9.6Y9.0\nX9.9Y9.2\nX10.2Y9.1\nX14Y3Z2\nM5\n");
            CHECK(judge_ratio(mill, 0.5 / 50.0, 50.0) > 600);
        }
    }
}

// The same from outside: the steps that leave the pins in 20 ms, and the power that lies on them. Power that
// is a millisecond early or late fails.
TEST(LaserMode, IsInStepWithThePulses)
{
    LaserMill mill;
    mill.finish("M4S800F4800\nG1X20\nX0\nX10\nM5\n");
    constexpr int kWindow = 20;
    const auto count = static_cast<int>(mill.record().size());
    for (const int late : {0, -1, 1}) {
        unsigned judged = 0;
        unsigned wrong = 0;
        for (int i = 1; i + kWindow < count; ++i) {
            double energy = 0;
            double travel = 0;
            for (int k = i; k < i + kWindow; ++k) {
                energy += mill.power(static_cast<std::size_t>(k + late)) * 1e-3;
                travel += mill.record()[static_cast<std::size_t>(k)].travel;
            }
            if (travel > 0.3) {
                ++judged;
                wrong += std::abs(energy / travel / (0.8 / 80.0) - 1.0) > kPerCent ? 1U : 0U;
            }
        }
        CHECK(judged > 500);
        CHECK(late == 0 ? wrong == 0 : wrong > 100);
    }
}

TEST(LaserMode, IsOffAtRapidsAndAtRest)
{
    for (const char* mode : {"M3", "M4"}) {
        LaserMill mill;
        mill.finish(std::string{mode} + "S1000F3000\nG0X10\nG1Y10\nG0X20\nG4P0.1\nG1Y5\nG0X0\n");
        double least = 1;
        for (std::size_t i = 2; i < mill.record().size(); ++i) {
            const Position at = mill.at(i);
            constexpr std::int64_t kNear = 3000;  // nm
            const bool on_rapid = (at.y < kNear && at.x > kNear && at.x < 10'000'000 - kNear) ||
                                  (at.x > 10'000'000 + kNear && at.x < 20'000'000 - kNear) ||
                                  (at.y == 5'000'000 && at.x < 20'000'000 - kNear);
            if (on_rapid || mill.speed(i) <= 0) {
                DOUBLES_EQUAL(0, mill.power(i), 0);
            }
            if (at.y > 1'000'000 && at.y < 9'000'000 && at.x == 10'000'000) {
                least = std::min(least, mill.power(i));
            }
        }
        CHECK(least > 0.4);
    }
}

TEST(LaserMode, IsConstantWithM3WhileItMoves)
{
    LaserMill mill;
    mill.finish("G61\nM3S250F3000\nG1X10\nY10\nX0\nM5\n");
    unsigned judged = 0;
    for (std::size_t i = 2; i < mill.record().size(); ++i) {
        if (mill.speed(i) > 0.1) {
            DOUBLES_EQUAL(0.25, mill.power(i), 0.25 * 0.002);
            ++judged;
        }
    }
    CHECK(judged > 500);
}

// Lines of an engraving: each has its own power, and none of them stops the machine.
TEST(LaserMode, ChangesPowerWithoutAStopAndInItsPlace)
{
    for (const char* mode : {"M3", "M4"}) {
        LaserMill mill;
        std::string program = std::string{mode} + "S0F3000\nG1X5\n";
        for (int i = 0; i < 40; ++i) {
            program +=
                "X" + std::to_string(6 + i) + "S" + std::to_string(100 + 50 * (i % 10)) + "\n";
        }
        mill.finish(program + "S0X50\nM5\n");
        unsigned judged = 0;
        for (std::size_t i = 2; i < mill.record().size(); ++i) {
            const double x = static_cast<double>(mill.at(i).x) * 1e-6;
            const double behind = x - std::floor(x);
            if (x < 5.1 || x > 44.9) {
                continue;
            }
            DOUBLES_EQUAL(50.0, mill.speed(i), 0.01);
            // A tick travels 0.05 mm, and the change falls on the nearest one.
            if (behind > 0.08 && behind < 0.97) {
                const int line = static_cast<int>(std::floor(x)) - 5;
                DOUBLES_EQUAL((100 + 50 * (line % 10)) / kMostRpm, mill.power(i), 0.002);
                ++judged;
            }
        }
        CHECK(judged > 600);
    }
}

TEST(LaserMode, FollowsTheOverrides)
{
    LaserMill mill;
    mill.send("\x9B\x9B");              // spindle 80 %
    mill.send("\x91\x91\x91\x91\x91");  // feed 150 %
    mill.finish("M4S500F2400\nG1X20\nX0\nM5\n");
    CHECK(judge_ratio(mill, 0.8 * 0.5 / 40.0, 60.0) > 500);
    double fastest = 0;
    for (std::size_t i = 2; i < mill.record().size(); ++i) {
        fastest = std::max(fastest, mill.speed(i));
    }
    DOUBLES_EQUAL(60.0, fastest, 0.1);
}

TEST(LaserMode, IsOffInAHoldAndBackWithTheMotion)
{
    LaserMill mill;
    mill.send("M3S500F3000\nG1X40\n");
    mill.run(300);
    CHECK(mill.power(mill.record().size() - 1) > 0.49);
    mill.send("!");
    mill.run(500);
    CHECK(mill.state() == State::kHold);
    DOUBLES_EQUAL(0, mill.power(mill.record().size() - 1), 0);
    mill.send("~");
    mill.run(100);
    CHECK(mill.power(mill.record().size() - 1) > 0.49);
}

TEST(LaserMode, IsCutByEveryStop)
{
    for (const std::string stop : {"\x18", "\x84", "emergency stop"}) {
        LaserMill mill;
        mill.send("M3S500F3000\nG1X40\n");
        mill.run(300);
        CHECK(mill.power(mill.record().size() - 1) > 0.49);
        if (stop.size() == 1) {
            mill.send(stop);
        } else {
            mill.bench().board.mill.force_high(kEmergencyStop);
        }
        mill.run(6);
        for (unsigned i = 0; i < 300; ++i) {
            mill.run(1);
            DOUBLES_EQUAL(0, mill.power(mill.record().size() - 1), 0);
        }
        CHECK(!mill.bench().board.mill.outputs().spindle_on);
    }
}

TEST(LaserMode, IsOffInJogs)
{
    LaserMill mill;
    mill.finish("M3S500\n");
    mill.finish("$J=G91X10F3000\n");
    for (const Millisecond& each : mill.record()) {
        DOUBLES_EQUAL(0, each.power, 0);
    }
}

TEST(LaserMode, DoesNotChangeWhereTheMachineGoes)
{
    std::vector<Position> ends;
    for (const float mode : {0.0F, 1.0F}) {
        LaserMill mill{{{32, mode}}};
        mill.finish("M3S500F3000\nG1X10Y2\nG0X3\nS200G1X5\nM5\n");
        ends.push_back(mill.record().back().at);
    }
    CHECK(ends[0] == ends[1]);
}

TEST(LaserMode, CodesPowersWithinATenthOfAPerCent)
{
    using path::LaserPower;
    for (double value = 1e-5; value < 1e6; value *= 1.00137) {
        const auto speed = static_cast<float>(value);
        DOUBLES_EQUAL(1, LaserPower::constant(speed).at(12.0F) / speed, 1e-3);
        DOUBLES_EQUAL(1, LaserPower::by_length(speed, 10.0F).at(5.0F) / (speed / 2), 1e-3);
    }
    CHECK(!LaserPower::constant(0).on() && !LaserPower::by_length(0, 1).on());
    CHECK(LaserPower::constant(5).at(0) == 0 && LaserPower{}.at(5) == 0);
    CHECK(LaserPower::constant(5) != LaserPower::by_length(5, 1));
}
