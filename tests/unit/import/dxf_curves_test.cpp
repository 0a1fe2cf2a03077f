// Drawings with known areas, and drawings that are broken.
#include "host_tools/job/import/dxf_curves.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "host_tools/cam/contour_pocket/contour_pocket.hpp"
#include "host_tools/job/import/drawn_shapes.hpp"
#include "host_tools/job/import/dxf_holes.hpp"
#include "host_tools/job/import/file_loops.hpp"
#include "host_tools/job/import/import.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/job/job/loop_shape.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::job;
using namespace cusp::nurbs;

namespace {

std::string drawing(const std::string& entities)
{
    return "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1015\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" +
           entities + "0\nENDSEC\n0\nEOF\n";
}

std::string line(const std::string& ax,
                 const std::string& ay,
                 const std::string& bx,
                 const std::string& by)
{
    return "0\nLINE\n8\n0\n10\n" + ax + "\n20\n" + ay + "\n11\n" + bx + "\n21\n" + by + "\n";
}

}  // namespace

TEST_GROUP(DxfCurves)
{
    cusp::test::TemporaryFolder folder;
    double area(const std::string& entities, double unit = 1)
    {
        const Loop loop = read_loop(folder.with("d.dxf", drawing(entities)), unit);
        return signed_area(loop_polyline(loop, 1e-5));
    }
    std::string refused(const std::string& text)
    {
        const std::string file = folder.with("d.dxf", text);
        return cusp::test::refusal([&] { read_loop(file); });
    }
};

TEST(DxfCurves, OrderAndTurnLinesThatAreDrawnInAnyOrder)
{
    const std::string entities = line("0", "0", "4", "0") + line("0", "3", "0", "0") +
                                 line("4", "3", "4", "0") + line("4", "3", "0", "3");
    DOUBLES_EQUAL(12, area(entities), 1e-9);
    DOUBLES_EQUAL(12 * 25.4 * 25.4, area(entities, 25.4), 1e-6);
}

TEST(DxfCurves, AreExactCirclesAndArcs)
{
    DOUBLES_EQUAL(25 * kPi, area("0\nCIRCLE\n10\n1\n20\n2\n40\n5\n"), 1e-3);
    const std::string half =
        "0\nARC\n10\n0\n20\n0\n40\n2\n50\n270\n51\n90\n" + line("0", "2", "0", "-2");
    DOUBLES_EQUAL(2 * kPi, area(half), 1e-3);
    const Curve arc = arc_curve({1, 2}, 3, 0.5, -4);
    for (int k = 0; k <= 20; ++k) {
        const Vec3d p = point_at(arc, arc.domain_end() * k / 20);
        DOUBLES_EQUAL(3, std::hypot(p.x - 1, p.y - 2), 1e-12);
    }
}

TEST(DxfCurves, FollowTheBulgesOfPolylines)
{
    // a slot: two straight sides of 10, half circles of radius 2 at both ends
    const std::string slot =
        "0\nLWPOLYLINE\n90\n4\n70\n1\n10\n0\n20\n-2\n10\n10\n20\n-2\n42\n1\n"
        "10\n10\n20\n2\n10\n0\n20\n2\n42\n1\n";
    DOUBLES_EQUAL(40 + 4 * kPi, area(slot), 1e-3);
    // bulging inwards
    const std::string notch =
        "0\nLWPOLYLINE\n90\n4\n70\n1\n10\n0\n20\n-2\n10\n10\n20\n-2\n42\n-1\n"
        "10\n10\n20\n2\n10\n0\n20\n2\n";
    DOUBLES_EQUAL(40 - 2 * kPi, area(notch), 1e-3);
}

