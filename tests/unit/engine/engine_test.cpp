#include "host_tools/cam/engine/engine.hpp"

#include <algorithm>

#include "CppUTest/TestHarness.h"

#include "host_tools/base/files/files.hpp"
#include "host_tools/cam/plan/plan.hpp"
#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/controller/simulate/simulate.hpp"
#include "host_tools/job/import/import.hpp"

#include "nlohmann/json.hpp"

using namespace cusp;
using Json = nlohmann::json;

namespace {

const std::string kExamples = CUSP_SOURCE_DIR "/examples/";

class CountingListener : public engine::Listener {
public:
    explicit CountingListener(int most) : most_{most} {}
    void progress(double share, const std::string& text) override
    {
        CHECK(share >= 0 && share <= 1 && !text.empty());
        ++reports;
    }
    bool cancelled() override { return reports >= most_; }
    int reports{0};

private:
    int most_;
};

struct Given {
    Json json;
    std::vector<engine::Block> blocks;

    const std::string& block(const std::string& name) const
    {
        const auto found = std::find_if(blocks.begin(), blocks.end(),
                                        [&](const engine::Block& b) { return b.name == name; });
        CHECK(found != blocks.end());
        return found->bytes;
    }
    const Json& result() const
    {
        if (!json["ok"].get<bool>()) {
            FAIL(json.dump().c_str());
        }
        return json["result"];
    }
    const Json& error() const
    {
        CHECK_FALSE(json["ok"].get<bool>());
        CHECK(blocks.empty());
        return json["error"];
    }
};

Given called(const std::string& name, const Json& arguments, const files::FileSet& set)
{
    engine::Listener nobody;
    engine::Answer answer = engine::call(name, arguments.dump(), set, nobody);
    return {Json::parse(answer.json), std::move(answer.blocks)};
}

const char* const kTool = "[[tool]]\nnumber = 1\nshape = \"flat\"\ndiameter = 6.0\n";
const char* const kRest =
    "[cutting]\nfeed = 1200.0\nplunge_feed = 300.0\nspindle = 16000.0\n"
    "[stock]\ntop = 0.0\nbottom = -4.0\nx = [-10.0, 50.0]\ny = [-10.0, 40.0]\n"
    "[[operation]]\nstrategy = \"profile\"\ntool = 1\nboundary = \"square.dxf\"\ndepth = 2.0\n";

std::string small_job() { return std::string{"units = \"mm\"\n"} + kTool + kRest; }

// A square of lines, 40 x 30 mm.
std::string square()
{
    std::string text = "0\nSECTION\n2\nENTITIES\n";
    const int corners[][2] = {{0, 0}, {40, 0}, {40, 30}, {0, 30}, {0, 0}};
    for (int k = 0; k < 4; ++k) {
        text += "0\nLINE\n8\n0\n10\n" + std::to_string(corners[k][0]) + "\n20\n" +
                std::to_string(corners[k][1]) + "\n11\n" + std::to_string(corners[k + 1][0]) +
                "\n21\n" + std::to_string(corners[k + 1][1]) + "\n";
    }
    return text + "0\nENDSEC\n0\nEOF\n";
}

// A pyramid, 20 mm wide and 5 mm high.
std::string pyramid()
{
    return "solid p\n"
           "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 20 0 0\nvertex 10 10 "
           "5\nendloop\nendfacet\n"
           "facet normal 0 0 1\nouter loop\nvertex 20 0 0\nvertex 20 20 0\nvertex 10 10 "
           "5\nendloop\nendfacet\n"
           "facet normal 0 0 1\nouter loop\nvertex 20 20 0\nvertex 0 20 0\nvertex 10 10 "
           "5\nendloop\nendfacet\n"
           "facet normal 0 0 1\nouter loop\nvertex 0 20 0\nvertex 0 0 0\nvertex 10 10 "
           "5\nendloop\nendfacet\n"
           "endsolid p\n";
}

files::FileSet plate_files()
{
    files::FileSet set;
    for (const char* name : {"two_sides.dxf", "plate.dxf"}) {
        set[name] = files::text_of_file(kExamples + "plate/" + name);
    }
    return set;
}

}  // namespace

