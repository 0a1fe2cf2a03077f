// Tools of comments, and programs as straight cuts.
#include "host_tools/verify/earlier_programs.hpp"

#include "CppUTest/TestHarness.h"

#include "firmware/base/inch.hpp"
#include "host_tools/nurbs/plan_vector.hpp"
#include "host_tools/toolpath/gcode_text.hpp"
#include "host_tools/verify/tool_comment.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::job;
using namespace cusp::toolpath;
using namespace cusp::verify;

TEST_GROUP(ToolComment){};

TEST(ToolComment, describes_each_tool_as_it_was_written)
{
    constexpr double kHalfTurn = 3.14159265358979323846;
    const Tool tools[]{{1, ToolShape::kFlat, 5, 0},
                       {2, ToolShape::kBall, 3, 3},
                       {3, ToolShape::kBull, 3.175, 0.5},
                       {255, ToolShape::kVee, 3, 0, kHalfTurn / 3},
                       {5, ToolShape::kDrill, 2.5, 0, 2}};
    for (const Tool& tool : tools) {
        Toolpath path;
        path.tool = tool;
        for (const char* name : {"", "6mm (two flutes)"}) {
            path.tool_name = name;
            for (const bool inch : {false, true}) {
                const std::string text =
                    tool_text(path, inch ? kMillimetresPerInch : 1.0, inch ? "inch" : "mm");
                for (const std::string& line : {"(" + text + ")", "; " + text}) {
                    const auto found = tool_of_comment(line);
                    CHECK(found.has_value());
                    LONGS_EQUAL(tool.number, found->number);
                    CHECK(tool.shape == found->shape);
                    DOUBLES_EQUAL(tool.radius, found->radius, 2e-3);
                    DOUBLES_EQUAL(tool.corner_radius, found->corner_radius, 2e-3);
                    DOUBLES_EQUAL(tool.tip_angle, found->tip_angle, 1e-4);
                }
            }
        }
    }
}

TEST(ToolComment, is_no_other_line)
{
    for (const char* line :
         {"", "(", "tool 1 flat diameter 6 mm", "(tool 1 flat diameter 6)", "(tool 1)",
          "(tool 1.5 flat diameter 6 mm)", "(tool 1 flat diameter -6 mm)",
          "(tool 1 flat diameter nan mm)", "(tool 1 round diameter 6 mm)",
          "(tool 1 bull diameter 6 mm)", "(tool 1 bull diameter 6 mm corner radius 4 mm)",
          "(tool 1 vee diameter 6 mm)", "(tool 1 vee diameter 6 mm tip angle 180)",
          "(tools 1 flat diameter 6 mm)"}) {
        CHECK(!tool_of_comment(line));
    }
}

TEST_GROUP(EarlierPrograms)
{
    cusp::test::TemporaryFolder folder;
    Job job;

    void setup() override
    {
        job.file = "job.toml";
        job.tools = {{1, ToolShape::kFlat, 2, 0}};
    }
    std::vector<EarlierCut> cuts(const std::string& text)
    {
        return earlier_cuts(job, folder.with("p.ngc", text));
    }
};

TEST(EarlierPrograms, are_cut_by_feed_moves_alone)
{
    const auto found = cuts("G0 Z5\nG0 X1 Y2\nG1 Z-1 F100\nX9\nG0 Z5\nX0\n");
    LONGS_EQUAL(2, found.size());
    CHECK(found[1].from == (Vec3d{1, 2, -1}));
    CHECK(found[1].to == (Vec3d{9, 2, -1}));
    CHECK(!found[1].is_chord);
    DOUBLES_EQUAL(2, found[1].tool.radius, 0);
}

TEST(EarlierPrograms, have_arcs_as_chords_inside_them)
{
    const auto found = cuts("G0 X10 Y0\nG0 Z0\nG3 X-10 Y0 I-10 J0 F100\n");
    CHECK(found.size() > 10);
    for (const EarlierCut& cut : found) {
        CHECK(cut.is_chord);
        const Vec3d middle = 0.5 * (cut.from + cut.to);
        CHECK(10 - norm(in_plan(middle)) < 2.1e-4);
        DOUBLES_EQUAL(10, norm(in_plan(cut.to)), 1e-5);
    }
}

TEST(EarlierPrograms, take_a_comment_before_the_jobs_tool)
{
    const auto found = cuts("(tool 1 ball diameter 6 mm)\nT1\nG0 Z5\nG1 X5 F100\n");
    LONGS_EQUAL(1, found.size());
    DOUBLES_EQUAL(3, found[0].tool.corner_radius, 0);
}

TEST(EarlierPrograms, need_no_tool_that_cuts_nothing)
{
    LONGS_EQUAL(1, cuts("T9\nG0 Z5\nG0 X5\nT1\nG1 X0 F100\n").size());
    CHECK(cusp::test::refusal([&] {
              cuts("T9\nG0 Z5\nG1 X5 F100\n");
          }).find("tool 9 is not known") != std::string::npos);
    job.tools.push_back({2, ToolShape::kFlat, 1, 0});
    CHECK(cusp::test::refusal([&] {
              cuts("G0 Z5\nG1 X5 F100\n");
          }).find("neither a T word nor a comment") != std::string::npos);
}

TEST(EarlierPrograms, are_those_of_the_stock_then_of_the_operations)
{
    job.stock_programs = {"a", "b"};
    job.operations.resize(2);
    job.operations[0].after = {"c", "a"};
    job.operations[1].after = {"c", "d"};
    const std::vector<std::string> wanted{"a", "b", "c", "d"};
    CHECK(wanted == earlier_programs(job));
}

TEST(EarlierPrograms, leave_the_stock_of_the_judge)
{
    job.stock_programs = {folder.with(
        "p.ngc", "T9\nG0 Z5\nT1\nG0 X0 Y5\nG1 Z-1 F100\nX10\nT9\nG0 Z5\nX0 Y0\nT1\nG1 Z4\n")};
    MachinedStock stock{{0.05, 0.05, 0.1, 100, 100, false}, 0.0};
    // half of a stadium's straight sides, and half of its ends
    const double area = 10 * 4;
    DOUBLES_EQUAL(area, cut_earlier_programs(job, 0.05, stock), 0.5);
}
