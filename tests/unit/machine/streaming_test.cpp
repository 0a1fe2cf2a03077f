#include <cmath>
#include <cstdio>
#include <deque>
#include <optional>
#include <string>
#include <variant>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"

namespace {

struct Link {
    std::size_t window;  // bytes outstanding; 1: waits for each answer
    unsigned latency;    // ticks from an answer to the bytes that it lets go
    std::uint32_t bits_per_second;
};

// Sends a straight line of 50 mm in pieces at 100 mm/s; returns the ticks in which it moved.
unsigned moving_ticks(const Link& link, unsigned pieces)
{
    cusp::ControllerBench bench;
    (void)bench.exchange("", 5);
    bench.board.byte_link.set_bits_per_second(link.bits_per_second);
    std::deque<std::size_t> sizes;
    std::deque<unsigned> freed_at;
    std::size_t outstanding = 0;
    unsigned sent = 0;
    unsigned first = 0;
    unsigned last = 0;
    for (unsigned tick = 1; tick < 20000; ++tick) {
        while (sent < pieces) {
            char line[32];
            (void)std::snprintf(line, sizeof line, "G1X%.3fF6000\n", (sent + 1) * 50.0 / pieces);
            const std::string text{line};
            if (outstanding > 0 && outstanding + text.size() > link.window) {
                break;
            }
            bench.board.byte_link.send(text);
            sizes.push_back(text.size());
            outstanding += text.size();
            ++sent;
        }
        bench.run(1);
        const std::string said = bench.board.byte_link.take_answers();
        for (const char c : said) {
            if (c == 'k') {
                freed_at.push_back(tick + link.latency);
            }
        }
        for (; !freed_at.empty() && freed_at.front() <= tick; freed_at.pop_front()) {
            outstanding -= sizes.front();
            sizes.pop_front();
        }
        if (bench.app.machine().motion().speed() > 0) {
            first = first == 0 ? tick : first;
            last = tick;
        }
        if (sent == pieces && sizes.empty() && bench.app.machine().idle()) {
            break;
        }
    }
    DOUBLES_EQUAL(50.0, bench.position().x, 1e-9);
    return last - first + 1;
}

// 50 mm at 100 mm/s, 1000 mm/s^2, 50000 mm/s^3: 0.5 + 0.1 + 0.02 s.
constexpr unsigned kLeastTicks = 620;

}  // namespace

TEST_GROUP(Streaming){};

TEST(Streaming, KeepsUpWithTenthsOfAMillimetreOverAMegabaud)
{
    CHECK(moving_ticks({127, 1, 1000000}, 500) <= kLeastTicks + 10);
    CHECK(moving_ticks({1000, 1, 1000000}, 1000) <= kLeastTicks + 10);
}

TEST(Streaming, DoesNotStopBetweenLinesOfASenderThatWaitsForEachAnswer)
{
    // The speed is limited by what is known of the path; a stop at each line would take 2 s more.
    CHECK(moving_ticks({1, 10, 0}, 10) <= kLeastTicks + 200);
    CHECK(moving_ticks({1, 4, 0}, 50) <= kLeastTicks + 300);
}
