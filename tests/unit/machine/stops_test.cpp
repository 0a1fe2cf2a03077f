// Stops against a model of plain sets, over all inputs, bytes and states; and a main loop that hangs.
#include "firmware/machine/stops.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"

namespace {

using cusp::has_text;
using cusp::machine::Stops;

constexpr unsigned kInputs = 11;
constexpr std::uint8_t kReset = 0x18;
constexpr std::uint8_t kDoorByte = 0x84;
constexpr std::uint8_t kHold = '!';

constexpr unsigned kProtects = cusp::kEmergencyStop | cusp::kMotorFault;
constexpr unsigned kHalts = kProtects | cusp::kResetButton;
constexpr unsigned kCuts = kHalts | cusp::kDoor;
constexpr unsigned kBrakes = kCuts | cusp::kHoldButton;
constexpr unsigned kWatched = kBrakes | cusp::kStartButton;

// Pending stops, by name; the tick's and the main loop's words in the order in which they come.
struct Model {
    unsigned pending{0};
    unsigned acted{0};
    unsigned before{0};
    bool begins{false};
    std::string bytes;    // not let go yet
    std::size_t read{0};  // of these, by the main loop
    bool brake{false};
    bool cut{false};
    bool halt{false};

    void take_inputs(unsigned raw, unsigned steady)
    {
        pending |= steady & ~before & kWatched;
        before = steady;
        begins = (raw & ~steady & kBrakes) != 0;
    }
    void take_byte(std::uint8_t byte)
    {
        if (byte == kReset || byte == kDoorByte || byte == kHold) {
            bytes += static_cast<char>(byte);
        }
    }
    void confirm()
    {
        pending &= ~acted;
        acted = 0;
        bytes.erase(0, read);
        read = 0;
    }
    bool has(std::uint8_t byte) const
    {
        return bytes.find(static_cast<char>(byte)) != std::string::npos;
    }
    bool brakes() const { return begins || (pending & kBrakes) != 0 || !bytes.empty() || brake; }
    bool cuts() const { return (pending & kCuts) != 0 || has(kReset) || has(kDoorByte) || cut; }
    bool halts() const { return (pending & kHalts) != 0 || has(kReset) || halt; }
};

void check_equal(const Stops& stops, const Model& model)
{
    LONGS_EQUAL(model.pending, stops.pending());
    LONGS_EQUAL(model.brakes(), stops.brakes());
    LONGS_EQUAL(model.cuts(), stops.cuts_outputs());
    LONGS_EQUAL(model.halts(), stops.halts());
    LONGS_EQUAL((model.pending & cusp::kEmergencyStop) != 0, stops.cuts_drives());
}

// One of the things that tick and main loop do, to both.
void step(std::mt19937& chance, Stops& stops, Model& model)
{
    const auto bits = static_cast<std::uint16_t>(chance() & ((1U << kInputs) - 1U));
    switch (chance() % 6) {
        case 0:
        case 1: {
            const auto steady = static_cast<std::uint16_t>(chance() & chance() & bits);
            stops.take_inputs(bits, steady);
            model.take_inputs(bits, steady);
            return;
        }
        case 2: {
            constexpr std::array<std::uint8_t, 6> kBytes{kReset, kDoorByte, kHold, '?', 'G', '~'};
            const std::uint8_t byte = kBytes[chance() % kBytes.size()];
            stops.take_byte(byte, false);
            model.take_byte(byte);
            return;
        }
        case 3:
            stops.handle(bits);
            model.acted |= model.pending & bits;
            return;
        case 4:
            stops.read_up_to(stops.bytes());
            model.read = model.bytes.size();
            return;
        default: {
            model.halt = chance() % 4 == 0;
            model.cut = model.halt || chance() % 4 == 0;
            model.brake = model.cut || chance() % 4 == 0;
            stops.want(model.brake, model.cut, model.halt);
            if (chance() % 2 == 0) {
                stops.confirm();
                model.confirm();
            }
            return;
        }
    }
}

// The controller with the spindle on amid a move; its main loop is not called any more.
struct Hung : cusp::ControllerBench {
    Hung()
    {
        (void)exchange("M3 S12000\nG91 G1 X100 F3000\n", 300);
        CHECK(board.mill.outputs().spindle_on);
    }
    void ticks(unsigned count)
    {
        for (unsigned i = 0; i < count; ++i) {
            app.tick();
            board.advance();
        }
    }
};

}  // namespace

TEST_GROUP(Stops){};

TEST(Stops, AgreeWithTheModelInEveryState)
{
    for (unsigned seed = 1; seed <= 400; ++seed) {
        std::mt19937 chance{seed};
        Stops stops;
        Model model;
        for (unsigned i = 0; i < 200; ++i) {
            step(chance, stops, model);
            check_equal(stops, model);
        }
    }
}

TEST(Stops, ActOnTheThreeBytesThatStopAndOnNoOther)
{
    for (unsigned byte = 0; byte < 256; ++byte) {
        Stops stops;
        Model model;
        stops.take_byte(static_cast<std::uint8_t>(byte), false);
        model.take_byte(static_cast<std::uint8_t>(byte));
        check_equal(stops, model);
    }
}

