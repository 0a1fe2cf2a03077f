// A machine whose board has wires to its drives: what waits for them, and what a fault of one does.
#include <string>
#include <utility>

#include "CppUTest/TestHarness.h"

#include "firmware/drives/tmc2209.hpp"
#include "tests/support/controller_bench.hpp"

using namespace cusp;
using machine::State;

namespace {

// Answers what a drive that does all that it is told answers, a tick after it was asked.
class ObedientDrives {
public:
    void begin(unsigned drive, Span<const std::uint8_t> bytes, bool replies) noexcept
    {
        drive_ = drive;
        place_ = bytes[2] & 0x7FU;
        replies_ = replies;
        if (!replies) {
            std::uint32_t value = 0;
            for (std::size_t i = 3; i < 7; ++i) {
                value = value << 8U | bytes[i];
            }
            registers[drive][place_] = place_ == 1 ? 0 : value;
            ++registers[drive][2];
        }
    }
    bool busy() const noexcept { return sends_for_ever; }
    bool let_go() noexcept
    {
        let_go_of += sends_for_ever ? 1U : 0U;
        return std::exchange(sends_for_ever, false);
    }
    std::size_t take(Span<std::uint8_t> answer) const noexcept
    {
        if (!replies_ || drive_ == missing) {
            return 0;
        }
        Datagram reply;
        for (const unsigned byte : {5U, 255U, place_}) {
            (void)reply.try_push_back(static_cast<std::uint8_t>(byte));
        }
        const std::uint32_t value = place_ == 6 ? 0x21000000 : registers[drive_][place_];
        for (unsigned shift = 32; shift > 0; shift -= 8) {
            (void)reply.try_push_back(static_cast<std::uint8_t>(value >> (shift - 8)));
        }
        (void)reply.try_push_back(drives::tmc2209::crc8(reply.span()));
        for (std::size_t i = 0; i < reply.size(); ++i) {
            answer[i] = reply[i];
        }
        return reply.size();
    }

    std::array<std::array<std::uint32_t, 128>, 4> registers{};
    unsigned missing{9};
    bool sends_for_ever{false};
    unsigned let_go_of{0};

private:
    using Datagram = drives::Datagram;
    unsigned drive_{0};
    unsigned place_{0};
    bool replies_{false};
};

struct BoardWithDrives : hal::SimulatedBoard {
    using hal::SimulatedBoard::SimulatedBoard;
    static constexpr std::uint8_t kDriveWires = 15;
    static constexpr float kSenseMilliohms = 110;
    ObedientDrives drive_wire;
};
static_assert(hal::has_drive_wire<BoardWithDrives>);

struct DriveBench {
    void run(unsigned ticks)
    {
        for (unsigned i = 0; i < ticks; ++i) {
            while (app.poll()) {
            }
            app.tick();
            board.advance();
        }
    }
    std::string exchange(const std::string& bytes, unsigned ticks)
    {
        board.byte_link.send(bytes);
        run(ticks);
        return board.byte_link.take_answers();
    }
    bool drives_on() const { return board.mill.outputs().drives_on != 0; }
    std::uint64_t steps() const { return board.mill.steps_taken()[0]; }

    BoardWithDrives board{hal::MillGeometry{}};
    planner::PathQueue queue;
    app::App<BoardWithDrives> app{board, queue};
};

constexpr unsigned kSet = 300;  // ticks, more than it takes

}  // namespace

TEST_GROUP(MachineDrives) { DriveBench bench; };

TEST(MachineDrives, a_move_waits_until_they_are_set)
{
    std::string heard = bench.exchange("G0X5\n", 60);
    CHECK_FALSE(has_text(heard, "ok"));
    CHECK_FALSE(bench.drives_on());
    UNSIGNED_LONGS_EQUAL(0, bench.steps());
    // Questions are answered meanwhile.
    CHECK_TRUE(has_text(bench.exchange("?", 5), "<Idle"));
    heard = bench.exchange("", kSet + 2000);
    CHECK_TRUE(has_text(heard, "ok"));
    UNSIGNED_LONGS_EQUAL(4000, bench.steps());
}

