// Tools of comments, and programs as straight cuts.
#include "host_tools/judge/verify/earlier_programs.hpp"

#include <cmath>
#include <cstdio>
#include <random>
#include <sstream>
#include <string>

#include "CppUTest/TestHarness.h"

#include "firmware/base/inch.hpp"
#include "host_tools/geometry/nurbs/plan_vector.hpp"
#include "host_tools/geometry/toolpath/gcode_text.hpp"
#include "host_tools/geometry/toolpath/gcode_writer.hpp"
#include "host_tools/geometry/toolpath/tool.hpp"
#include "host_tools/judge/verify/program_moves.hpp"
#include "host_tools/judge/verify/tool_comment.hpp"
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
    const Tool tools[]{
        {1, ToolShape::kFlat, 5, 0},       {2, ToolShape::kBall, 3, 3},
        {3, ToolShape::kBull, 3.175, 0.5}, {255, ToolShape::kVee, 3, 0, kHalfTurn / 3},
        {5, ToolShape::kDrill, 2.5, 0, 2}, {6, ToolShape::kTaper, 3, 0.5, kHalfTurn / 6}};
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

// A tool of any shape with sizes of any number of digits.
static Tool random_tool(std::mt19937& random)
{
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>{low, high}(random);
    };
    const ToolShape shapes[]{ToolShape::kBall, ToolShape::kFlat,  ToolShape::kBull,
                             ToolShape::kVee,  ToolShape::kDrill, ToolShape::kTaper};
    Tool tool;
    tool.number = static_cast<int>(uniform(1, 255));
    tool.shape = shapes[static_cast<std::size_t>(uniform(0, 5.999))];
    tool.radius = uniform(0.05, 20);
    if (tool.shape == ToolShape::kBall) {
        tool.corner_radius = tool.radius;
    } else if (tool.shape == ToolShape::kBull) {
        tool.corner_radius = uniform(0.1, 1) * tool.radius;
    } else if (is_conical(tool)) {
        tool.tip_angle = uniform(0.05, 3);
        const double end = uniform(0.01, 0.99) * tool.radius;
        const bool ball = tool.shape == ToolShape::kTaper && uniform(0, 1) < 0.5;
        (ball ? tool.corner_radius : tool.tip_radius) = tool.shape == ToolShape::kDrill ? 0 : end;
    }
    return tool;
}

