// Entities that are no contours are left out and counted; drawings in other planes; drawings far
// from the origin.
#include "host_tools/job/import/dxf_expansion.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "host_tools/job/import/dxf_holes.hpp"
#include "host_tools/job/import/dxf_plane.hpp"
#include "host_tools/job/import/file_loops.hpp"
#include "host_tools/job/job/loop_shape.hpp"
#include "tests/support/drawn_dxf.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::test;

namespace {

// Groups that most kinds have in common: places, a text, a reference.
std::string other_entity(const std::string& kind)
{
    return "0\n" + kind + "\n8\no\n10\n1\n20\n2\n30\n0\n11\n3\n21\n4\n1\nx\n2\nname\n";
}

const std::vector<std::string> kNoContours{
    "SOLID",       "TRACE",         "XLINE",       "RAY",       "WIPEOUT",    "REGION",
    "MLINE",       "3DFACE",        "MULTILEADER", "DIMENSION", "LEADER",     "TOLERANCE",
    "IMAGE",       "OLE2FRAME",     "3DSOLID",     "BODY",      "ACAD_TABLE", "HATCH",
    "SHAPE",       "MESH",          "SURFACE",     "UNDERLAY",  "LIGHT",      "ACAD_PROXY_ENTITY",
    "PDFUNDERLAY", "ARC_DIMENSION", "SECTION_",    "CAMERA",    "RTEXT"};

double area_of_loops(const std::vector<FileLoop>& loops)
{
    double sum = 0;
    for (const FileLoop& loop : loops) {
        sum += job::signed_area(job::loop_polyline(loop.loop, 1e-5));
    }
    return sum;
}

}  // namespace

TEST_GROUP(DxfExpansion)
{
    TemporaryFolder folder;
    std::vector<std::string> notes;

    std::vector<FileLoop> loops_of(const std::string& text)
    {
        notes.clear();
        return read_loops(folder.with("d.dxf", text), 1, {0.02, {}}, notes);
    }
};

TEST(DxfExpansion, WhatDrawsNoCurveIsLeftOutAndCounted)
{
    std::string all = dxf_rectangle({0, 0}, {30, 20});
    for (const std::string& kind : kNoContours) {
        DOUBLES_EQUAL(600,
                      area_of_loops(loops_of(
                          dxf_drawing(dxf_rectangle({0, 0}, {30, 20}) + other_entity(kind)))),
                      1e-9);
        UNSIGNED_LONGS_EQUAL(1, notes.size());
        STRCMP_CONTAINS(("d.dxf: left out, since they draw no curve: 1 " + kind).c_str(),
                        notes[0].c_str());
        all += other_entity(kind);
    }
    loops_of(dxf_drawing(all + other_entity("SOLID") + other_entity("POINT")));
    STRCMP_CONTAINS("2 SOLID", notes[0].c_str());
    STRCMP_CONTAINS("1 POINT", notes[0].c_str());
    STRCMP_CONTAINS("1 3DFACE", notes[0].c_str());
    // what fills in blocks, ends lists and shows the paper is not said
    loops_of(dxf_drawing(dxf_rectangle({0, 0}, {30, 20}) + other_entity("ATTDEF") +
                         other_entity("VIEWPORT") + "0\nSEQEND\n8\no\n"));
    CHECK(notes.empty());
}

TEST(DxfExpansion, BlocksWithOtherEntitiesAreDrawnWithoutThem)
{
    const std::string block = "0\nBLOCK\n2\nplate\n10\n0\n20\n0\n" + dxf_rectangle({0, 0}, {3, 2}) +
                              other_entity("SOLID") + other_entity("3DFACE") + "0\nENDBLK\n";
    const auto loops = loops_of(dxf_drawing(
        "0\nINSERT\n8\no\n2\nplate\n10\n0\n20\n0\n0\nINSERT\n8\no\n2\nplate\n10\n9\n20\n0\n"
        "41\n2\n",
        {}, block));
    DOUBLES_EQUAL(6 + 12, area_of_loops(loops), 1e-9);
    STRCMP_CONTAINS("left out, since they draw no curve: 2 3DFACE, 2 SOLID", notes[0].c_str());
}

TEST(DxfExpansion, ALayerOfOtherEntitiesAloneNamesThem)
{
    const std::string file =
        folder.with("d.dxf", dxf_drawing(other_entity("SOLID") + other_entity("XLINE")));
    STRCMP_CONTAINS("no curve on the layer \"o\"; it holds SOLID, XLINE",
                    refusal([&] { read_loops(file + "#o", 1, {}, notes); }).c_str());
}

TEST(DxfExpansion, AMeshOfPolylinesIsLeftOut)
{
    const std::string mesh =
        "0\nPOLYLINE\n8\no\n70\n64\n0\nVERTEX\n8\no\n70\n192\n10\n0\n20\n0\n0\nSEQEND\n";
    DOUBLES_EQUAL(6, area_of_loops(loops_of(dxf_drawing(mesh + dxf_rectangle({0, 0}, {3, 2})))),
                  1e-9);
    STRCMP_CONTAINS("1 POLYLINE (mesh)", notes[0].c_str());
}