TEST_GROUP(Engine){};

TEST(Engine, KeysHaveEveryStrategyAndASchema)
{
    const Given given = called("keys", {}, {});
    const Json& result = given.result();
    CHECK_EQUAL(strategies::all().size(), result["strategies"].size());
    CHECK(result["schema"]["definitions"].contains("operation"));
    CHECK(result["strategies"][0]["keys"].size() > 10);
    CHECK(std::find(result["posts"].begin(), result["posts"].end(), "grbl") !=
          result["posts"].end());
}

TEST(Engine, PlansTheBytesOfTheProgramsOfBothSetups)
{
    const std::string file = kExamples + "plate/two_sides.toml";
    std::vector<job::Job> setups = import::read_setups(file, strategies::all());
    std::vector<std::string> programs;
    plan::Watcher nobody;
    plan::plan_setups(
        setups, nobody,
        [&](const job::Job& job) {
            plan::PlanOptions options;
            options.title = "job two_sides.toml, " + description_of(*job.setup);
            options.name = file_of_setup("part.ngc", *job.setup);
            return options;
        },
        [&](const job::Job&, const plan::PlannedProgram& program) {
            programs.push_back(program.gcode);
        });

    files::FileSet set = plate_files();
    const std::string job = files::text_of_file(file);
    const Given given = called("plan", {{"job", job}, {"name", "two_sides.toml"}}, set);
    const Json& planned = given.result()["programs"];
    CHECK_EQUAL(2U, planned.size());
    for (std::size_t k = 0; k < programs.size(); ++k) {
        CHECK(given.block(planned[k]["block"]) == programs[k]);
        CHECK(planned[k]["stats"].contains("operations"));
        set[planned[k]["name"]] = programs[k];
    }
    // the second one after the first, from memory
    const Json after{{"job", job},
                     {"program", planned[1]["name"]},
                     {"after", {planned[0]["name"]}},
                     {"engagement", false},
                     {"maps", true}};
    const Given verified = called("verify", after, set);
    CHECK(verified.result()["holds"].get<bool>());
    const Json& map = verified.result()["map"];
    CHECK_EQUAL(map["columns"].get<std::size_t>() * map["rows"].get<std::size_t>() * 4,
                verified.block("left").size());
}

TEST(Engine, ARunHasTheEdgesOfTheSimulation)
{
    const std::string gcode = "G21 G90\nG1 X10 Y5 F600\nG2 X20 Y5 I5 J0\nM2\n";
    dialect::LineSource source = dialect::LineSource::of_text("part.ngc", gcode);
    const auto direct = simulate::simulate(source, {});
    const files::FileSet set{{"part.ngc", gcode}};
    const Given run = called("run", {{"program", "part.ngc"}, {"page", false}}, set);
    CHECK(run.result()["good"].get<bool>());
    CHECK(run.result()["stats"] == Json::parse(simulate::statistics_json(direct)) ||
          run.result()["stats"]["edges_crc32"] ==
              Json::parse(simulate::statistics_json(direct))["edges_crc32"]);
    const Given page = called("run", {{"program", "part.ngc"}}, set);
    CHECK(page.result()["ticks"].get<int>() > 1000);
    CHECK(page.block("data-samples").size() > 100);
    CHECK(page.result()["facts"]["program"] == "part.ngc");
}

TEST(Engine, ARefusedLineIsAFaultOfTheRun)
{
    const Given run =
        called("run", {{"program", "a.ngc"}, {"page", false}}, {{"a.ngc", "G0 X1\nG77 X2\n"}});
    CHECK_FALSE(run.result()["good"].get<bool>());
    CHECK_EQUAL(2, run.result()["faults"][0]["line"].get<int>());
}

TEST(Engine, SuggestsAJobThatItChecksAndPlans)
{
    const files::FileSet set{{"p.stl", pyramid()}};
    const Given suggested =
        called("suggest", {{"parts", {"p.stl"}}, {"tools", {"ball:6"}}, {"scallop", 0.1}}, set);
    CHECK(!suggested.result()["said"].empty());
    const std::string job = suggested.result()["job"];
    const Given checked = called("check", {{"job", job}, {"facets", true}}, set);
    CHECK(checked.result()["faults"].empty());
    const Json& facets = checked.result()["setups"][0]["facets"];
    CHECK_EQUAL(facets["triangles"].get<std::size_t>() * 36, checked.block(facets["block"]).size());
    CHECK(facets["triangles"].get<int>() > 0);
}

