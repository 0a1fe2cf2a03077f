// The whole controller under any bytes: never more than one answer for a line end, exactly one once
// it is idle, and no movement from a refused line.
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

#include "firmware/base/assert.hpp"
#include "firmware/protocol/realtime_command.hpp"
#include "firmware/protocol/receive_queue.hpp"
#include "tests/support/controller_bench.hpp"

namespace {

using cusp::ControllerBench;
using cusp::machine::State;

unsigned answers_in(const std::string& said)
{
    std::istringstream lines{said};
    std::string line;
    unsigned answers = 0;
    while (std::getline(lines, line)) {
        const bool ok = line.compare(0, 2, "ok") == 0;
        const bool error = line.compare(0, 6, "error:") == 0;
        const bool resend = line.compare(0, 8, "resend N") == 0;
        answers += ok || error || resend ? 1U : 0U;
    }
    return answers;
}

// All bytes at once, realtime ones included: nothing to check but that it lives.
void play_all(ControllerBench& bench, const std::string& bytes)
{
    std::size_t at = 0;
    while (at < bytes.size()) {
        const std::size_t count = 1 + static_cast<std::uint8_t>(bytes[at]) % 40U;
        (void)bench.exchange(bytes.substr(at, count), 3);
        at += count;
    }
    (void)bench.exchange("", 300);
}

bool curve_is_open(const std::string& modal)
{
    return modal.find("[GC:G5.2") != std::string::npos ||
           modal.find("[GC:G6.2") != std::string::npos;
}

// A quick and coarse mill: moves take few ticks and few pulses, so that many inputs are tried.
cusp::machine::Settings quick_mill()
{
    cusp::machine::Settings settings;
    for (unsigned axis = 0; axis < cusp::kAxisCount; ++axis) {
        (void)settings.put(100 + axis, 40.0F);
        (void)settings.put(110 + axis, 60000.0F);
        (void)settings.put(120 + axis, 20000.0F);
        (void)settings.put(800 + axis, 2e6F);
    }
    CUSP_ASSERT(settings.sound());
    return settings;
}

// Line by line, without realtime bytes.
void play_line(ControllerBench& bench, const std::string& line)
{
    constexpr unsigned kPatience = 200;
    const cusp::Position before = bench.app.machine().motion().position();
    const bool curve = curve_is_open(bench.exchange("$G\n", 1));
    const std::string said = bench.exchange(line + "\n", 2) + bench.finish(kPatience);
    const unsigned answers = answers_in(said);
    CUSP_ASSERT(answers <= 1);
    if (!bench.app.machine().idle()) {
        // Held, asleep, homing or on a long way: start afresh.
        (void)bench.exchange("\x18\x18\x18", 30);
        (void)bench.exchange("$X\n", 5);
        return;
    }
    const State state = bench.app.machine().state();
    const bool listens = state != State::kSleep && state != State::kAlarm;
    CUSP_ASSERT(answers == 1 || !listens);
    const bool refused = said.compare(0, 6, "error:") == 0;
    const cusp::Position after = bench.app.machine().motion().position();
    CUSP_ASSERT(!refused || curve || before == after);
    if (!listens) {
        (void)bench.exchange("\x18\x18\x18", 30);
        (void)bench.exchange("$X\n", 5);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    if (size < 2) {
        return 0;
    }
    static const cusp::machine::Settings settings = quick_mill();
    ControllerBench bench{{}, settings};
    (void)bench.exchange("", 2);
    const std::string bytes(data + 1, data + size);
    if (data[0] % 2 == 0) {
        play_all(bench, bytes);
        return 0;
    }
    std::string line;
    for (const char c : bytes) {
        const auto byte = static_cast<std::uint8_t>(c);
        if (cusp::protocol::is_line_end(byte)) {
            play_line(bench, line);
            line.clear();
        } else if (cusp::protocol::byte_kind(byte) == cusp::protocol::ByteKind::kText) {
            line += c;
        }
    }
    return 0;
}
