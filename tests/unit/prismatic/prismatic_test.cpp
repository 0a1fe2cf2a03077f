// Jobs of 2.5-D operations as a shop writes them: parsing, refusals with their places, and
// verdicts on correct and on spoiled programs.
#include "host_tools/cam/prismatic/prismatic.hpp"

#include <cmath>
#include <string>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/geometry/toolpath/gcode_writer.hpp"
#include "host_tools/job/import/import.hpp"
#include "host_tools/judge/verify/verify.hpp"
#include "tests/support/leaks_on_threads.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::job;
using namespace cusp::prismatic;
using namespace cusp::test;
using namespace cusp::toolpath;
using namespace cusp::verify;

namespace {

std::string circle(const char* layer, double x, double y, double radius)
{
    return "0\nCIRCLE\n8\n" + std::string{layer} + "\n10\n" + std::to_string(x) + "\n20\n" +
           std::to_string(y) + "\n40\n" + std::to_string(radius) + "\n";
}

std::string rectangle(const char* layer, double x0, double y0, double x1, double y1)
{
    std::string text = "0\nLWPOLYLINE\n8\n" + std::string{layer} + "\n90\n4\n70\n1\n";
    const double corners[4][2]{{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    for (const auto& p : corners) {
        text += "10\n" + std::to_string(p[0]) + "\n20\n" + std::to_string(p[1]) + "\n";
    }
    return text;
}

// An outline of 40 x 30 mm with a window, holes of 3 and 5 mm, a point, a small ring.
std::string drawing()
{
    return "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" +
           rectangle("outline", 0, 0, 40, 30) + rectangle("window", 0, 0, 40, 30) +
           rectangle("window", 10, 8, 30, 22) + circle("holes", 5, 5, 1.5) +
           circle("holes", 35, 5, 1.5) + circle("holes", 35, 25, 2.5) +
           "0\nPOINT\n8\nholes\n10\n20\n20\n4\n" + circle("ring", 20, 15, 2) +
           circle("dot", 20, 15, 1) + "0\nENDSEC\n0\nEOF\n";
}

const std::string kHead = R"(
[[tool]]
shape = "flat"
diameter = 3
[[tool]]
shape = "drill"
diameter = 3
[[tool]]
shape = "vee"
diameter = 6
tip_angle = 90
[[tool]]
shape = "drill"
diameter = 5
[cutting]
feed = 1000
[stock]
x = [-5, 45]
y = [-5, 35]
[[operation]]
)";

std::vector<PlannedOperation> plan(const Job& job)
{
    std::vector<PlannedOperation> all;
    for (const Operation& operation : job.operations) {
        const auto add = [&](std::vector<PlannedOperation> planned) {
            all.insert(all.end(), planned.begin(), planned.end());
        };
        if (operation.cuts(job::Region::kOutline)) {
            add(plan_profile(job, operation));
        } else if (operation.cuts(job::Region::kHoles)) {
            add(plan_drill(job, operation));
        } else if (operation.cuts(job::Region::kTop)) {
            add(plan_face(job, operation));
        } else if (operation.cuts(job::Region::kGrooves)) {
            add(plan_engrave(job, operation));
        } else if (operation.cuts(job::Region::kEdges)) {
            add(plan_chamfer(job, operation));
        } else if (operation.cuts(job::Region::kValleys)) {
            add(plan_v_carve(job, operation));
        }
    }
    return all;
}

}  // namespace

TEST_GROUP(Prismatic)
{
    TemporaryFolder folder;

    void setup() override { folder.with("plate.dxf", drawing()); }

    Job job_of(const std::string& operations) const
    {
        return read_job(folder.with("job.toml", kHead + operations), cusp::strategies::all());
    }

    // The message with which the operation is refused, on reading or planning.
    std::string why_not(const std::string& operation) const
    {
        return refusal([&] { plan(job_of(operation)); });
    }

    std::string program_of(const Job& job) const
    {
        std::ofstream out{folder.file("plate.ngc")};
        write_program(out, {"test", false, job.stock_top + job.clearance, {}}, plan(job));
        return folder.file("plate.ngc");
    }

    // The broken bounds, with every " X" of the program that is in `from` replaced.
    std::string broken(const std::string& operations, const std::string& from = "",
                       const std::string& to = "") const
    {
        const Job job = job_of(operations);
        const std::string program = program_of(job);
        if (!from.empty()) {
            std::string text = folder.text_of("plate.ngc");
            const std::size_t at = text.find(from);
            CHECK(at != std::string::npos);
            folder.with("plate.ngc", text.replace(at, from.size(), to));
        }
        std::string all;
        for (const std::string& sentence : verify::verify(job, program, {}, [](double) {}).broken) {
            all += sentence + "\n";
        }
        return all;
    }
};

#define REFUSED(operation, part)                                                         \
    do {                                                                                 \
        const std::string said = why_not(operation);                                     \
        CHECK_TEXT(said.find(part) != std::string::npos, (said + "|" + (part)).c_str()); \
    } while (false)

TEST(Prismatic, HolesAreChosenByDiameter)
{
    const auto holes = [&](const std::string& keys) {
        return job_of("strategy = \"drill\"\nboundary = \"plate.dxf#holes\"\ndepth = 4\n" + keys)
            .operations[0]
            .prismatic->holes.size();
    };
    LONGS_EQUAL(4, holes("tool = 2"));
    LONGS_EQUAL(2, holes("tool = 2\ndiameter = 3"));
    LONGS_EQUAL(3, holes("tool = 2\ndiameter = [3, 5]"));
}

TEST(Prismatic, HolesNarrowerThanTheDrillAreLeftOutWithAWarningEach)
{
    const Job job =
        job_of("strategy = \"drill\"\nboundary = \"plate.dxf#holes\"\ndepth = 4\ntool = 4");
    LONGS_EQUAL(2, job.operations[0].prismatic->holes.size());
    const std::vector<std::string> warnings = plan(job).front().stats.warnings;
    LONGS_EQUAL(2, warnings.size());
    CHECK(
        warnings[1].find("hole of 3 mm at x 35 y 5 mm is narrower than tool 4 of 5 mm: left out") !=
        std::string::npos);
}

TEST(Prismatic, HolesThatAreTooNarrowOrNotThereAreRefused)
{
    REFUSED(
        "strategy = \"drill\"\nboundary = \"plate.dxf#holes\"\ndepth = 4\ntool = 3\ndiameter = 3",
        "the hole of 3 mm at x 5 y 5 mm is smaller than tool 3 of 6 mm");
    REFUSED(
        "strategy = \"drill\"\nboundary = \"plate.dxf#holes\"\ndepth = 4\ntool = 2\n"
        "diameter = 4",
        "no circle of the wanted diameter; there are 3, 5 mm");
    REFUSED("strategy = \"drill\"\nboundary = \"plate.dxf#outline\"\ndepth = 4\ntool = 2",
            "no point and no circle to drill");
}

TEST(Prismatic, WiderHolesAreNoted)
{
    const Job job =
        job_of("strategy = \"drill\"\nboundary = \"plate.dxf#holes\"\ndepth = 4\ntool = 2");
    LONGS_EQUAL(1, job.notes.size());
    CHECK(job.notes[0].find("1 of 4 holes is wider than tool 2") != std::string::npos);
}

TEST(Prismatic, AnInsideThatNoToolEntersIsRefusedWithItsPlace)
{
    REFUSED("strategy = \"profile\"\nboundary = \"plate.dxf#dot\"\nside = \"inside\"\ndepth = 2",
            "plate.dxf#dot: tool 1 of 3 mm fits nowhere inside the loops");
}

TEST(Prismatic, LoopsWithoutRoomAreLeftOutWithAWarning)
{
    const Job job = job_of(
        "strategy = \"profile\"\nboundary = \"plate.dxf#holes\"\nside = \"inside\"\ndepth = 2");
    const PlannedOperation planned = plan_profile(job, job.operations[0]).front();
    LONGS_EQUAL(3, planned.stats.warnings.size());
    STRCMP_CONTAINS("tool 1 of 3 mm fits nowhere along the loop at x 6.5 y 5 mm: not cut",
                    (planned.stats.warnings[0] + planned.stats.warnings[1]).c_str());
}

// If the allowance leaves no room, the last pass would meet stock at full depth.
TEST(Prismatic, WhatIsNotRoughedIsCutLevelByLevel)
{
    const auto passes = [&](const char* allowance) {
        const Job job =
            job_of(std::string{"strategy = \"profile\"\nboundary = \"plate.dxf#ring\"\nside = "
                               "\"inside\"\ndepth = 2\nmax_depth = 1\nallowance = "} +
                   allowance);
        return plan_profile(job, job.operations[0]).front().stats.passes;
    };
    LONGS_EQUAL(3, passes("0.1"));  // two levels, and the last pass at the bottom
    LONGS_EQUAL(2, passes("1.0"));
}

TEST(Prismatic, TabsAreCheckedAgainstTheCut)
{
    const std::string cut = "strategy = \"profile\"\nboundary = \"plate.dxf#outline\"\ndepth = 2\n";
    REFUSED(cut + "tabs = { count = 4, width = 5, height = 2 }",
            "height is 2 mm, the cut is only 2 mm deep");
    REFUSED(cut + "tabs = { width = 5, height = 1 }", "either count or places is needed");
    REFUSED(cut + "tabs = { count = 40, width = 5, height = 1 }", "has no room");
    REFUSED(cut + "tabs = { places = [20, 90], width = 5, height = 1 }",
            "the tab at x 20 y 90 mm is");
    REFUSED(cut + "tabs = { count = 4, wide = 5, height = 1 }", "the nearest known one is width");
}

TEST(Prismatic, ToolsThatDoNotSuitAreRefused)
{
    REFUSED("strategy = \"profile\"\nboundary = \"plate.dxf#outline\"\ndepth = 2\ntool = 2",
            "tool 2 is a drill");
    REFUSED("strategy = \"pocket\"\nboundary = \"plate.dxf#outline\"\ndepth = 2\ntool = 3",
            "tool 3 is vee: pocket needs vertical flanks");
    REFUSED("strategy = \"chamfer\"\nboundary = \"plate.dxf#outline\"\nwidth = 1\ntool = 1",
            "chamfer needs a vee or a taper, tool 1 is flat");
    REFUSED("strategy = \"chamfer\"\nboundary = \"plate.dxf#outline\"\nwidth = 4\ntool = 3",
            "is more than the flank of tool 3 cuts");
    const std::string vee =
        "[tool]\nshape = \"vee\"\ndiameter = 6\n[cutting]\nfeed = 1\n"
        "[[operation]]\nstrategy = \"chamfer\"\nboundary = \"plate.dxf#outline\"\nwidth = 1\n";
    STRCMP_CONTAINS(
        "tip_angle: is missing: a vee tool needs the angle",
        refusal([&] { read_job(folder.with("vee.toml", vee), cusp::strategies::all()); }).c_str());
}

TEST(Prismatic, KeysOfOtherOperationsAreRefused)
{
    REFUSED(
        "strategy = \"drill\"\nboundary = \"plate.dxf#holes\"\ntool = 2\ndepth = 4\n"
        "max_depth = 1",
        "max_depth: is no key of drill");
    REFUSED("strategy = \"pocket\"\nboundary = \"plate.dxf#outline\"\ndepth = 2\npeck = 1",
            "peck: is a key of drill, not of pocket");
    REFUSED("strategy = \"profile\"\nboundary = \"plate.dxf#outline\"", "depth: is missing");
}

TEST(Prismatic, AProfileOnTheLineHasNoLeads)
{
    const std::string profile =
        "strategy = \"profile\"\nboundary = \"plate.dxf#outline\"\n"
        "depth = 3\nside = \"on\"\n";
    STRCMP_CONTAINS("lead_in: belongs to a profile beside",
                    why_not(profile + "lead_in = 3").c_str());
    STRCMP_CONTAINS("lead_out: belongs to a profile beside",
                    why_not(profile + "lead_in = 0\nlead_out = 0.4").c_str());
    STRCMP_EQUAL("", broken(profile + "lead_in = 0\nlead_out = 0").c_str());
}

TEST(Prismatic, WhatFollowsAFaceBeginsWhereItEnds)
{
    const Job job = job_of(
        "strategy = \"face\"\ndepth = 0.5\n[[operation]]\nstrategy = \"profile\"\ndepth = 2\n"
        "boundary = \"plate.dxf#outline\"\n[[operation]]\nstrategy = \"pocket\"\ndepth = 2\n"
        "top = -1\nboundary = \"plate.dxf#window\"\n");
    DOUBLES_EQUAL(-0.5, job.operations[1].prismatic->top, 0);
    DOUBLES_EQUAL(-1.0, job.operations[2].prismatic->top, 0);
    DOUBLES_EQUAL(-3.0, job.operations[2].part.floor.front().points.front().z, 0);
}

TEST(Prismatic, AProfileOfNestedLoopsCutsTheHolesFromInside)
{
    const Job job = job_of("strategy = \"profile\"\ndepth = 2\nboundary = \"plate.dxf#window\"\n");
    const PlannedOperation planned = plan_profile(job, job.operations[0]).front();
    LONGS_EQUAL(2, planned.stats.passes);
    STRCMP_EQUAL(
        "", broken("strategy = \"profile\"\ndepth = 2\nboundary = \"plate.dxf#window\"\n").c_str());
}

TEST(Prismatic, TheVerifierFindsGoodProgramsGood)
{
    STRCMP_EQUAL("", broken("strategy = \"face\"\ndepth = 0.5\n").c_str());
    STRCMP_EQUAL("", broken("strategy = \"drill\"\nboundary = \"plate.dxf#holes\"\ndepth = 4\n"
                            "tool = 2\npeck = 1")
                         .c_str());
    STRCMP_EQUAL("", broken("strategy = \"engrave\"\nboundary = \"plate.dxf#ring\"\ndepth = 0.5\n"
                            "tool = 3")
                         .c_str());
    STRCMP_EQUAL("", broken("strategy = \"chamfer\"\nboundary = \"plate.dxf#outline\"\nwidth = 1\n"
                            "tool = 3")
                         .c_str());
    STRCMP_EQUAL("", broken("strategy = \"profile\"\nboundary = \"plate.dxf#outline\"\ndepth = 3\n"
                            "max_depth = 1\nallowance = 0.2\n"
                            "tabs = { count = 3, width = 4, height = 1 }")
                         .c_str());
    STRCMP_EQUAL("",
                 broken("strategy = \"profile\"\nboundary = \"plate.dxf#outline\"\ndepth = 3\n"
                        "side = \"on\"\n"
                        "tabs = { places = [20, 0], width = 4, height = 1, shape = \"square\" }")
                     .c_str());
}

TEST(Prismatic, TheVerifierFindsWhatIsSpoiled)
{
    const std::string profile =
        "strategy = \"profile\"\nboundary = \"plate.dxf#outline\"\ndepth = 3\n"
        "tabs = { count = 3, width = 4, height = 1, shape = \"square\" }\n";
    // a tab cut through
    STRCMP_CONTAINS(
        "tabs: 2 found, 3 expected: one of operation 1 (profile) is cut away by tool 1 at x ",
        broken(profile, "Z-2\n", "Z-3\n").c_str());
    // a side beside its place: into the part, and away from it
    STRCMP_CONTAINS("wall_gouge_max_mm", broken(profile, "Y-1.5", "Y-1.4").c_str());
    // a level too high, a level too deep
    const std::string face = "strategy = \"face\"\ndepth = 0.5\n";
    STRCMP_CONTAINS("over the level of operation 1 (face)", broken(face, "Z-0.5", "Z-0.4").c_str());
    STRCMP_CONTAINS("gouge_max_mm", broken(face, "Z-0.5", "Z-0.6").c_str());
    // a hole elsewhere
    const std::string holes =
        "strategy = \"drill\"\nboundary = \"plate.dxf#holes\"\ndepth = 4\ntool = 2";
    STRCMP_CONTAINS("wall_gouge_max_mm", broken(holes, "X5 ", "X5.1 ").c_str());
    STRCMP_CONTAINS("left ", broken(holes, "Z-4\n", "Z-3\n").c_str());
    // an edge that is passed in the air; nothing else comes near it
    for (const char* width : {"0.4", "1.3"}) {
        const std::string edge =
            "strategy = \"chamfer\"\nboundary = \"plate.dxf#outline\"\n"
            "tool = 3\nwidth = " +
            std::string{width};
        const std::string found = broken(edge, "G1 Z-", "G1 Z");
        STRCMP_CONTAINS(("wall_stock_max_mm " + std::string{width} + " at x").c_str(),
                        found.c_str());
    }
}

TEST(Prismatic, ACarvingIsAsDeepAsHalfOfItsWidthAllows)
{
    const auto figures = [&](const std::string& keys) {
        const Job job = job_of("strategy = \"v_carve\"\ntool = 3\n" + keys);
        return plan_v_carve(job, job.operations[0]).front().stats;
    };
    const auto count = [](const OperationStats& stats, const std::string& name) {
        for (const auto& [key, value] : stats.counts) {
            if (key == name) {
                return value;
            }
        }
        return -1.0;
    };
    // 40 x 30 with a window of 20 x 14: 8 mm wide at most beside the window; the flank is 3 mm high
    const OperationStats narrow = figures("boundary = \"plate.dxf#window\"\ndepth = 2\n");
    DOUBLES_EQUAL(2, count(narrow, "depth_mm"), 1e-9);
    CHECK(count(narrow, "floor_loops") > 0);
    CHECK(narrow.warnings.empty());
    const OperationStats wide = figures("boundary = \"plate.dxf#window\"\n");
    LONGS_EQUAL(1, wide.warnings.size());
    STRCMP_CONTAINS("tool 3 is too narrow for the whole width at x", wide.warnings[0].c_str());
    const OperationStats cone = figures("boundary = \"plate.dxf#ring\"\n");
    DOUBLES_EQUAL(2, count(cone, "depth_mm"), 1e-6);
    LONGS_EQUAL(1, count(cone, "branches"));
    LONGS_EQUAL(0, count(cone, "floor_loops"));
}

TEST(Prismatic, CarvingsThatCanNotBeAreRefused)
{
    const std::string cut = "strategy = \"v_carve\"\nboundary = \"plate.dxf#ring\"\n";
    REFUSED(cut + "tool = 1", "v_carve needs a vee or a taper, tool 1 is flat");
    REFUSED(cut + "tool = 3\ndepth = 4", "depth: is 4 mm, the flank of tool 3 is only 3 mm high");
    REFUSED(cut + "tool = 3\nallowance = 1", "allowance: is no key of v_carve");
    REFUSED("strategy = \"v_carve\"\ntool = 3", "boundary: is missing");
    const std::string wide_tip =
        "[tool]\nshape = \"vee\"\ndiameter = 9\ntip_angle = 60\ntip_diameter = 5\n[cutting]\n"
        "feed = 1\n[[operation]]\n" +
        cut;
    STRCMP_CONTAINS(
        "the tip of tool 1, 5 mm wide, fits nowhere between the outlines: the widest "
        "place, at x 20 y 15 mm, has 4 mm",
        refusal([&] {
            plan(read_job(folder.with("wide.toml", wide_tip), cusp::strategies::all()));
        }).c_str());
}

TEST(Prismatic, TheVerifierJudgesCarvings)
{
    const std::string cone = "strategy = \"v_carve\"\nboundary = \"plate.dxf#ring\"\ntool = 3\n";
    STRCMP_EQUAL("", broken(cone).c_str());
    STRCMP_EQUAL("", broken(cone + "depth = 1\nscallop = 0.3\n").c_str());
    STRCMP_EQUAL("", broken(cone + "depth = 1\nmax_depth = 0.6\noutput = \"arcs\"\n").c_str());
    STRCMP_CONTAINS("gouge_max", broken(cone, "Z-2 F", "Z-2.1 F").c_str());
    STRCMP_CONTAINS("of operation 1 (v_carve)", broken(cone, "Z-2 F", "Z-1.9 F").c_str());
    STRCMP_CONTAINS("gouge_max", broken(cone, "X20 Y15", "X20.1 Y15").c_str());
}

// 2 x 10 degrees and a flat end of 1 mm: at 4 mm it is 2.41 mm wide.
TEST(Prismatic, ATaperIsConicalAboveItsFlatEnd)
{
    const std::string taper = "[tool]\nshape = \"taper\"\ndiameter = 6\ntaper_angle = 10\n";
    const std::string cut =
        "[cutting]\nfeed = 100\n[[operation]]\nstrategy = \"engrave\"\n"
        "boundary = \"plate.dxf#ring\"\ndepth = 1\n";
    const Job job = read_job(folder.with("taper.toml", taper + "tip_diameter = 1\n" + cut),
                             cusp::strategies::all());
    const Tool& tool = job.operations[0].tool;
    DOUBLES_EQUAL(0, profile_height(tool, 0.5), 1e-12);
    DOUBLES_EQUAL(4, profile_height(tool, 0.5 + 4 * std::tan(10 * 3.14159265358979 / 180)), 1e-9);
    CHECK(std::isinf(profile_height(tool, 3.1)));
    CHECK(verify::verify(job, program_of(job), {}, [](double) {}).broken.empty());
    STRCMP_CONTAINS("tip_diameter: is missing: a taper needs the diameter of its flat end",
                    refusal([&] {
                        read_job(folder.with("taper.toml", taper + cut), cusp::strategies::all());
                    }).c_str());
    const std::string flat = "[tool]\nshape = \"flat\"\ndiameter = 6\ntaper_angle = 10\n" + cut;
    STRCMP_CONTAINS("taper_angle: belongs to a taper, this one is flat",
                    refusal([&] {
                        read_job(folder.with("taper.toml", flat), cusp::strategies::all());
                    }).c_str());
}

TEST(Prismatic, HolesOfADrawingNeedADepth)
{
    REFUSED(
        "strategy = \"drill\"\nboundary = \"plate.dxf#holes\"\ntool = 2",
        "depth: is missing: drill needs how deep it cuts where the holes are those of a drawing");
}

// Cycles are used if the post has them; every post drills the same holes.
TEST(Prismatic, HolesAreCyclesOfThePostsThatHaveThem)
{
    const auto written = [&](const std::string& keys, const std::string& post) {
        Job job = read_job(
            folder.with("job.toml",
                        "post = \"" + post + "\"\n" + kHead +
                            "strategy = \"drill\"\nboundary = \"plate.dxf#holes\"\ndepth = 4\n"
                            "tool = 2\ndiameter = 3\n" +
                            keys),
            cusp::strategies::all());
        std::ofstream out{folder.file("holes.ngc")};
        write_program(out, {"test", false, job.stock_top + job.clearance, {}, job.post}, plan(job));
        out.close();
        CHECK(verify::verify(job, folder.file("holes.ngc"), {}, [](double) {}).broken.empty());
        return folder.text_of("holes.ngc");
    };
    STRCMP_CONTAINS("G0 X5 Y5\nG98 G81 X5 Y5 Z-4 R1 F250\nX35 Y5\nG80\n",
                    written("", "linuxcnc").c_str());
    STRCMP_CONTAINS("G98 G83 X5 Y5 Z-4 R1 Q1.5 F250\nX35 Y5\nG80\n",
                    written("peck = 1.5\n", "grblhal").c_str());
    STRCMP_CONTAINS("G98 G83 X5. Y5. Z-4. R1. Q1.5 F250.\nN70 X35. Y5.\nN80 G80\n",
                    written("peck = 1.5\n", "fanuc").c_str());
    CHECK(written("peck = 1.5\n", "grbl").find("G83") == std::string::npos);
    CHECK(written("", "cusp").find("G81") == std::string::npos);
}