TEST(ToolComment, has_all_sizes_in_every_form_of_program)
{
    constexpr unsigned kSeed = 48;
    constexpr double kSame = 2e-6;  // mm and radians
    std::mt19937 random{kSeed};
    std::printf("tools: seed %u\n", kSeed);
    cusp::test::TemporaryFolder folder;
    for (int i = 0; i < 300; ++i) {
        Toolpath path;
        path.tool = random_tool(random);
        path.tool_name = i % 3 == 0 ? "one of 6 mm (two flutes)" : "";
        path.feed = path.plunge_feed = 100;
        path.moves = {{MoveKind::kRapid, LineTo{{1, 1, 5}}},
                      {MoveKind::kPlunge, LineTo{{1, 1, 0}}}};
        ProgramForm form{"test", i % 2 == 0, 5, {}, {}};
        form.post.comments = i % 5 == 0 ? CommentForm::kSemicolon : CommentForm::kParentheses;
        if (i % 7 < 3) {
            form.post.first_tool = {"T{tool} M6 {comment}"};
        }
        std::ostringstream out;
        write_program(out, form, {{path, {}}});
        const Program program = read_program({}, folder.with("p.ngc", out.str()), 5);
        LONGS_EQUAL(1, program.tools.size());
        const Tool& tool = program.tools.begin()->second.tool;
        LONGS_EQUAL(path.tool.number, tool.number);
        CHECK(path.tool.shape == tool.shape);
        DOUBLES_EQUAL(path.tool.radius, tool.radius, kSame);
        DOUBLES_EQUAL(path.tool.corner_radius, tool.corner_radius, kSame);
        DOUBLES_EQUAL(path.tool.tip_radius, tool.tip_radius, kSame);
        DOUBLES_EQUAL(path.tool.tip_angle, tool.tip_angle, kSame);
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
    job.operations[0].rest.after = {"c", "a"};
    job.operations[1].rest.after = {"c", "d"};
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

namespace {

// z to which a tool on a straight move cuts at a place.
double cut_height(const Tool& tool, Vec3d from, Vec3d to, Vec2d p)
{
    constexpr int kPlaces = 400;
    double z = kInfinite;
    for (int i = 0; i <= kPlaces; ++i) {
        const Vec3d tip = from + (static_cast<double>(i) / kPlaces) * (to - from);
        z = std::min(z, tip.z + profile_height(tool, norm(p - in_plan(tip))));
    }
    return z;
}

}  // namespace

// Random moves of random tools in a block of 8 mm: a place that counts as absent on the other side was cut
// down to the bottom, and one that a level move has cut so counts.
TEST(EarlierPrograms, of_the_other_side_are_what_they_cut_through)
{
    constexpr unsigned kSeed = 28;
    std::printf("flips: seed %u\n", kSeed);
    std::mt19937 engine{kSeed};
    const auto draw = [&](double low, double high) {
        return std::uniform_real_distribution<double>{low, high}(engine);
    };
    const Tool shapes[]{{1, ToolShape::kFlat, 2, 0},     {1, ToolShape::kBall, 2, 2},
                        {1, ToolShape::kBull, 2, 0.5},   {1, ToolShape::kVee, 3, 0, 1.2},
                        {1, ToolShape::kDrill, 2, 0, 2}, {1, ToolShape::kTaper, 3, 0.5, 0.5}};
    job.stock_top = 2;
    job.stock_bottom = -6;
    job.stock_x = {0, 40};
    job.stock_y = {-10, 30};
    job.setup = Setup{"back", 55, Flip::kX};
    int gone = 0;
    for (int i = 0; i < 300; ++i) {
        const Tool& tool = shapes[i % 6];
        job.tools = {tool};
        const bool level = i % 2 == 0;
        const Vec3d from{draw(5, 35), draw(-5, 25), std::round(draw(-9, -4) * 100) / 100};
        const Vec3d to{draw(5, 35), draw(-5, 25),
                       level ? from.z : std::round(draw(-9, -4) * 100) / 100};
        char text[200];
        std::snprintf(text, sizeof text, "G0 X%.4f Y%.4f Z5\nG1 Z%.4f F100\nX%.4f Y%.4f Z%.4f\n",
                      from.x, from.y, from.z, to.x, to.y, to.z);
        job.turned_programs.clear();
        add_earlier_program(job, {"front", 54, Flip::kNone}, folder.with("p.ngc", text));
        const auto cuts = earlier_cuts(job, job.turned_programs.front());
        for (int k = 0; k < 40; ++k) {
            const double along = draw(0, 1);
            const Vec2d p{from.x + along * (to.x - from.x) + draw(-3, 3),
                          from.y + along * (to.y - from.y) + draw(-3, 3)};
            const Vec2d turned{p.x, 20 - p.y};
            bool counts = false;
            for (const EarlierCut& cut : cuts) {
                counts =
                    counts || cut_height(cut.tool, cut.from, cut.to, turned) <= *job.stock_bottom;
            }
            const double cut = cut_height(tool, from, to, p);
            CHECK(!counts || cut <= *job.stock_bottom + 1e-3);
            CHECK(counts || !level || cut > *job.stock_bottom - 1e-2);
            gone += counts ? 1 : 0;
        }
    }
    CHECK(gone > 1000);
}

TEST(EarlierPrograms, of_a_set_up_turned_round_twice_are_turned_about_z)
{
    job.stock_top = 2;
    job.stock_bottom = -6;
    job.stock_x = {0, 40};
    job.stock_y = {-10, 30};
    job.setup = Setup{"c", 56, Flip::kY};
    add_earlier_program(job, {"b", 55, Flip::kX},
                        folder.with("p.ngc", "G0 X1 Y2 Z5\nG1 Z-1 F100\nX4\n"));
    const auto cuts = earlier_cuts(job, job.turned_programs.front());
    LONGS_EQUAL(2, cuts.size());
    DOUBLES_EQUAL(39, cuts[1].from.x, 1e-9);
    DOUBLES_EQUAL(18, cuts[1].from.y, 1e-9);
    DOUBLES_EQUAL(36, cuts[1].to.x, 1e-9);
    DOUBLES_EQUAL(-1, cuts[1].to.z, 1e-9);
    add_earlier_program(job, {"d", 57, Flip::kY}, "same.ngc");
    CHECK(job.stock_programs == std::vector<std::string>{"same.ngc"});
}