TEST(DxfCurves, ReadSplines)
{
    const std::string spline =
        "0\nSPLINE\n70\n8\n71\n2\n72\n6\n73\n3\n40\n0\n40\n0\n40\n0\n40\n1\n40\n1\n40\n1\n"
        "10\n0\n20\n0\n30\n0\n10\n2\n20\n4\n30\n0\n10\n4\n20\n0\n30\n0\n";
    DOUBLES_EQUAL(16.0 / 3, area(spline + line("0", "0", "4", "0")), 1e-3);
}

TEST(DxfCurves, MirrorWhatIsDrawnFromBelow)
{
    const std::string entities =
        "0\nARC\n10\n0\n20\n0\n40\n2\n50\n90\n51\n270\n230\n-1\n" + line("0", "2", "0", "-2");
    const Loop loop = read_loop(folder.with("d.dxf", drawing(entities)));
    double rightmost = 0;
    for (const Vec2d p : loop_polyline(loop, 0.01)) {
        rightmost = std::max(rightmost, p.x);
    }
    DOUBLES_EQUAL(2, rightmost, 1e-2);
}

TEST(DxfCurves, RefuseBrokenDrawings)
{
    STRCMP_CONTAINS("ENTITIES", refused("0\nSECTION\n2\nHEADER\n0\nENDSEC\n0\nEOF\n").c_str());
    STRCMP_CONTAINS("d.dxf:1: \"hello\" is no DXF group code", refused("hello\nworld\n").c_str());
    STRCMP_CONTAINS("is not a number", refused(drawing(line("0", "x", "4", "0"))).c_str());
    STRCMP_CONTAINS("LINE without group 11", refused(drawing("0\nLINE\n10\n0\n20\n0\n")).c_str());
    STRCMP_CONTAINS("radius -1", refused(drawing("0\nCIRCLE\n10\n0\n20\n0\n40\n-1\n")).c_str());
    STRCMP_CONTAINS("no curve", refused(drawing("0\n3DFACE\n10\n0\n")).c_str());
    STRCMP_CONTAINS("no curve", refused(drawing("")).c_str());
    STRCMP_CONTAINS("open", refused(drawing(line("0", "0", "4", "0"))).c_str());
    STRCMP_CONTAINS("SPLINE without control points and without fit points",
                    refused(drawing("0\nSPLINE\n71\n3\n")).c_str());
}

TEST(DxfCurves, AreExactEllipses)
{
    DOUBLES_EQUAL(10 * kPi,
                  area("0\nELLIPSE\n10\n3\n20\n1\n11\n3\n21\n4\n40\n0.4\n41\n0\n42\n"
                       "6.283185307179586\n"),
                  1e-3);
    // half of it, closed by its long axis
    DOUBLES_EQUAL(5 * kPi,
                  area("0\nELLIPSE\n10\n0\n20\n0\n11\n5\n21\n0\n40\n0.4\n41\n0\n42\n"
                       "3.141592653589793\n" +
                       line("-5", "0", "5", "0")),
                  1e-3);
}

TEST(DxfCurves, TakeOldPolylinesWithBulges)
{
    const auto vertex = [](const std::string& x, const std::string& y, const std::string& bulge) {
        return "0\nVERTEX\n8\n0\n10\n" + x + "\n20\n" + y + "\n30\n0\n42\n" + bulge + "\n";
    };
    DOUBLES_EQUAL(
        2 * 4 + kPi / 2,
        area("0\nPOLYLINE\n8\n0\n66\n1\n70\n1\n" + vertex("0", "0", "0") + vertex("4", "0", "1") +
             vertex("4", "2", "0") + vertex("0", "2", "0") + "0\nSEQEND\n8\n0\n"),
        1e-3);
}

TEST(DxfCurves, BelieveTheDrawingThatItIsInInches)
{
    const std::string text =
        "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n1\n9\n$MEASUREMENT\n70\n0\n0\nENDSEC\n"
        "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n10\n0\n20\n0\n40\n1\n0\nENDSEC\n0\nEOF\n";
    const Loop loop = read_loop(folder.with("d.dxf", text));
    DOUBLES_EQUAL(25.4 * 25.4 * kPi, signed_area(loop_polyline(loop, 1e-5)), 0.1);
}