TEST(Engine, SuggestsTheOperationsOfADrawing)
{
    const std::string drawing =
        "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\n0\n10\n0\n20\n0\n40\n30\n"
        "0\nCIRCLE\n8\n0\n10\n5\n20\n0\n40\n8\n0\nENDSEC\n0\nEOF\n";
    const files::FileSet set{{"d.dxf", drawing}};
    const Given suggested = called(
        "suggest", {{"parts", {"d.dxf"}}, {"tools", {"flat:3"}}, {"depth", 6}, {"tabs", "3"}}, set);
    STRCMP_EQUAL(
        "d.dxf: 1 outline: profile outside, flat 3 mm, 6 mm deep in cuts of at most 1.5, 3 "
        "tabs of 3 x 1.5 on each",
        suggested.result()["said"].back().get<std::string>().c_str());
    const Given checked = called("check", {{"job", suggested.result()["job"]}}, set);
    CHECK(checked.result()["faults"].empty());
}

TEST(Engine, DescribesAMeshAndGivesItsTriangles)
{
    const Given given = called("describe", {{"files", {"p.stl"}}}, {{"p.stl", pyramid()}});
    CHECK_EQUAL(1U, given.result()["files"].size());
    CHECK_EQUAL(4, given.result()["facets"][0]["triangles"].get<int>());
    CHECK_EQUAL(4U * 36, given.block("facets-0").size());
}

#ifdef CUSP_TESTS_CAD
TEST(Engine, ReadsStepFromMemory)
{
    const std::string step = files::text_of_file(kExamples + "tutorial/tray.step");
    const Given given = called("describe", {{"files", {"tray.step"}}}, {{"tray.step", step}});
    CHECK(given.result()["facets"][0]["triangles"].get<int>() > 100);
    const Given broken = called("describe", {{"files", {"b.step"}}}, {{"b.step", "no STEP"}});
    CHECK(broken.error()["text"].get<std::string>().rfind("b.step: ", 0) == 0);
}
#endif

TEST(Engine, AFaultNamesTableKeyValueAndLimit)
{
    std::string job = small_job();
    job.replace(job.find("diameter = 6.0"), 14, "diameter = -6.");
    const Given given = called("check", {{"job", job + "0\n"}}, {{"square.dxf", square()}});
    CHECK_EQUAL(1U, given.result()["faults"].size());
    job = small_job();
    job.replace(job.find("depth = 2.0"), 11, "depth = -2.0");
    const Given depth = called("plan", {{"job", job}}, {{"square.dxf", square()}});
    const Json& error = depth.error();
    CHECK(error["kind"] == "input");
    CHECK(error["key"] == "depth");
    CHECK(error["value"] == "-2.0");
    CHECK(error["place"].get<std::string>().rfind("operation 1", 0) == 0);
    CHECK(error["limit"].get<std::string>().find("above 0") != std::string::npos);
    CHECK(error["line"].get<int>() > 10);
}

TEST(Engine, AJobReadsNothingOfTheDisk)
{
    std::string job = small_job();
    const std::string outside = kExamples + "plate/plate.dxf";
    job.replace(job.find("square.dxf"), 10, outside);
    const Given given = called("plan", {{"job", job}}, {});
    CHECK(given.error()["kind"] == "input");
    CHECK(given.error()["text"].get<std::string>().find("not among the files") !=
          std::string::npos);
}

TEST(Engine, AListenerEndsACall)
{
    CountingListener listener{2};
    const Json arguments{{"job", small_job()}};
    const engine::Answer answer =
        engine::call("plan", arguments.dump(), {{"square.dxf", square()}}, listener);
    CHECK(Json::parse(answer.json)["error"]["kind"] == "cancelled");
    CHECK_EQUAL(2, listener.reports);
}

