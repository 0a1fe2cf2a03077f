// Results of inspect_part for whole files, read as `cusp info` reads them.
#include "host_tools/job/part_info/part_info.hpp"

#include "CppUTest/TestHarness.h"

#include "host_tools/job/import/part_geometry_reader.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::part_info;
using namespace cusp::test;
using cusp::test::refusal;
using cusp::test::TemporaryFolder;

namespace {

std::string line(const char* layer, double x0, double y0, double x1, double y1)
{
    return fmt::format("0\nLINE\n8\n{}\n10\n{}\n20\n{}\n11\n{}\n21\n{}\n", layer, x0, y0, x1, y1);
}

std::string drawing(const std::string& entities, const std::string& header = "")
{
    return header + "0\nSECTION\n2\nENTITIES\n" + entities + "0\nENDSEC\n0\nEOF\n";
}

std::string circle(const char* layer, double x, double y, double radius)
{
    return fmt::format("0\nCIRCLE\n8\n{}\n10\n{}\n20\n{}\n40\n{}\n", layer, x, y, radius);
}

const char* const kInches = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n1\n0\nENDSEC\n";

PartInfo inspected(const std::string& name, double millimetres)
{
    return inspect_part(import::read_part_geometry(name, millimetres), 0.01);
}

}  // namespace

TEST_GROUP(PartInfo)
{
    TemporaryFolder folder;
    double millimetres{1};

    PartInfo of(const std::string& name, const std::string& text)
    {
        return inspected(folder.with(name, text), millimetres);
    }
};

TEST(PartInfo, LayersAreListedEachWithItsLoops)
{
    const PartInfo info =
        of("plate.dxf", drawing(circle("holes", 5, 5, 1) + circle("holes", 9, 5, 1) +
                                line("marks", 0, 0, 4, 3) + "0\n3DFACE\n8\nsolid\n10\n0\n"));
    UNSIGNED_LONGS_EQUAL(2, info.part.layers.size());
    STRCMP_EQUAL("holes", info.part.layers[0].name.c_str());
    UNSIGNED_LONGS_EQUAL(2, info.part.layers[0].loops.loops.size());
    STRCMP_EQUAL("marks", info.part.layers[1].name.c_str());
    DOUBLES_EQUAL(5, info.part.layers[1].loops.open[0].gap, 1e-12);
    UNSIGNED_LONGS_EQUAL(1, info.part.notes.size());
    STRCMP_CONTAINS("#solid: left out, since they draw no curve: 1 3DFACE",
                    info.part.notes[0].c_str());
    CHECK(info.part.unit.assumed);
    DOUBLES_EQUAL(10, info.part.box_high.x, 1e-2);
}

TEST(PartInfo, ADrawingInInchesIsMeasuredInMillimetres)
{
    const PartInfo info = of("plate.dxf", drawing(circle("0", 0, 0, 1), kInches));
    STRCMP_EQUAL("inch", info.part.unit.name.c_str());
    CHECK(!info.part.unit.assumed);
    DOUBLES_EQUAL(2 * 25.4, info.part.box_high.x - info.part.box_low.x, 1e-2);
    STRCMP_CONTAINS("2 x 2 x 0 inch", text_of(info).c_str());
}

TEST(PartInfo, OneLayerCanBeAskedFor)
{
    const std::string file =
        folder.with("plate.dxf", drawing(circle("a", 0, 0, 1) + circle("b", 9, 0, 2)));
    const PartInfo info = inspected(file + "#b", millimetres);
    UNSIGNED_LONGS_EQUAL(1, info.part.layers.size());
    DOUBLES_EQUAL(7, info.part.box_low.x, 1e-2);
    STRCMP_CONTAINS("no curve on the layer \"c\"; layers with curves: \"a\", \"b\"",
                    refusal([&] { inspected(file + "#c", millimetres); }).c_str());
}

TEST(PartInfo, ARoofOverAPlateIsAnUndercut)
{
    Triangles part = box_mesh({0, 0, 0}, {100, 100, 10});
    const Triangles roof = box_mesh({20, 20, 30}, {60, 70, 35});
    part.insert(part.end(), roof.begin(), roof.end());
    const PartInfo info = of("roof.stl", ascii_stl(part));
    // the area under the roof and the roof's underside; the plate's underside does not count
    const double hidden = 2.0 * 40 * 50;
    DOUBLES_EQUAL(1, info.ground->hidden_area / hidden, 0.01);
    UNSIGNED_LONGS_EQUAL(2, info.mesh->shells);
    DOUBLES_EQUAL(1, info.ground->level_area / (100 * 100.0), 0.01);
    DOUBLES_EQUAL(35, info.ground->level_at->z, 1e-9);
}

TEST(PartInfo, InchesAreForFilesThatNameNoUnit)
{
    millimetres = 25.4;
    const PartInfo info = of("box.stl", ascii_stl(box_mesh({0, 0, 0}, {1, 2, 3})));
    DOUBLES_EQUAL(3 * 25.4, info.part.box_high.z, 1e-9);
    STRCMP_CONTAINS("inch, assumed", text_of(info).c_str());
}

TEST(PartInfo, JsonHasStableKeys)
{
    const std::string json = json_of({of("box.stl", ascii_stl(box_mesh({0, 0, 0}, {1, 2, 3})))});
    for (const char* key :
         {"\"files\"", "\"format\"", "\"unit\"", "\"box_low_mm\"", "\"size_mm\"", "\"facets\"",
          "\"holes\"", "\"open_edges\"", "\"non_manifold_edges\"", "\"degenerate_facets\"",
          "\"inverted_facets\"", "\"shells\"", "\"steepest_degrees\"", "\"undercut_share\"",
          "\"level_share\"", "\"any_ball\"", "\"sharp_corner\"", "\"ball_leaves_mm\""}) {
        STRCMP_CONTAINS(key, json.c_str());
    }
}

TEST(PartInfo, WhatIsNoPartIsRefused)
{
    STRCMP_CONTAINS("not from \".ply\"", refusal([&] { of("a.ply", "ply"); }).c_str());
    STRCMP_CONTAINS("can't be read",
                    refusal([&] { inspected(folder.file("gone.stl"), millimetres); }).c_str());
    STRCMP_CONTAINS("no STL", refusal([&] { of("a.stl", ""); }).c_str());
    STRCMP_CONTAINS("a.json: not JSON: parse error at line 1",
                    refusal([&] { of("a.json", "{"); }).c_str());
    STRCMP_CONTAINS("holds no curve", refusal([&] { of("a.dxf", drawing("")); }).c_str());
}