TEST(DxfCurves, LeaveHiddenLayersOutAndTakeTheLayerAskedFor)
{
    const auto circle = [](const std::string& layer, const std::string& radius) {
        return "0\nCIRCLE\n8\n" + layer + "\n10\n0\n20\n0\n40\n" + radius + "\n";
    };
    const std::string file =
        folder.with("d.dxf",
                    "0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n0\nLAYER\n2\nnotes\n70\n0\n62\n-7\n"
                    "0\nENDTAB\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" +
                        circle("notes", "9") + circle("outline", "2") + "0\nENDSEC\n0\nEOF\n");
    DOUBLES_EQUAL(4 * kPi, signed_area(loop_polyline(read_loop(file), 1e-5)), 1e-3);
    DOUBLES_EQUAL(81 * kPi, signed_area(loop_polyline(read_loop(file + "#notes"), 1e-5)), 1e-2);
    STRCMP_CONTAINS("no curve on the layer \"holes\"",
                    cusp::test::refusal([&] { read_loop(file + "#holes"); }).c_str());
}

TEST(DxfCurves, TakeALayerWithANumberSignInItsName)
{
    const std::string file =
        folder.with("e.dxf", drawing("0\nCIRCLE\n8\nholes # 3\n10\n0\n20\n0\n40\n2\n"));
    DOUBLES_EQUAL(4 * kPi, signed_area(loop_polyline(read_loop(file + "#holes # 3"), 1e-5)), 1e-3);
}

TEST(DxfCurves, SayWhatIsOnALayerWithoutCurves)
{
    const std::string file =
        folder.with("f.dxf", drawing("0\nTEXT\n8\nlabel\n10\n0\n20\n0\n40\n3\n1\nHello\n"
                                     "0\nCIRCLE\n8\ncut\n10\n0\n20\n0\n40\n2\n"));
    STRCMP_CONTAINS(
        "no curve on the layer \"label\"; it holds TEXT: convert text to curves in the drawing "
        "program",
        cusp::test::refusal([&] { read_loop(file + "#label"); }).c_str());
}

namespace {

std::string with_blocks(const std::string& blocks, const std::string& entities)
{
    return "0\nSECTION\n2\nBLOCKS\n" + blocks + "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n" + entities +
           "0\nENDSEC\n0\nEOF\n";
}

std::string block(const std::string& name, const std::string& entities)
{
    return "0\nBLOCK\n8\n0\n2\n" + name + "\n10\n1\n20\n0\n" + entities + "0\nENDBLK\n8\n0\n";
}

std::string insert(const std::string& name, const std::string& groups)
{
    return "0\nINSERT\n8\n0\n2\n" + name + "\n" + groups;
}

const std::string kSquare = line("1", "0", "3", "0") + line("3", "0", "3", "2") +
                            line("3", "2", "1", "2") + line("1", "2", "1", "0");

}  // namespace

TEST(DxfCurves, DrawBlocksWhereTheyAreInserted)
{
    // The base point (1, 0) comes to (10, 20), turned by a quarter.
    const std::string text = with_blocks(
        block("Square", kSquare),
        insert("SQUARE", "10\n10\n20\n20\n41\n2\n42\n3\n50\n90\n0\nATTRIB\n1\nname\n0\nSEQEND\n"));
    const Loop loop = read_loop(folder.with("d.dxf", text));
    DOUBLES_EQUAL(24, signed_area(loop_polyline(loop, 1e-5)), 1e-9);
    for (const Curve& curve : loop) {
        for (const Vec3d& p : curve.points) {
            CHECK(std::abs(p.x - 10) < 1e-9 || std::abs(p.x - 4) < 1e-9);
            CHECK(std::abs(p.y - 20) < 1e-9 || std::abs(p.y - 24) < 1e-9);
        }
    }
}

