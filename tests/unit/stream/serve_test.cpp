// A streamer and a virtual controller, over a pseudo-terminal, on clean and on bad lines.
#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "host_tools/controller/simulate/virtual_controller.hpp"
#include "host_tools/controller/stream/streamer.hpp"
#include "tests/support/leaks_on_threads.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

using namespace cusp;

struct SilentWatcher : stream::StreamWatcher {
    void ready(const stream::ControllerFacts&) override {}
    void progress(const stream::StreamProgress&) override {}
    void notice(const std::string&) override {}
    stream::StreamKey key() override { return stream::StreamKey::kNone; }
};

}  // namespace

TEST_GROUP(Serve)
{
    // A busy computer must not count as a silent controller.
    static constexpr std::chrono::seconds kPatience{60};
    test::TemporaryFolder folder;
    simulate::ServeOptions serve_options;
    stream::StreamOptions options;
    std::atomic<int> serve_stop{0};
    std::atomic<int> stream_stop{0};

    stream::StreamReport stream(const std::string& text)
    {
        options.silence_limit = kPatience;
        options.greeting_limit = kPatience;
        serve_options.pty_link = folder.file("port");
        std::thread server{[this] {
            simulate::serve(serve_options, serve_stop);
        }};
        while (!std::filesystem::exists(serve_options.pty_link)) {
            std::this_thread::sleep_for(std::chrono::milliseconds{1});
        }
        stream::StreamReport report;
        {
            const auto transport = stream::open_transport(serve_options.pty_link, 0);
            SilentWatcher watcher;
            dialect::ProgramLines program{folder.with("part.ngc", text)};
            report = stream::Streamer{*transport, watcher, options}.run(program, stream_stop);
        }
        serve_stop = 1;
        server.join();
        serve_stop = 0;
        return report;
    }
    // Net steps of X. Status reports are no oracle: the line damages them.
    static int net_steps_x(const std::string& vcd)
    {
        std::istringstream in{vcd};
        int steps = 0;
        bool backwards = false;
        for (std::string word; std::getline(in, word);) {
            if (word == "1\"" || word == "0\"") {
                backwards = word[0] == '1';
            }
            steps += word == "1!" ? (backwards ? -1 : 1) : 0;
        }
        return std::abs(steps);
    }
    static std::string zigzag(int lines)
    {
        std::string text = "G21 G90 G64\n";
        for (int i = 0; i < lines; ++i) {
            text += "G1 X" + std::to_string(i % 7) + " Y" + std::to_string(i % 3) + " F6000\n";
        }
        return text + "G1 X0.5 Y0.25\n";
    }
};

TEST(Serve, TakesAProgramToItsEnd)
{
    const stream::StreamReport report = stream(zigzag(20));
    STRCMP_EQUAL("", report.text.c_str());
    LONGS_EQUAL(stream::StreamOutcome::kDone, report.outcome);
    LONGS_EQUAL(22, report.progress.lines_answered);
    DOUBLES_EQUAL(0.5, report.progress.status.machine_position->x, 1e-9);
}

TEST(Serve, StopsTheStreamerAtABadLine)
{
    const stream::StreamReport report = stream("G21\nG1 X1 F1000\nG1 X2 Q1 B5\nG1 X50\n");
    LONGS_EQUAL(stream::StreamOutcome::kError, report.outcome);
    CHECK(report.text.find("part.ngc:3: error:") != std::string::npos);
}

TEST(Serve, RunsEachCheckedLineOnceOnALineThatDamagesBytes)
{
    options.checked = true;
    serve_options.faults.noise = 0.002;
    serve_options.faults.loss = 0.001;
    serve_options.faults.doubling = 0.001;
    serve_options.seed = 11;
    serve_options.vcd_file = folder.file("steps.vcd");
    std::string text = "G21 G91 G64\n";
    for (int i = 0; i < 61; ++i) {
        text += i % 3 == 0 ? "G1 X-1 F6000\n" : "G1 X2 F6000\n";
    }
    const stream::StreamReport report = stream(text);
    STRCMP_EQUAL("", report.text.c_str());
    LONGS_EQUAL(stream::StreamOutcome::kDone, report.outcome);
    LONGS_EQUAL(62, report.progress.lines_answered);
    CHECK(report.progress.lines_resent > 0);
    const double steps_per_mm = machine::Settings{}.value(machine::Setting::kStepsPerMillimetre);
    DOUBLES_EQUAL(59 * steps_per_mm, net_steps_x(folder.text_of("steps.vcd")), 0.5);
}

TEST(Serve, KeepsSettingsInItsFile)
{
    serve_options.settings_file = folder.file("mill.txt");
    LONGS_EQUAL(stream::StreamOutcome::kDone, stream("$110=4321\n").outcome);
    CHECK(folder.text_of("mill.txt").find("$110=4321.000\n") != std::string::npos);
    std::filesystem::remove(folder.file("mill.txt"));
    LONGS_EQUAL(stream::StreamOutcome::kDone, stream("G4 P0.01\n").outcome);
    CHECK(folder.text_of("mill.txt").find("$110=4321.000\n") != std::string::npos);
}
