// The order of homing by $44 to $46, the pull-off of each axis, and the drives that $37 keeps on.
#include <string>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"

using namespace cusp;

namespace {

struct HomingBench : ControllerBench {
    HomingBench() : ControllerBench{geometry(), settings()} { (void)exchange("$X\n"); }
    static hal::MillGeometry geometry()
    {
        hal::MillGeometry geometry;
        geometry.start = {-20, -20, -20};
        return geometry;
    }
    static machine::Settings settings()
    {
        machine::Settings settings;
        CHECK(!settings.put(22, 1) && !settings.put(24, 200) && !settings.put(25, 3000));
        CHECK(!settings.put(26, 5));
        return settings;
    }
    // The axes in the order in which they begin to move, and what was said.
    std::string order(const std::string& command)
    {
        std::string axes;
        board.byte_link.send(command);
        for (unsigned tick = 0; tick < 200000; ++tick) {
            run(1);
            for (unsigned axis = 0; axis < kAxisCount; ++axis) {
                const char letter = "XYZ"[axis];
                const bool moved = board.mill.steps_taken()[axis] != before_[axis];
                before_[axis] = board.mill.steps_taken()[axis];
                if (moved && (axes.empty() || axes.back() != letter)) {
                    axes += letter;
                }
            }
            if (tick > 20 && app.machine().idle()) {
                break;
            }
        }
        return axes + " " + board.byte_link.take_answers();
    }

private:
    PerAxis<std::uint64_t> before_{};
};

}  // namespace

TEST_GROUP(HomingOrder)
{
    HomingBench bench;
    void expect(const char* axes, const std::string& command)
    {
        const std::string said = bench.order(command);
        STRCMP_EQUAL(axes, said.substr(0, said.find(' ')).c_str());
        CHECK(has_text(said, "ok"));
    }
};

TEST(HomingOrder, IsZThenXThenYByDefault) { expect("ZXY", "$H\n"); }

TEST(HomingOrder, IsThatOfThePasses)
{
    (void)bench.exchange("$44=2\n$45=4\n$46=1\n", 400);
    expect("YZX", "$H\n");
    (void)bench.exchange("$44=5\n$45=2\n$46=0\n", 400);
    expect("XZY", "$H\n");
}

TEST(HomingOrder, LeavesOutWhatNoPassNames)
{
    (void)bench.exchange("$44=1\n$45=2\n$341=1\n", 400);
    expect("XY", "$H\n");
    // Z alone may still be homed, and until then no tool is changed at its top.
    CHECK(has_text(bench.exchange("T1M6\n", 50), "error:46"));
    expect("Z", "$HZ\n");
    CHECK_FALSE(has_text(bench.exchange("T1M6\n", 50), "error"));
}

TEST(HomingOrder, WithoutAnyAxisIsRefused)
{
    (void)bench.exchange("$44=0\n$45=0\n", 400);
    CHECK(has_text(bench.exchange("$H\n", 50), "error:5"));
    expect("Y", "$HY\n");
}

TEST(HomingOrder, PullsEachAxisOffByItsOwnSetting)
{
    (void)bench.exchange("$27=2\n$851=0.5\n$852=4\n$23=2\n", 400);
    expect("ZXY", "$H\n");
    const Vec3d place = bench.board.mill.place();
    DOUBLES_EQUAL(-2, place.x, 0.006);
    DOUBLES_EQUAL(-200 + 0.5, place.y, 0.006);
    DOUBLES_EQUAL(-4, place.z, 0.006);
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        DOUBLES_EQUAL(place[axis], bench.position()[axis], 0.006);
    }
}

TEST_GROUP(KeptDrives){};

TEST(KeptDrives, StayOnWhateverTheIdleLockSays)
{
    HomingBench bench;
    (void)bench.exchange("$37=4\n", 400);
    UNSIGNED_LONGS_EQUAL(4, bench.board.mill.outputs().drives_on);
    (void)bench.exchange("G1 X-1 F600\n", 60);
    UNSIGNED_LONGS_EQUAL(15, bench.board.mill.outputs().drives_on);
    (void)bench.finish();
    bench.run(50);
    UNSIGNED_LONGS_EQUAL(4, bench.board.mill.outputs().drives_on);
    // The second motor goes with its axis; sleep takes the current of all.
    (void)bench.exchange("$793=3\n", 400);
    UNSIGNED_LONGS_EQUAL(12, bench.board.mill.outputs().drives_on);
    (void)bench.exchange("$SLP\n", 50);
    UNSIGNED_LONGS_EQUAL(0, bench.board.mill.outputs().drives_on);
}