TEST(Stops, LetGoOfNothingThatComesAfterTheLinkWasRead)
{
    Stops stops;
    const std::uint32_t before = stops.bytes();
    stops.take_byte(kReset, false);
    stops.read_up_to(before);
    stops.confirm();
    CHECK(stops.halts());
    stops.read_up_to(stops.bytes());
    CHECK(stops.halts());
    stops.confirm();
    CHECK_FALSE(stops.halts());
}

TEST(Stops, CutTheOutputsOfAMainLoopThatHangsWhereAFrameIsMissing)
{
    Hung mill;
    mill.board.pulse_player.lose_next_frame();
    mill.ticks(10);
    CHECK(mill.board.pulse_player.underrun());
    CHECK_FALSE(mill.board.mill.outputs().spindle_on);
    const std::string said = mill.exchange("");
    CHECK(has_text(said, "ALARM:3"));
    CHECK_FALSE(mill.board.mill.outputs().spindle_on);
}

// Whichever frame is lost, one with a turn of an axis too: no step follows, and the next way is the right one.
TEST(Stops, LeaveNoStepAndNoWrongDirectionBehindAMissingFrame)
{
    unsigned lost = 0;
    for (unsigned after = 1; after < 160; after += 3) {
        cusp::ControllerBench mill;
        (void)mill.exchange("G1 X0.4 F6000\nX0\nX0.4\nX0\nX0.4\nX0\n", after);
        mill.board.pulse_player.lose_next_frame();
        bool told = false;
        for (unsigned tick = 0; tick < 5 && !told; ++tick) {
            told = has_text(mill.exchange("", 1), "ALARM:3");
        }
        if (!told) {
            continue;  // it had no step
        }
        ++lost;
        const std::uint64_t taken = mill.board.mill.steps_taken()[0];
        mill.run(50);
        LONGS_EQUAL(taken, mill.board.mill.steps_taken()[0]);
        (void)mill.exchange("\x18", 20);
        const double before = mill.board.mill.place().x;
        (void)mill.exchange("$X\n$J=G91 X2 F6000\n");
        (void)mill.finish();
        DOUBLES_EQUAL(2.0, mill.board.mill.place().x - before, 0.002);
    }
    CHECK(lost > 20);
}

// try_scan() of the link: the reset is found behind what waits to be read, and is read once.
TEST(Stops, FindAResetByteThatTheMainLoopDoesNotComeToRead)
{
    Hung mill;
    mill.board.byte_link.send("G1 X1\n?\x18");
    mill.ticks(10);
    CHECK_FALSE(mill.board.mill.outputs().spindle_on);
    const std::string said = mill.exchange("");
    CHECK(has_text(said, "ALARM:3"));
    CHECK(said.find("Grbl 1.1h") == said.rfind("Grbl 1.1h"));
}

// No step follows the frame that plays when a stop halts motion, and the position is where it ends.
TEST(Stops, EndTheStepsWithTheFrameThatPlays)
{
    for (const std::string speed : {"30", "600", "3000"}) {
        cusp::ControllerBench mill;
        (void)mill.exchange("G91 G1 X100 Y-30 F" + speed + "\n", 400);
        mill.board.byte_link.send("\x18");
        mill.run(1);  // read, and halted in this tick or the next
        const std::uint64_t after_one = mill.board.mill.steps_taken()[0];
        mill.run(1);
        const std::uint64_t playing = mill.board.mill.steps_taken()[0];
        mill.run(20);
        CHECK(mill.board.mill.steps_taken()[0] - playing <= playing - after_one + 1);
        const std::string said = mill.exchange("");
        CHECK(has_text(said, "ALARM:3"));
        const cusp::machine::Settings& settings = mill.app.machine().settings();
        for (unsigned axis = 0; axis < 2; ++axis) {
            const double steps =
                mill.position()[axis] * static_cast<double>(settings.value(
                                            cusp::machine::Setting::kStepsPerMillimetre, axis));
            DOUBLES_EQUAL(static_cast<double>(mill.board.mill.steps()[axis]), steps, 0.51);
        }
    }
}

// The simulator's link against counting: each byte once, unless it was read before.
TEST(Stops, AScanGivesEachByteOnceThatNobodyHasHad)
{
    for (unsigned seed = 1; seed <= 50; ++seed) {
        std::mt19937 chance{seed};
        cusp::ControllerBench bench;
        auto& link = bench.board.byte_link;
        std::size_t sent = 0;
        std::size_t read = 0;
        std::size_t scanned = 0;
        for (unsigned i = 0; i < 500; ++i) {
            std::uint8_t byte = 0;
            const auto what = static_cast<unsigned>(chance() % 3);
            if (what == 0) {
                link.send(std::string(1, static_cast<char>(sent % 251)));
                ++sent;
            } else if (what == 1) {
                CHECK_EQUAL(read < sent, link.try_read(byte));
                CHECK(read == sent || byte == read % 251);
                read += read < sent ? 1 : 0;
            } else {
                scanned = scanned < read ? read : scanned;
                CHECK_EQUAL(scanned < sent, link.try_scan(byte));
                CHECK(scanned == sent || byte == scanned % 251);
                scanned += scanned < sent ? 1 : 0;
            }
        }
    }
}
