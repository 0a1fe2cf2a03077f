// Which moves the operator's overrides scale, by the speed that they run at.
#include <algorithm>
#include <string>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"

using namespace cusp;

namespace {

constexpr char kAsProgrammed = '\x90';
constexpr char kTenUp = '\x91';
constexpr char kTenDown = '\x92';
constexpr char kRapidLow = '\x97';

struct Override {
    char byte;
    unsigned times;
    double factor;  // of feeds
};
constexpr Override kSlowest{kTenDown, 9, 0.1};
constexpr Override kFastest{kTenUp, 10, 2.0};

// The motion that runs, and its speed at 100 %. A plate is 5 mm below the start.
struct OverriddenMoves {
    const char* line;
    double mm_per_minute;
};
constexpr OverriddenMoves kNeverScaled[] = {
    {"$J=G91 X20 F600\n", 600},      {"$J=G91 X2 F600\n$J=G91 Y2 F600\n", 600},
    {"G91 G38.2 Z-20 F300\n", 300},  {"G91 G38.3 Z-20 F300\n", 300},
    {"G91 G38.5 X4 F300\n", 0},  // there is no contact to lose: alarm 4
    {"G91 G93 G38.3 X4 F60\n", 240}, {"$H\n", 1500},
};
constexpr OverriddenMoves kScaled[] = {
    {"G91 G1 X20 F600\n", 600},         {"G91 G3 X4 I2 F600\n", 600},
    {"G91 G93 G1 X20 F30\n", 600},      {"G91 G1 X20 Y20 F600\n", 600},
    {"G91 G83 Z-4 R0 Q4 F300\n", 3000},  // its rapids, which feed overrides leave alone
};

machine::Settings homing_settings()
{
    machine::Settings settings;
    CHECK(!settings.put(22, 1));
    CHECK(!settings.put(25, 1500));
    CHECK(!settings.put(26, 1));
    return settings;
}

// The greatest speed of the run, mm/min.
double greatest_speed(const char* line, const Override& by)
{
    hal::MillGeometry geometry;
    geometry.plate_above_start = -5.0;
    ControllerBench bench{geometry, homing_settings()};
    (void)bench.exchange("$X\n");
    (void)bench.exchange(std::string(by.times, by.byte));
    bench.board.byte_link.send(line);
    double fastest = 0;
    for (unsigned i = 0; i < 200000; ++i) {
        bench.run(1);
        fastest = std::max(fastest, static_cast<double>(bench.app.machine().motion().speed()));
        if (bench.app.machine().idle() && bench.board.byte_link.unread() == 0) {
            break;
        }
    }
    return 60 * fastest;
}

}  // namespace

TEST_GROUP(OverridesOf){};

TEST(OverridesOf, FeedLeaveHomingProbingAndJoggingAlone)
{
    for (const OverriddenMoves& moves : kNeverScaled) {
        for (const Override& by : {Override{kAsProgrammed, 1, 1}, kSlowest, kFastest}) {
            const double fastest = greatest_speed(moves.line, by);
            DOUBLES_EQUAL_TEXT(moves.mm_per_minute, fastest, 1 + 0.01 * moves.mm_per_minute,
                               moves.line);
        }
    }
}

TEST(OverridesOf, FeedScaleWhatIsProgrammed)
{
    for (const OverriddenMoves& moves : kScaled) {
        const bool rapids = moves.mm_per_minute > 2000;
        for (const Override& by : {Override{kAsProgrammed, 1, 1}, kSlowest, kFastest}) {
            const double expected = moves.mm_per_minute * (rapids ? 1 : by.factor);
            const double fastest = greatest_speed(moves.line, by);
            DOUBLES_EQUAL_TEXT(expected, fastest, 1 + (rapids ? 0.5 : 0.02) * expected, moves.line);
        }
    }
}

TEST(OverridesOf, RapidsScaleRapidsAlone)
{
    const Override low{kRapidLow, 1, 1};
    DOUBLES_EQUAL(1500, greatest_speed("G91 G0 X40\n", low), 20);
    DOUBLES_EQUAL(6000, greatest_speed("G91 G0 X40\n", {kAsProgrammed, 1, 1}), 60);
    for (const OverriddenMoves& moves : kNeverScaled) {
        DOUBLES_EQUAL_TEXT(moves.mm_per_minute, greatest_speed(moves.line, low),
                           1 + 0.01 * moves.mm_per_minute, moves.line);
    }
}

// A setter touched at 10 % is as accurate as one at 100 %: both touches keep their feeds.
TEST(OverridesOf, FeedLeaveTheToolSetterAlone)
{
    std::string lengths[2];
    unsigned ticks[2]{};
    for (unsigned run = 0; run < 2; ++run) {
        machine::Settings with = homing_settings();
        CHECK(!with.put(341, 3));
        hal::MillGeometry geometry;
        geometry.plate_above_start = -30.0;
        ControllerBench bench{geometry, with};
        (void)bench.exchange("$X\n");
        bench.board.byte_link.send("$H\n");
        (void)bench.finish();
        bench.board.byte_link.send("G10 L2 P9 X-20 Y-20 Z-35\nT1 M6\n");
        bench.run(20000);
        if (run == 1) {
            (void)bench.exchange(std::string(kSlowest.times, kSlowest.byte));
        }
        bench.board.byte_link.send("~");
        while (ticks[run] < 100000 && !bench.app.machine().idle()) {
            bench.run(1);
            ++ticks[run];
        }
        lengths[run] = bench.board.byte_link.take_answers();
        CHECK_TEXT(has_text(lengths[run], "[MSG:Tool T1: length"), lengths[run].c_str());
    }
    LONGS_EQUAL(ticks[0], ticks[1]);
}
