// The streamer against a scripted controller.
#include "host_tools/controller/stream/streamer.hpp"

#include <algorithm>
#include <deque>
#include <fmt/format.h>
#include <functional>
#include <thread>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/protocol/crc32.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/stream/scripted_transport.hpp"

namespace {

using namespace cusp;
using namespace cusp::dialect;
using namespace cusp::stream;

struct QuietWatcher : StreamWatcher {
    void ready(const ControllerFacts&) override {}
    void progress(const StreamProgress& now) override { last = now; }
    void notice(const std::string& text) override { notices.push_back(text); }
    StreamKey key() override
    {
        const StreamKey pressed = next_key;
        next_key = StreamKey::kNone;
        return pressed;
    }
    StreamKey next_key{StreamKey::kNone};
    StreamProgress last;
    std::vector<std::string> notices;
};

StreamOptions quick()
{
    StreamOptions options;
    options.silence_limit = options.greeting_limit = std::chrono::milliseconds{200};
    options.status_interval = std::chrono::milliseconds{5};
    options.numbers = false;
    return options;
}

std::string checksum_of(const std::string& text)
{
    protocol::Crc32 crc;
    for (const char character : text) {
        crc.add(static_cast<std::uint8_t>(character));
    }
    return fmt::format("*{:08X}", crc.value());
}

}  // namespace

TEST_GROUP(Streamer)
{
    cusp::test::TemporaryFolder folder;
    cusp::test::ScriptedTransport controller;
    QuietWatcher watcher;
    StreamOptions options = quick();
    std::atomic<int> stop{0};

    StreamReport send(const std::string& text)
    {
        ProgramLines program{folder.with("part.ngc", text)};
        return Streamer{controller, watcher, options}.run(program, stop);
    }
    static std::string many_lines(int count)
    {
        std::string text;
        for (int i = 0; i < count; ++i) {
            text += "G1 X" + std::to_string(i) + " F1000 (cut)\n";
        }
        return text;
    }
};

TEST(Streamer, SendsEveryLineOnceInOrderWithoutComments)
{
    const StreamReport report = send("%\nG21 (mm)\n\n; nothing\nG1 X1 F100\r\nM2\n%\n");
    CHECK(report.outcome == StreamOutcome::kDone);
    const std::vector<std::string> wanted{"$I", "$$", "$G", "$#", "G21", "G1X1F100", "M2"};
    CHECK(wanted == controller.lines);
    LONGS_EQUAL(3, report.progress.lines_answered);
}

TEST(Streamer, NeverHasMoreBytesUnansweredThanAStockGrblHolds)
{
    controller.delay = 3;
    LONGS_EQUAL(StreamOutcome::kDone, send(many_lines(300)).outcome);
    LONGS_EQUAL(304, controller.lines.size());
    CHECK(controller.most_unanswered <= 128);
    CHECK(controller.most_unanswered > 100);
}

TEST(Streamer, FillsTheBufferThatTheControllerTellsOf)
{
    controller.delay = 20;
    controller.answer = [](const std::string& line) -> std::string {
        return line == "$I" ? "[VER:1.1h.20190825:Grbl]\r\n[OPT:V,255,1024]\r\nok\r\n" : "ok\r\n";
    };
    send(many_lines(300));
    CHECK(controller.most_unanswered <= 1024);
    CHECK(controller.most_unanswered > 1000);
}

TEST(Streamer, LosesNothingWhenTheLineTakesOneByteAtATime)
{
    controller.mouthful = 1;
    LONGS_EQUAL(StreamOutcome::kDone, send(many_lines(50)).outcome);
    LONGS_EQUAL(54, controller.lines.size());
    STRCMP_EQUAL("G1X49F1000", controller.lines.back().c_str());
}

TEST(Streamer, NumbersTheLinesAsInTheFile)
{
    options.numbers = true;
    send("(head)\nG21\n\nN7 G1 X1 F100\n$100=800\n");
    STRCMP_EQUAL("N2G21", controller.lines[4].c_str());
    STRCMP_EQUAL("N4G1X1F100", controller.lines[5].c_str());
    STRCMP_EQUAL("$100=800", controller.lines[6].c_str());
}

