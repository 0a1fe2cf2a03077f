// Input shaping by settings, and what must wait until the shaper is empty.
#include <string>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"

using namespace cusp;

TEST_GROUP(InputShaping)
{
    ControllerBench bench;

    // ZVD of 25 Hz on X: 40 ms.
    void shape() { (void)bench.exchange("$820=25\n$830=0.02\n$810=2\n", 400); }

    void run_to(const char* state)
    {
        for (unsigned i = 0; i < 3000; ++i) {
            if (has_text(bench.exchange("?", 1), state)) {
                return;
            }
        }
        FAIL(state);
    }

    void check_nothing_moves()
    {
        const Vec3d here = bench.position();
        for (unsigned i = 0; i < 300; ++i) {
            bench.run(1);
            CHECK(here == bench.position());
        }
    }
};

TEST(InputShaping, RefusesWhatIsOutOfRangeWithTheRange)
{
    std::string answer = bench.exchange("$820=9.9\n", 100);
    CHECK(has_text(answer, "[MSG:$820 is 9.900, range 10.000 to 200.000]"));
    CHECK(has_text(answer, "error:4"));
    answer = bench.exchange("$821=200.1\n", 100);
    CHECK(has_text(answer, "[MSG:$821 is 200.100, range 10.000 to 200.000]"));
    CHECK(has_text(answer, "error:38"));
    answer = bench.exchange("$832=1\n", 100);
    CHECK(has_text(answer, "[MSG:$832 is 1.000, range 0.000 to 0.990]"));
    answer = bench.exchange("$812=4\n", 100);
    CHECK(has_text(answer, "[MSG:$812 is 4.000, range 0.000 to 3.000]"));
}

TEST(InputShaping, RefusesShapersLongerThanItsMemory)
{
    std::string answer = bench.exchange("$820=10\n$810=2\n", 400);
    CHECK_FALSE(has_text(answer, "error"));
    answer = bench.exchange("$821=20\n$811=2\n", 400);
    CHECK(has_text(answer, "[MSG:$820 / $810 asks for a filter of 154.000 ms, most 128.000 ms]"));
    CHECK(has_text(answer, "error:38"));
}

TEST(InputShaping, DrainsBeforeADwellAndTheEnd)
{
    shape();
    (void)bench.exchange("G21G91\n", 50);
    // The last line is there so that the move before it doesn't wait for what may follow.
    bench.board.byte_link.send("G1X3F6000\nG4P0.3\nG1X-1\nM5\n");
    // The dwell is 300 ticks at the end of the first move, to the nanometre.
    unsigned at_end = 0;
    for (unsigned i = 0; i < 3000 && !(at_end > 0 && bench.app.machine().idle()); ++i) {
        bench.run(1);
        at_end += bench.position() == Vec3d{3, 0, 0} ? 1U : 0U;
    }
    CHECK(at_end >= 300 && at_end < 310);
    CHECK((bench.position() == Vec3d{2, 0, 0}));
    check_nothing_moves();
}

TEST(InputShaping, DrainsBeforeAHoldIsComplete)
{
    shape();
    (void)bench.exchange("G21G91\nG1X30F6000\n", 100);
    (void)bench.exchange("!", 1);
    run_to("<Hold:0");
    CHECK(bench.position().x > 0.5 && bench.position().x < 29);
    check_nothing_moves();
    (void)bench.exchange("~", 1);
    (void)bench.finish();
    CHECK((bench.position() == Vec3d{30, 0, 0}));
}

TEST(InputShaping, DrainsBeforeACancelledJogIsOver)
{
    shape();
    (void)bench.exchange("$J=G21G91X30F6000\n", 100);
    (void)bench.exchange("\x85", 1);
    run_to("<Idle");
    CHECK(bench.position().x > 0.5 && bench.position().x < 29);
    check_nothing_moves();
}