TEST(Engine, ArgumentsThatAreNoneAreRefused)
{
    CHECK(called("bore", {}, {}).error()["text"].get<std::string>().find("no such call") !=
          std::string::npos);
    CHECK(called("plan", {{"job", 3}}, {}).error()["key"] == "job");
    CHECK(called("fit", {{"program", "a"}, {"tolerence", 1}, {"tolerance", 1}}, {{"a", ""}})
              .error()["key"] == "tolerence");
    engine::Listener nobody;
    const engine::Answer answer = engine::call("keys", "[1]", {}, nobody);
    CHECK(Json::parse(answer.json)["error"]["kind"] == "input");
}

TEST(Engine, FitsAProgramInMemory)
{
    std::string gcode = "G21 G90 F600\nG0 X0 Y0\n";
    for (int k = 1; k <= 50; ++k) {
        gcode += "G1 X" + std::to_string(k * 0.1) + " Y0\n";
    }
    const Given given =
        called("fit", {{"program", "a.ngc"}, {"tolerance", 0.01}}, {{"a.ngc", gcode + "M2\n"}});
    CHECK(given.result()["stats"]["moves_out"].get<int>() < 5);
    CHECK(given.block("gcode").size() < gcode.size());
}

TEST(Engine, GivesTheLinesThatAControllerIsSent)
{
    const files::FileSet set{
        {"a.ngc", "%\n(first) G21 G90\n\nG0 X1 Z5 ; up\nG1 Z-1 F100\nG1 X9\nM30\nG0 X0\n"}};
    const Given numbered = called("send", {{"program", "a.ngc"}}, set);
    CHECK_EQUAL(5, numbered.result()["lines"].get<int>());
    CHECK_EQUAL(std::string{"2\tN2G21G90\n4\tN4G0X1Z5\n5\tN5G1Z-1F100\n6\tN6G1X9\n7\tN7M30\n"},
                numbered.block("lines"));
    const Given bare = called("send", {{"program", "a.ngc"}, {"numbers", false}}, set);
    CHECK_EQUAL(std::string{"2\tG21G90\n4\tG0X1Z5\n5\tG1Z-1F100\n6\tG1X9\n7\tM30\n"},
                bare.block("lines"));
    CHECK(called("send", {{"program", "b.ngc"}}, {{"b.ngc", "G1 X1\nG1 X2 ~\n"}})
              .error()["text"]
              .get<std::string>()
              .find("b.ngc:2: error:1: ") == 0);
}

TEST(Engine, LeadsToTheLineAtWhichAProgramIsResumed)
{
    const files::FileSet set{
        {"a.ngc", "G21 G90 F300\nG0 Z5\nG0 X1\nG1 Z-1 F100\nG1 X9\nG1 X1\nM30\n"}};
    const Json listing = {"[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]", "[G54:-10.000,0.000,0.000]",
                          "$11=0.010"};
    const Given given = called("send",
                               {{"program", "a.ngc"},
                                {"numbers", false},
                                {"line", 6},
                                {"start", listing},
                                {"start_place", {-10, 0, 0}},
                                {"now", listing},
                                {"place", {-4, 0, 2}}},
                               set);
    const Json& way = given.result()["way"];
    CHECK_EQUAL(5, way["line"].get<int>());
    CHECK(way["point"] == Json({1.0, 0.0, -1.0}));
    CHECK_EQUAL(5.0, way["travel_z"].get<double>());
    CHECK_EQUAL(100.0, way["plunge_feed"].get<double>());
    const std::string& lines = given.block("lines");
    CHECK(lines.find("0\tG0Z5.000000\n0\tG0X1.000000Y0.000000\n") != std::string::npos);
    CHECK(lines.find("\n5\tG1X9\n6\tG1X1\n7\tM30\n") != std::string::npos);
    CHECK(called("send", {{"program", "a.ngc"}, {"line", 99}}, set)
              .error()["text"]
              .get<std::string>()
              .find("has no line 99") != std::string::npos);
    CHECK_FALSE(called("send", {{"program", "a.ngc"}, {"line", 0}}, set).json["ok"].get<bool>());
}
