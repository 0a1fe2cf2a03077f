// Feeds and speeds: the tool's own, else the job's.
#include "CppUTest/TestHarness.h"

#include "host_tools/job/job/job.hpp"

using namespace cusp;
using namespace cusp::job;

namespace {

Job example()
{
    Job job;
    job.feed = 1000;
    job.plunge_feed = 250;
    job.spindle = 12000;
    job.tool_facts[2].name = "6mm flat";
    return job;
}

}  // namespace

TEST_GROUP(ToolRates){};

TEST(ToolRates, AreTheJobsWhereTheToolHasNone)
{
    toolpath::Toolpath path;
    set_tool(path, example(), {1, toolpath::ToolShape::kFlat, 3, 0});
    DOUBLES_EQUAL(1000, path.feed, 0);
    DOUBLES_EQUAL(250, path.plunge_feed, 0);
    DOUBLES_EQUAL(12000, path.spindle, 0);
    STRCMP_EQUAL("", path.tool_name.c_str());
}

TEST(ToolRates, AreTheToolsOwn)
{
    toolpath::Tool tool{2, toolpath::ToolShape::kFlat, 3, 0};
    tool.rates = {600, 100, 0.0};
    toolpath::Toolpath path;
    set_tool(path, example(), tool);
    DOUBLES_EQUAL(600, path.feed, 0);
    DOUBLES_EQUAL(100, path.plunge_feed, 0);
    DOUBLES_EQUAL(0, path.spindle, 0);
    STRCMP_EQUAL("6mm flat", path.tool_name.c_str());
    LONGS_EQUAL(2, path.tool.number);
}