TEST(Streamer, StopsAtTheFirstErrorHoldsAndResets)
{
    controller.answer = [](const std::string& line) -> std::string {
        return line == "G1X3F1000" ? "error:20\r\n" : "ok\r\n";
    };
    controller.delay = 3;
    const StreamReport report = send(many_lines(100));
    LONGS_EQUAL(StreamOutcome::kError, report.outcome);
    CHECK(report.text.find("part.ngc:4: error:20: ") != std::string::npos);
    STRCMP_EQUAL("!\x18", controller.realtime_bytes.c_str());
    CHECK(controller.lines.size() < 20);
}

TEST(Streamer, TellsOfAnAlarm)
{
    controller.answer = [](const std::string& line) -> std::string {
        return line == "G1X3F1000" ? "ALARM:1\r\n" : "ok\r\n";
    };
    const StreamReport report = send(many_lines(10));
    LONGS_EQUAL(StreamOutcome::kAlarm, report.outcome);
    CHECK(report.text.find("hard limit") != std::string::npos);
}

TEST(Streamer, HoldsAndResetsWhenItIsInterrupted)
{
    controller.answer = [this](const std::string& line) -> std::string {
        if (line == "G1X3F1000") {
            stop = 1;
        }
        return "ok\r\n";
    };
    LONGS_EQUAL(StreamOutcome::kStopped, send(many_lines(100)).outcome);
    STRCMP_EQUAL("!\x18", controller.realtime_bytes.c_str());
}

TEST(Streamer, SaysWhenTheLinkIsLost)
{
    controller.answer = [this](const std::string& line) -> std::string {
        controller.gone = line == "G1X3F1000";
        return "ok\r\n";
    };
    const StreamReport report = send(many_lines(100));
    LONGS_EQUAL(StreamOutcome::kLinkLost, report.outcome);
    CHECK(report.text.find("unplugged") != std::string::npos);
}

TEST(Streamer, NoticesAControllerThatStartsAnew)
{
    controller.answer = [this](const std::string& line) -> std::string {
        if (line == "G1X3F1000") {
            controller.say("\r\nGrbl 1.1h ['$' for help]\r\n");
        }
        return "ok\r\n";
    };
    LONGS_EQUAL(StreamOutcome::kLinkLost, send(many_lines(100)).outcome);
}

TEST(Streamer, SendsNothingToAControllerInAlarm)
{
    controller.state = "Alarm";
    const StreamReport report = send(many_lines(3));
    LONGS_EQUAL(StreamOutcome::kNotReady, report.outcome);
    LONGS_EQUAL(0, controller.lines.size());
}

TEST(Streamer, PassesKeysOnAsRealtimeBytes)
{
    controller.answer = [this](const std::string& line) -> std::string {
        if (line == "G1X3F1000") {
            watcher.next_key = StreamKey::kFeedUpTen;
        }
        return "ok\r\n";
    };
    LONGS_EQUAL(StreamOutcome::kDone, send(many_lines(10)).outcome);
    STRCMP_EQUAL("\x91", controller.realtime_bytes.c_str());
}

TEST(Streamer, ShowsWhereTheMachineIs)
{
    send(many_lines(10));
    DOUBLES_EQUAL(2.0, watcher.last.status.machine_position->y, 0.0);
    STRCMP_EQUAL("Idle", watcher.last.status.state.c_str());
}

// As a controller reports whose lines are still checked: the greeting believes no report that lost bytes.
TEST(Streamer, AReportWithAWrongChecksumIsNone)
{
    controller.report = [](const std::string& whole) {
        return whole + "*C0FFEE00";
    };
    CHECK(send("G1 X1\n").outcome == StreamOutcome::kNotReady);
    controller.report = [](const std::string& whole) {
        return whole + checksum_of(whole);
    };
    CHECK(send("G1 X1\n").outcome == StreamOutcome::kDone);
}