TEST(DxfCurves, ScaleCirclesOfBlocksToEllipsesAndNestThem)
{
    const std::string text =
        with_blocks(block("inner", "0\nCIRCLE\n8\n0\n10\n1\n20\n0\n40\n1\n") +
                        block("outer", insert("inner", "10\n1\n20\n0\n41\n-2\n42\n3\n50\n30\n")),
                    insert("outer", "10\n5\n20\n6\n41\n2\n42\n2\n"));
    const Loop loop = read_loop(folder.with("d.dxf", text));
    DOUBLES_EQUAL(24 * kPi, signed_area(loop_polyline(loop, 1e-5)), 1e-2);
}

TEST(DxfCurves, RepeatBlocksInArrays)
{
    const std::string text =
        with_blocks(block("dot", "0\nCIRCLE\n8\n0\n10\n1\n20\n0\n40\n1\n"),
                    insert("dot", "10\n0\n20\n0\n70\n3\n71\n2\n44\n5\n45\n7\n"));
    const auto curves = curves_of(read_dxf_paths(folder.with("d.dxf", text), 1).paths);
    CHECK_EQUAL(6U, curves.size());
    double sum = 0;
    for (const Curve& curve : curves) {
        sum += curve.points.front().x - 1;
    }
    DOUBLES_EQUAL(2 * (0 + 5 + 10), sum, 1e-9);
}

TEST(DxfCurves, PutLayerZeroOfABlockOnTheLayerOfItsReference)
{
    const std::string text =
        with_blocks(block("square", kSquare + "0\nCIRCLE\n8\nother\n10\n9\n20\n9\n40\n1\n"),
                    "0\nINSERT\n8\ncut\n2\nsquare\n10\n0\n20\n0\n" + line("50", "50", "60", "60"));
    CHECK_EQUAL(4U, curves_of(read_dxf_paths(folder.with("d.dxf", text), 1, "cut").paths).size());
    CHECK_EQUAL(1U, curves_of(read_dxf_paths(folder.with("d.dxf", text), 1, "other").paths).size());
    CHECK_EQUAL(6U, curves_of(read_dxf_paths(folder.with("d.dxf", text), 1).paths).size());
}

TEST(DxfCurves, RefuseReferencesThatCannotBeDrawn)
{
    const std::string at = "10\n0\n20\n0\n";
    STRCMP_CONTAINS("no such block",
                    refused(with_blocks(block("a", kSquare), insert("b", at))).c_str());
    STRCMP_CONTAINS("more than 16 deep",
                    refused(with_blocks(block("a", insert("a", at)), insert("a", at))).c_str());
    STRCMP_CONTAINS("scale 0, 1",
                    refused(with_blocks(block("a", kSquare), insert("a", at + "41\n0\n"))).c_str());
    STRCMP_CONTAINS("more than 100000 curves",
                    refused(with_blocks(block("a", kSquare),
                                        insert("a", at + "70\n60000\n71\n60000\n44\n1\n45\n1\n")))
                        .c_str());
    STRCMP_CONTAINS("without group 10",
                    refused(with_blocks(block("a", kSquare), insert("a", "20\n0\n"))).c_str());
}

namespace {

// A closed square as an LWPOLYLINE.
std::string square(double low_x, double low_y, double side, const std::string& layer = "0")
{
    std::string out = "0\nLWPOLYLINE\n8\n" + layer + "\n90\n4\n70\n1\n";
    for (const Vec2d corner : {Vec2d{0, 0}, Vec2d{1, 0}, Vec2d{1, 1}, Vec2d{0, 1}}) {
        out += "10\n" + std::to_string(low_x + side * corner.x) + "\n20\n" +
               std::to_string(low_y + side * corner.y) + "\n";
    }
    return out;
}

std::vector<double> areas_of(const std::vector<Loop>& loops)
{
    std::vector<double> areas;
    for (const Loop& loop : loops) {
        areas.push_back(signed_area(loop_polyline(loop, 1e-4)));
    }
    return areas;
}

}  // namespace

