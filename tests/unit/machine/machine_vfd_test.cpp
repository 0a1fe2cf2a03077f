// A machine whose spindle is a drive that is spoken to: what waits for it, and what its failure does.
#include <string>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"
#include "tests/support/spindle_slave.hpp"

using namespace cusp;
using machine::State;

namespace {

// The line to the slave.
struct SlaveWire {
    void begin(Span<const std::uint8_t> bytes, std::uint32_t baud) noexcept
    {
        rate = baud;
        slave.send({bytes.begin(), bytes.end()});
    }
    std::size_t heard(Span<std::uint8_t> answer) const noexcept
    {
        const auto& bytes = slave.heard();
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            answer[i] = bytes[i];
        }
        return bytes.size();
    }
    bool let_go() noexcept { return false; }

    test::SpindleSlave slave{vfd::Protocol::kPlain};
    std::uint32_t rate{0};
};
struct BoardWithSpindle : hal::SimulatedBoard {
    using hal::SimulatedBoard::SimulatedBoard;
    SlaveWire spindle_wire;
};
static_assert(hal::has_spindle_wire<BoardWithSpindle>);

struct VfdBench {
    VfdBench() { exchange("$395=3\n$374=2\n$394=6\n", 400); }
    void run(unsigned ticks, bool polls = true)
    {
        for (unsigned i = 0; i < ticks; ++i) {
            while (polls && app.poll()) {
            }
            app.tick();
            board.advance();
            slave().pass(1);
        }
    }
    std::string exchange(const std::string& bytes, unsigned ticks)
    {
        board.byte_link.send(bytes);
        run(ticks);
        return board.byte_link.take_answers();
    }
    test::SpindleSlave& slave() { return board.spindle_wire.slave; }
    std::uint64_t steps() const { return board.mill.steps_taken()[0]; }

    BoardWithSpindle board{hal::MillGeometry{}};
    planner::PathQueue queue;
    app::App<BoardWithSpindle> app{board, queue};
};

}  // namespace

TEST_GROUP(MachineVfd) { VfdBench bench; };

TEST(MachineVfd, IsRefusedOnABoardWithoutALine)
{
    ControllerBench plain;
    CHECK(has_text(plain.exchange("$395=1\n", 400), "error:5"));
}

TEST(MachineVfd, MotionWaitsUntilItIsAtSpeed)
{
    bench.board.byte_link.send("M3S12000\nG1X5F1000\n");
    for (unsigned i = 0; i < 3000 && bench.steps() == 0; ++i) {
        bench.run(1);
    }
    CHECK(bench.steps() > 0);
    DOUBLES_EQUAL(12000, bench.slave().rpm(), 600);
    UNSIGNED_LONGS_EQUAL(9600, bench.board.spindle_wire.rate);
    bench.run(2000);
    // Another speed is waited for, too; the other way as well.
    const std::uint64_t before = bench.steps();
    bench.board.byte_link.send("M3S18000\nG1X6\nM4\nG1X7\n");
    while (bench.steps() == before) {
        bench.run(1);
    }
    DOUBLES_EQUAL(18000, bench.slave().rpm(), 900);
    bench.run(6000);
    LONGS_EQUAL(-1, bench.slave().direction());
    CHECK(bench.app.machine().state() == State::kIdle);
    UNSIGNED_LONGS_EQUAL(7 * 800, bench.steps());
    bench.exchange("M5\n", 100);
    LONGS_EQUAL(0, bench.slave().direction());
}

TEST(MachineVfd, OneThatDoesNotComeUpIsAlarm14WithoutAStep)
{
    bench.exchange("$394=0.5\n", 400);
    const std::string heard = bench.exchange("M3S23000\nG1X5F1000\n", 3000);
    CHECK(has_text(heard, "ALARM:14"));
    UNSIGNED_LONGS_EQUAL(0, bench.steps());
    LONGS_EQUAL(0, bench.slave().direction());
}

TEST(MachineVfd, ItsSilenceAmidACutStopsSoftlyThenIsAlarm14)
{
    bench.exchange("M3S12000\nG1X100F1000\n", 3000);
    CHECK(bench.steps() > 0);
    bench.slave().lose = 1000;
    const std::string heard = bench.exchange("", 1000);
    CHECK(has_text(heard, "ALARM:14"));
    CHECK(has_text(heard, "[MSG:Spindle does not answer]"));
    const std::uint64_t steps = bench.steps();
    // The position is kept.
    DOUBLES_EQUAL(to_millimetres(bench.app.machine().motion().position()).x,
                  static_cast<double>(steps) / 800, 0.002);
    // It hears no stop, and there is one alarm.
    CHECK_FALSE(has_text(bench.exchange("", 3000), "ALARM"));
    bench.slave().lose = 0;
    bench.run(500);
    LONGS_EQUAL(0, bench.slave().direction());
    bench.exchange("$X\n", 50);
    CHECK(has_text(bench.exchange("M3S6000\nG1X1F1000\n", 9000), "ok"));
    CHECK(bench.steps() > steps);
}

TEST(MachineVfd, DoorHoldAndResetStopIt)
{
    bench.exchange("M3S12000\nG1X100F1000\n", 3000);
    LONGS_EQUAL(1, bench.slave().direction());
    bench.exchange("\x84", 300);
    LONGS_EQUAL(0, bench.slave().direction());
    const std::uint64_t steps = bench.steps();
    bench.board.byte_link.send("~");
    while (bench.steps() == steps) {
        bench.run(1);
    }
    DOUBLES_EQUAL(12000, bench.slave().rpm(), 600);
    bench.exchange("\x18", 300);
    LONGS_EQUAL(0, bench.slave().direction());
}

// Without room for answers a stop acts in the tick; its drive hears of it in the main loop all the same.
TEST(MachineVfd, AStopReachesItThoughTheSenderDoesNotRead)
{
    bench.exchange("M3S12000\nG1X100F1000\n", 3000);
    for (unsigned i = 0; i < 200; ++i) {
        bench.board.byte_link.send("?");
        bench.run(2);
    }
    bench.board.mill.force_high(kDoor);
    bench.run(300);
    CHECK(bench.app.machine().state() == State::kRun);  // it can't say that the door is open
    LONGS_EQUAL(0, bench.slave().direction());
}
