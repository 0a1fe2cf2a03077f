// Vfd against a model of a slave of each protocol, written apart from it: registers, a motor that takes its time,
// and a line that loses, delays and damages what it carries.
#include "firmware/vfd/vfd.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/support/spindle_slave.hpp"

using namespace cusp;
using namespace cusp::vfd;
using cusp::test::SpindleSlave;

namespace {

class Bench {
public:
    explicit Bench(Protocol protocol) : slave{protocol}
    {
        VfdSetup setup;
        setup.protocol = protocol;
        vfd.configure(setup, {});
    }
    void run(unsigned ticks)
    {
        for (unsigned i = 0; i < ticks; ++i, ++tick) {
            slave.pass(1);
            const std::vector<std::uint8_t>& heard = slave.heard();
            const Span<const std::uint8_t> bytes{heard.data(), heard.size()};
            if (vfd.waits() && vfd.is_over(bytes, tick)) {
                vfd.take(bytes, tick);
            }
            if (const auto message = vfd.next(tick)) {
                slave.send({message->begin(), message->end()});
            }
        }
    }
    // Ticks until it is at speed, at most so many.
    unsigned until_at_speed(unsigned most)
    {
        for (unsigned i = 0; i < most; ++i) {
            if (vfd.at_speed()) {
                return i;
            }
            run(1);
        }
        return most;
    }

    SpindleSlave slave;
    Vfd vfd;
    std::uint32_t tick{0xFFFFFF00};  // it wraps soon
};

constexpr Protocol kProtocols[] = {Protocol::kHuanyang, Protocol::kHuanyangP2A, Protocol::kPlain};

}  // namespace

TEST_GROUP(Vfd){};

TEST(Vfd, WithoutADriveIsAtSpeedAndSilent)
{
    Vfd none;
    none.want(Turning::kClockwise, 1000);
    CHECK(none.at_speed());
    CHECK_FALSE(none.next(1000).has_value());
}

TEST(Vfd, IsAtSpeedOnceTheMotorIs)
{
    for (const Protocol protocol : kProtocols) {
        Bench bench{protocol};
        bench.slave.turn_at(9000, 1);  // left running by somebody: it is stopped first
        bench.run(500);
        CHECK(bench.vfd.at_speed());
        CHECK(bench.slave.direction() == 0);
        bench.vfd.want(Turning::kClockwise, 12000);
        for (unsigned i = 0; i < 5000 && !bench.vfd.at_speed(); ++i) {
            bench.run(1);
        }
        CHECK(bench.vfd.at_speed());
        LONGS_EQUAL(1, bench.slave.direction());
        DOUBLES_EQUAL(12000, bench.slave.rpm(), 600);
        bench.vfd.want(Turning::kClockwise, 18000);
        CHECK_FALSE(bench.vfd.at_speed());
        const unsigned faster = bench.until_at_speed(5000);
        CHECK(faster > 200 && faster < 5000);
        DOUBLES_EQUAL(18000, bench.slave.rpm(), 900);
        bench.vfd.want(Turning::kCounterClockwise, 18000);
        CHECK(bench.until_at_speed(9000) < 9000);
        LONGS_EQUAL(-1, bench.slave.direction());
        bench.vfd.want(Turning::kOff, 0);
        bench.run(60);
        LONGS_EQUAL(0, bench.slave.direction());
        CHECK_FALSE(bench.vfd.fault().has_value());
        LONGS_EQUAL(0, bench.slave.refused());
    }
}

TEST(Vfd, BearsTwoBadAnswersAndTellsOfTheThird)
{
    for (const Protocol protocol : kProtocols) {
        for (const bool garbles : {false, true}) {
            Bench bench{protocol};
            bench.run(500);
            bench.vfd.want(Turning::kClockwise, 12000);
            CHECK(bench.until_at_speed(5000) < 5000);
            (garbles ? bench.slave.garble : bench.slave.lose) = 2;
            bench.run(1000);
            CHECK_FALSE(bench.vfd.fault().has_value());
            CHECK(bench.vfd.at_speed());
            (garbles ? bench.slave.garble : bench.slave.lose) = 3;
            bench.run(1000);
            CHECK(bench.vfd.fault() == (garbles ? FaultKind::kGarbled : FaultKind::kSilent));
            CHECK_FALSE(bench.vfd.at_speed());
            // It was stopped once it answered again, and turns no more until it is wanted anew.
            LONGS_EQUAL(0, bench.slave.direction());
        }
    }
}

TEST(Vfd, SaysStopUntilTheDriveHearsIt)
{
    Bench bench{Protocol::kPlain};
    bench.run(500);
    bench.vfd.want(Turning::kClockwise, 12000);
    CHECK(bench.until_at_speed(5000) < 5000);
    bench.slave.lose = 20;
    bench.run(600);
    CHECK(bench.vfd.fault() == FaultKind::kSilent);
    bench.vfd.fault_heard();
    CHECK_FALSE(bench.vfd.at_speed());
    bench.vfd.want(Turning::kOff, 0);
    bench.run(3000);
    LONGS_EQUAL(0, bench.slave.direction());
    CHECK(bench.vfd.at_speed());
    CHECK_FALSE(bench.vfd.fault().has_value());
    bench.vfd.want(Turning::kClockwise, 6000);
    CHECK(bench.until_at_speed(5000) < 5000);
}

TEST(Vfd, TakesNoLateAnswerForTheNext)
{
    Bench bench{Protocol::kHuanyang};
    bench.run(500);
    bench.vfd.want(Turning::kClockwise, 12000);
    bench.slave.delay = 90;  // 50 are allowed
    CHECK(bench.until_at_speed(2000) == 2000);
    CHECK(bench.vfd.fault() == FaultKind::kSilent);
    bench.slave.delay = 40;
    bench.vfd.restart();
    CHECK(bench.until_at_speed(5000) < 5000);
}

TEST(Vfd, ARefusalIsAFault)
{
    Bench bench{Protocol::kPlain};
    bench.slave.refuse = 100;
    bench.run(1000);
    CHECK(bench.vfd.fault() == FaultKind::kRefused);
}

// Whatever the line does to a tenth of all messages and answers: at speed is never said of a motor that is not.
TEST(Vfd, NeverSaysAtSpeedOfASpindleThatIsNot)
{
    unsigned reached = 0;
    for (unsigned seed = 1; seed <= 60; ++seed) {
        std::mt19937 random{seed};
        Bench bench{kProtocols[seed % 3]};
        bench.slave.trouble = 0.1;
        bench.slave.seed(seed);
        float wanted = 0;
        int direction = 0;
        for (unsigned i = 0; i < 20000; ++i) {
            if (random() % 2500 == 0) {
                direction = static_cast<int>(random() % 3) - 1;
                wanted = 1000.0F * static_cast<float>(3 + random() % 20);
            }
            if (bench.vfd.fault()) {
                bench.vfd.fault_heard();
                direction = 0;
                bench.vfd.want(Turning::kOff, 0);
            }
            bench.run(1);
            bench.vfd.want(direction == 0   ? Turning::kOff
                           : direction == 1 ? Turning::kClockwise
                                            : Turning::kCounterClockwise,
                           wanted);
            if (bench.vfd.at_speed() && direction != 0) {
                ++reached;
                LONGS_EQUAL(direction, bench.slave.direction());
                // It was read up to 0.1 s ago.
                DOUBLES_EQUAL(
                    static_cast<double>(wanted), bench.slave.rpm(),
                    0.05 * static_cast<double>(wanted) + 0.25 * bench.slave.kAcceleration);
            }
        }
    }
    CHECK(reached > 100000);
}