TEST(DxfCurves, BoundPocketsByTheirNesting)
{
    // a plate with two holes, a pad in one of them; another plate beside it
    const std::string file = folder.with(
        "d.dxf", drawing(square(0, 0, 100) + square(10, 10, 30) + square(60, 60, 10) +
                         square(20, 20, 5) + square(200, 0, 50) + square(210, 10, 6, "keep")));
    std::vector<std::string> notes;
    Operation operation;
    operation.strategy = &cusp::contour_pocket::kContourPocket;
    const auto pockets = pockets_of(operation, read_loops(file + "#0", 1, {0.02, {}}, notes),
                                    read_loops(file + "#keep", 1, {0.02, {}}, notes));
    CHECK(notes.empty());
    CHECK_EQUAL(3U, pockets.size());
    const double bounds[] = {10000, 2500, 25};
    for (std::size_t k = 0; k < 3; ++k) {
        DOUBLES_EQUAL(bounds[k], areas_of({*pockets[k].outline.boundary})[0], 1e-6);
    }
    CHECK((areas_of(pockets[0].outline.islands) == std::vector<double>{900, 100}));
    CHECK((areas_of(pockets[1].outline.islands) == std::vector<double>{36}));
    CHECK(pockets[2].outline.islands.empty());
    STRCMP_CONTAINS("d.dxf#0: loop 2 of 5, at x 200 y 0 mm",
                    pockets[1].outline.boundary_file.c_str());
    const std::string outside = cusp::test::refusal([&] {
        pockets_of(
            operation, read_loops(file + "#0", 1, {0.02, {}}, notes),
            read_loops(folder.with("e.dxf", drawing(square(-20, 0, 5))), 1, {0.02, {}}, notes));
    });
    STRCMP_CONTAINS("the island lies outside all 3 pockets", outside.c_str());
}

TEST(DxfCurves, NameTextsBesideThem)
{
    const std::string circle = "0\nCIRCLE\n8\nname\n10\n0\n20\n0\n40\n9\n";
    const auto text = [](const std::string& type, const std::string& more) {
        return "0\n" + type + "\n8\nname\n10\n3\n20\n4\n40\n2\n1\nHello\n" + more;
    };
    const auto said = [&](const std::string& file, const std::string& layer = "name") {
        std::vector<std::string> notes;
        read_dxf_paths(file, 1, layer, &notes);
        return notes.empty() ? std::string{} : notes.front().substr(notes.front().find("d.dxf"));
    };
    const std::string plain = folder.with("d.dxf", drawing(circle + text("TEXT", "")));
    const std::string rest = " not cut: convert text to curves in the drawing program";
    CHECK_EQUAL("d.dxf#name: a text at x 3 y 4 mm is" + rest, said(plain));
    CHECK_EQUAL("d.dxf: a text at x 3 y 4 mm is" + rest, said(plain, ""));
    // drawn from below; on another layer; hidden
    CHECK_EQUAL("d.dxf#name: 2 texts, the first at x -3 y 4 mm are" + rest,
                said(folder.with("d.dxf", drawing(text("TEXT", "230\n-1\n") + circle +
                                                  text("MTEXT", "") + text("TEXT", "60\n1\n") +
                                                  "0\nTEXT\n8\nother\n10\n0\n20\n0\n"))));
    CHECK_EQUAL("", said(folder.with("d.dxf", drawing(circle + text("ATTDEF", "")))));
    // in a block, which is turned by a quarter
    const std::string block = "0\nSECTION\n2\nBLOCKS\n0\nBLOCK\n2\nlabel\n10\n1\n20\n0\n" +
                              text("TEXT", "") + "0\nENDBLK\n0\nENDSEC\n";
    const std::string insert = "0\nINSERT\n2\nlabel\n10\n100\n20\n50\n50\n90\n";
    CHECK_EQUAL("d.dxf#name: a text at x 96 y 52 mm is" + rest,
                said(folder.with("d.dxf", block + drawing(circle + insert))));
}