TEST(DxfExpansion, ADrawingInXAndZIsTakenAsSeenFromTheFront)
{
    // a slot whose polyline is extruded along -y, 7 behind the origin, and a line that closes half of it
    const std::string front =
        "0\nLWPOLYLINE\n8\no\n90\n4\n70\n1\n38\n7\n210\n0\n220\n-1\n230\n0\n10\n0\n20\n-"
        "2\n10\n10\n20\n"
        "-2\n42\n1\n10\n10\n20\n2\n10\n0\n20\n2\n42\n1\n";
    const auto loops = loops_of(dxf_drawing(front));
    DOUBLES_EQUAL(40 + 4 * kPi, area_of_loops(loops), 1e-3);
    STRCMP_CONTAINS("d.dxf: drawn in x and z: z is taken for y", notes[0].c_str());
    // lines in x and z
    const auto line = [](double x0, double z0, double x1, double z1) {
        return fmt::format("0\nLINE\n8\no\n10\n{}\n20\n5\n30\n{}\n11\n{}\n21\n5\n31\n{}\n", x0, z0,
                           x1, z1);
    };
    const auto triangle =
        loops_of(dxf_drawing(line(0, 0, 4, 0) + line(4, 0, 0, 3) + line(0, 3, 0, 0)));
    DOUBLES_EQUAL(6, area_of_loops(triangle), 1e-9);
    for (const Vec2d p : job::loop_polyline(triangle[0].loop, 1e-3)) {
        CHECK(p.x >= -1e-12 && p.x <= 4 && p.y >= -1e-12 && p.y <= 3);
    }
}

TEST(DxfExpansion, ADrawingInYAndZIsTakenAsSeenFromTheSide)
{
    // a circle about y 8, z 3; its plane has the axes of y and z
    const auto loops = loops_of(
        dxf_drawing("0\nCIRCLE\n8\no\n10\n8\n20\n3\n30\n-4\n40\n2\n210\n1\n220\n0\n230\n0\n"));
    DOUBLES_EQUAL(4 * kPi, area_of_loops(loops), 1e-3);
    STRCMP_CONTAINS("drawn in y and z: y is taken for x, z for y", notes[0].c_str());
    double most = 0;
    for (const Vec2d p : job::loop_polyline(loops[0].loop, 1e-4)) {
        most = std::max(most, std::hypot(p.x - 8, p.y - 3));
    }
    DOUBLES_EQUAL(2, most, 1e-3);
}

TEST(DxfExpansion, HeightsAloneAreSeenFromAboveWithANote)
{
    const std::string tall = "0\nLINE\n8\no\n10\n1\n20\n1\n30\n0\n11\n1\n21\n1\n31\n9\n";
    DOUBLES_EQUAL(6, area_of_loops(loops_of(dxf_drawing(dxf_rectangle({0, 0}, {3, 2}) + tall))),
                  1e-9);
    STRCMP_CONTAINS("not flat: z goes from 0 to 9 mm; seen from above", notes[0].c_str());
    // all at one height: nothing to say
    loops_of(dxf_drawing("0\nCIRCLE\n8\no\n10\n0\n20\n0\n30\n12\n40\n3\n"));
    CHECK(notes.empty());
}

TEST(DxfExpansion, AxesOfObjectsFollowTheReference)
{
    // by the arbitrary axis algorithm, from directions that CAD programs write
    const auto goes = [](Vec3d normal, Vec3d x, Vec3d y) {
        const Similarity axes = object_axes(normal);
        DOUBLES_EQUAL(0, norm(axes.axes[0] - x), 1e-12);
        DOUBLES_EQUAL(0, norm(axes.axes[1] - y), 1e-12);
        DOUBLES_EQUAL(0, norm(axes.axes[2] - 1 / norm(normal) * normal), 1e-12);
    };
    goes({0, 0, 1}, {1, 0, 0}, {0, 1, 0});
    goes({0, 0, -2}, {-1, 0, 0}, {0, 1, 0});
    goes({0, -1, 0}, {1, 0, 0}, {0, 0, 1});
    goes({0, 1, 0}, {-1, 0, 0}, {0, 0, 1});
    goes({1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    goes({-1, 0, 0}, {0, -1, 0}, {0, 0, 1});
}

TEST(DxfExpansion, SurveyCoordinatesKeepTheirLoopsAndCircles)
{
    // a metre drawing in a national grid
    const Vec2d far{512345.678, 5401234.567};
    const std::vector<Vec2d> corners{far, far + Vec2d{0.1, 0.01}, far + Vec2d{0.09, 0.08}};
    std::string entities;
    for (std::size_t k = 0; k < 3; ++k) {
        entities += dxf_line(corners[k], corners[(k + 1) % 3]);
    }
    const std::string text = dxf_drawing(entities + dxf_circle(far + Vec2d{0.06, 0.03}, 0.003),
                                         {{9, "$INSUNITS"}, {70, "6"}});
    const auto loops = loops_of(text);
    UNSIGNED_LONGS_EQUAL(2, loops.size());
    const double triangle = 1e6 * (0.1 * 0.08 - 0.01 * 0.09) / 2;
    DOUBLES_EQUAL(triangle + 9 * kPi, area_of_loops(loops), 1e-2);
    STRCMP_CONTAINS("far from the origin: [placing] with origin = \"corner\" moves it there",
                    notes.back().c_str());
    const auto holes = read_holes(folder.file("d.dxf"), 1, {0, 1e3}, true, notes);
    UNSIGNED_LONGS_EQUAL(1, holes.size());
    DOUBLES_EQUAL(6, holes[0].diameter, 1e-5);
}
