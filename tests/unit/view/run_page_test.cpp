// The page of a run is equal for any number of threads.
#include "host_tools/judge/view/run_page.hpp"

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/judge/view/page_text.hpp"
#include "tests/support/temporary_folder.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::view;

TEST_GROUP(RunPage){};

TEST(RunPage, IsTheSameForAnyNumberOfThreads)
{
    const test::TemporaryFolder folder;
    // Corners of 45 degrees, which are cut.
    std::string text = "G21 G90 G64 P0.02 F600\n";
    for (int lap = 0; lap < 10; ++lap) {
        text += "G1 X20 Y0\nX30 Y10\nY20\nX20 Y30\nX0\nX-10 Y20\nY10\nX0 Y0\n";
    }
    const std::string program = folder.with("rows.ngc", text);
    if (page_text(Page::kView).empty()) {
        CHECK_THROWS(InputError, run_page(program, {}));
        return;
    }
    parallel::set_threads(1);
    RunPageOptions options;
    const RunPage alone = run_page(program, options);
    const auto plain = simulate::simulate(program, {});
    UNSIGNED_LONGS_EQUAL(plain.edges_crc32, alone.run.edges_crc32);
    DOUBLES_EQUAL(plain.max_deviation_mm, alone.run.max_deviation_mm, 0.0);
    LONGS_EQUAL(plain.max_deviation_line, alone.run.max_deviation_line);
    options.simulation.sums_edges = false;
    CHECK(alone.ticks > 100'000);  // several batches
    CHECK(alone.run.max_deviation_mm > 0.0001);
    for (const int threads : {2, 4}) {
        parallel::set_threads(threads);
        CHECK(run_page(program, options).html == alone.html);
    }
}