TEST(MachineDrives, with_the_idle_lock_off_they_have_no_current_before)
{
    bench.exchange("$1=255\n", 20);
    CHECK_FALSE(bench.drives_on());
    bench.exchange("", kSet);
    CHECK_TRUE(bench.drives_on());
}

TEST(MachineDrives, one_that_is_missing_is_alarm_17_by_its_name)
{
    bench.board.drive_wire.missing = 2;
    const std::string heard = bench.exchange("G0X5\n", kSet);
    CHECK_TRUE(has_text(heard, "ALARM:17"));
    CHECK_TRUE(has_text(heard, "[MSG:Drive Z does not answer"));
    CHECK_TRUE(has_text(heard, "error:9"));
    CHECK_TRUE(has_text(bench.exchange("$X\n", 20), "error:9"));
    CHECK_FALSE(bench.drives_on());
    UNSIGNED_LONGS_EQUAL(0, bench.steps());
    bench.board.drive_wire.missing = 9;
    bench.exchange("\x18", kSet);
    CHECK_TRUE(has_text(bench.exchange("$X\nG0X1\n", 1000), "ok"));
    UNSIGNED_LONGS_EQUAL(800, bench.steps());
}

TEST(MachineDrives, an_axis_without_one_is_left_out_by_338)
{
    bench.board.drive_wire.missing = 1;
    bench.exchange("$338=5\n", kSet);
    CHECK_FALSE(has_text(bench.exchange("G0Y1\n", 1000), "ALARM"));
    CHECK_TRUE(bench.app.machine().state() == State::kIdle);
}

TEST(MachineDrives, a_board_without_their_bus_has_no_tmc5160)
{
    const std::string heard = bench.exchange("$798=2\n", kSet);
    CHECK_TRUE(has_text(heard, "error:5"));
    CHECK_TRUE(has_text(heard, "[MSG:$798: this board has no pin for it]"));
    CHECK_TRUE(has_text(bench.exchange("$798=8\n", kSet), "error:"));
}

TEST(MachineDrives, a_fault_in_motion_stops_it_and_takes_the_current)
{
    bench.run(kSet);
    bench.exchange("G1X100F1000\n", 500);
    CHECK_TRUE(bench.drives_on());
    bench.board.drive_wire.registers[0][0x6F] = 1U << 3U;
    const std::string heard = bench.exchange("", 100);
    CHECK_TRUE(has_text(heard, "ALARM:17"));
    CHECK_TRUE(has_text(heard, "Drive X has a short"));
    CHECK_FALSE(bench.drives_on());
    const std::uint64_t steps = bench.steps();
    bench.run(100);
    UNSIGNED_LONGS_EQUAL(steps, bench.steps());
}

TEST(MachineDrives, the_second_motor_has_the_settings_of_its_axis)
{
    bench.run(kSet);
    UNSIGNED_LONGS_EQUAL(0, bench.board.drive_wire.registers[3][0x10]);
    bench.exchange("$141=1200\n$793=2\n", kSet);
    const auto& registers = bench.board.drive_wire.registers;
    CHECK_TRUE(registers[1][0x10] != registers[0][0x10]);
    UNSIGNED_LONGS_EQUAL(registers[1][0x10], registers[3][0x10]);
}

TEST(MachineDrives, a_store_waits_for_no_datagram)
{
    bench.run(kSet);
    for (unsigned i = 0; i < 20; ++i) {
        bench.board.drive_wire.sends_for_ever = true;
        bench.run(15);  // one is on its way
        CHECK_TRUE(has_text(bench.exchange("G10L2P1X" + std::to_string(i) + "\n", 3), "ok"));
        UNSIGNED_LONGS_EQUAL(i + 1, bench.board.drive_wire.let_go_of);
    }
    CHECK_FALSE(has_text(bench.exchange("", kSet), "ALARM"));
}

TEST(MachineDrives, microsteps_that_no_drive_has_are_refused)
{
    CHECK_TRUE(has_text(bench.exchange("$150=24\n", 400), "error:3"));
    CHECK_TRUE(has_text(bench.exchange("$150=512\n", 400), "error"));
    CHECK_TRUE(has_text(bench.exchange("$150=32\n", 400), "ok"));
}