TEST(DxfCurves, AreEngravedAndDrilledOnceWhereDrawnTwice)
{
    std::vector<std::string> notes;
    const std::string twice = line("0", "0", "4", "0") + line("4", "0", "0", "0") +
                              line("4", "0", "4", "3") + line("9", "9", "9", "8");
    const auto chains = read_chains(folder.with("d.dxf", drawing(twice)), 1, notes);
    LONGS_EQUAL(2, chains.size());
    LONGS_EQUAL(2, chains[0].size());
    LONGS_EQUAL(1, notes.size());
    STRCMP_CONTAINS("d.dxf: 1 curve is drawn twice and taken once", notes[0].c_str());
    // a circle of two bulges, drawn twice
    const std::string ring =
        "0\nLWPOLYLINE\n8\n0\n70\n1\n10\n0\n20\n0\n42\n1\n10\n6\n20\n0\n42\n1\n";
    const auto holes =
        read_holes(folder.with("d.dxf", drawing(ring + ring)), 1, {0, 1e3}, false, notes);
    LONGS_EQUAL(1, holes.size());
    DOUBLES_EQUAL(6, holes[0].diameter, 1e-9);
}

TEST(DxfCurves, AreJoinedAtGapsUpToTheToleranceAndNotBeyond)
{
    // gaps of 0.015 and 0.01, with a side of 0.012 between them
    const std::string soup = line("0", "0", "10", "0") + line("10.015", "0", "10.015", "0.012") +
                             line("10.015", "0.022", "10", "10") + line("0", "0", "10", "10");
    const std::string file = folder.with("d.dxf", drawing(soup));
    std::vector<std::string> notes;
    const auto loops = read_loops(file, 1, {0.02, {}}, notes);
    CHECK_EQUAL(1U, loops.size());
    DOUBLES_EQUAL(50, areas_of({loops[0].loop})[0], 0.2);
    CHECK_EQUAL(1U, notes.size());
    STRCMP_CONTAINS("d.dxf: 2 gaps of up to 0.015 mm are joined; the limit is 0.02 mm",
                    notes[0].c_str());
    const std::string open = cusp::test::refusal([&] { read_loops(file, 1, {0, 0.012}, notes); });
    STRCMP_CONTAINS("the loop is open: 4 curves from x 10 y 0 to x 10.015 y 0 mm", open.c_str());
    STRCMP_CONTAINS("is 0.015 mm, the limit is 0.012 mm: join_gaps", open.c_str());
}

TEST(DxfCurves, TakeChainsOfBezierCurvesApart)
{
    // two parabolas over the chords from 0 to 4 and from 4 to 8, in one SPLINE
    const std::string chain =
        "0\nSPLINE\n70\n8\n71\n2\n72\n9\n73\n6\n40\n0\n40\n0\n40\n0\n40\n1\n40\n1\n40\n1\n"
        "40\n3\n40\n3\n40\n3\n10\n0\n20\n0\n10\n2\n20\n4\n10\n4\n20\n0\n"
        "10\n4\n20\n0\n10\n6\n20\n4\n10\n8\n20\n0\n";
    DOUBLES_EQUAL(2 * 16.0 / 3, area(chain + line("0", "0", "8", "0")), 1e-3);
    CHECK_EQUAL(3U, curves_of(read_dxf_paths(folder.file("d.dxf"), 1).paths).size());
    // a knot too many is still an error
    std::string broken = chain;
    broken.replace(broken.find("40\n3\n40\n3"), 5, "40\n1\n");
    STRCMP_CONTAINS("SPLINE", refused(drawing(broken)).c_str());
}
