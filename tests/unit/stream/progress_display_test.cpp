// The bar of the streamer.
#include "host_tools/controller/stream/progress_display.hpp"

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::stream;

TEST_GROUP(ProgressDisplay)
{
    StreamProgress progress;
    void setup() override
    {
        progress.line = 12;
        progress.status.state = "Run";
        progress.status.machine_position = cusp::Vec3d{1.0, -2.5, 3.0};
        progress.work_offset = {1.0, 0.0, 0.0};
    }
};

TEST(ProgressDisplay, ShowsPercentLineTimeStateAndWorkPosition)
{
    const std::string line = progress_line(progress, 0.25, 3723.0, 120);
    CHECK(line.find("[##########....") == 0);
    CHECK(line.find(" 25.0 %  line 12  1:02:03 left  Run  X0.000 Y-2.500 Z3.000") !=
          std::string::npos);
}

TEST(ProgressDisplay, FitsEveryWidth)
{
    for (unsigned width = 1; width < 200; ++width) {
        CHECK(progress_line(progress, 2.0, 5.0, width).size() <= width);
    }
}

TEST(ProgressDisplay, OwnsToNotKnowingTheTimeLeft)
{
    CHECK(progress_line(progress, 0.5, std::nullopt, 120).find("? left") != std::string::npos);
}

TEST(ProgressDisplay, WritesTimesAsClocksDo)
{
    STRCMP_EQUAL("0:00", clock_text(-3.0).c_str());
    STRCMP_EQUAL("0:07", clock_text(6.6).c_str());
    STRCMP_EQUAL("59:59", clock_text(3599.0).c_str());
}
