// Holes of solids that Open CASCADE drills and writes, read back.
#include "host_tools/job/import/cad_holes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "host_tools/cam/strategies/strategies.hpp"

#include "opencascade/BRepAlgoAPI_Cut.hxx"
#include "opencascade/BRepPrimAPI_MakeBox.hxx"
#include "opencascade/BRepPrimAPI_MakeCone.hxx"
#include "opencascade/BRepPrimAPI_MakeCylinder.hxx"
#include "opencascade/BRepPrimAPI_MakeSphere.hxx"
#include "opencascade/Interface_Static.hxx"
#include "opencascade/STEPControl_Controller.hxx"
#include "opencascade/STEPControl_Writer.hxx"
#include "opencascade/gp_Ax2.hxx"
// CppUTest's macros come last
#include "CppUTest/TestHarness.h"
// it needs the harness before it
#include "CppUTest/MemoryLeakWarningPlugin.h"

#include "host_tools/job/import/import.hpp"
#include "host_tools/job/job/hole_depth.hpp"
#include "tests/support/property_cases.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::job;
using namespace cusp::test;

namespace {

// Open CASCADE keeps its tables to the end of the process: counting leaks is off from the start on.
const bool counting_off = [] {
    MemoryLeakWarningPlugin::turnOffNewDeleteOverloads();
    return true;
}();

TopoDS_Shape plate() { return BRepPrimAPI_MakeBox(gp_Pnt(0, 0, -20), gp_Pnt(100, 60, 0)).Shape(); }

gp_Ax2 upright(double x, double y, double z)
{
    return {gp_Pnt(x, y, z), gp_Dir(0, 0, 1), gp_Dir(1, 0, 0)};
}

TopoDS_Shape cylinder(double x, double y, double low, double high, double radius)
{
    return BRepPrimAPI_MakeCylinder(upright(x, y, low), radius, high - low).Shape();
}

TopoDS_Shape without(const TopoDS_Shape& body, const TopoDS_Shape& tool)
{
    return BRepAlgoAPI_Cut(body, tool).Shape();
}

}  // namespace

TEST_GROUP(CadHoles)
{
    TemporaryFolder folder;

    std::string step(const TopoDS_Shape& shape)
    {
        STEPControl_Controller::Init();
        Interface_Static::SetCVal("write.step.unit", "MM");
        STEPControl_Writer writer;
        writer.Transfer(shape, STEPControl_AsIs);
        const std::string file = folder.file("part.step");
        CHECK_EQUAL(IFSelect_RetDone, writer.Write(file.c_str()));
        return file;
    }
    CadHoles holes(const TopoDS_Shape& shape, const Similarity& placed = {})
    {
        return read_cad_holes(step(shape), placed);
    }
    Hole only(const TopoDS_Shape& shape)
    {
        const CadHoles found = holes(shape);
        LONGS_EQUAL(1, found.holes.size());
        return found.holes.front();
    }
};

TEST(CadHoles, AThroughHoleHasItsPlaceDiameterAndHeights)
{
    const Hole hole = only(without(plate(), cylinder(30, 20, -25, 5, 2.5)));
    DOUBLES_EQUAL(30, hole.at.x, 1e-6);
    DOUBLES_EQUAL(20, hole.at.y, 1e-6);
    DOUBLES_EQUAL(5, hole.diameter, 1e-6);
    DOUBLES_EQUAL(0, hole.span->top, 1e-6);
    DOUBLES_EQUAL(-20, hole.span->bottom, 1e-6);
    CHECK(hole.span->through);
}

TEST(CadHoles, ABlindHoleEndsAtItsLevelBottomAtItsConeOrItsBall)
{
    const Hole level = only(without(plate(), cylinder(30, 20, -8, 5, 2.5)));
    DOUBLES_EQUAL(-8, level.span->bottom, 1e-6);
    CHECK_FALSE(level.span->through);
    const TopoDS_Shape drilled = without(plate(), cylinder(30, 20, -8, 5, 2.5));
    const double tip = 2.5 / std::tan(59 * 3.14159265358979 / 180);
    const Hole cone = only(
        without(drilled, BRepPrimAPI_MakeCone(upright(30, 20, -8 - tip), 0, 2.5, tip).Shape()));
    DOUBLES_EQUAL(-8 - tip, cone.span->bottom, 1e-6);
    CHECK_FALSE(cone.span->through);
    const Hole ball =
        only(without(drilled, BRepPrimAPI_MakeSphere(gp_Pnt(30, 20, -8), 2.5).Shape()));
    DOUBLES_EQUAL(-10.5, ball.span->bottom, 1e-6);
    CHECK_FALSE(ball.span->through);
}

TEST(CadHoles, OfACounterboreBothDiametersAreHoles)
{
    const CadHoles found =
        holes(without(without(plate(), cylinder(30, 20, -25, 5, 2)), cylinder(30, 20, -6, 5, 4)));
    LONGS_EQUAL(2, found.holes.size());
    DOUBLES_EQUAL(4, found.holes[0].diameter, 1e-6);
    CHECK(found.holes[0].span->through);
    DOUBLES_EQUAL(-6, found.holes[0].span->top, 1e-6);
    DOUBLES_EQUAL(8, found.holes[1].diameter, 1e-6);
    CHECK_FALSE(found.holes[1].span->through);
    DOUBLES_EQUAL(-6, found.holes[1].span->bottom, 1e-6);
}

TEST(CadHoles, ACountersinkIsTheConeOverItsHole)
{
    const TopoDS_Shape drilled = without(plate(), cylinder(30, 20, -25, 5, 2.5));
    // 90 degrees, from a diameter of 5 mm to 10 mm at the top
    const CadHoles found =
        holes(without(drilled, BRepPrimAPI_MakeCone(upright(30, 20, -2.5), 2.5, 5.5, 3).Shape()));
    LONGS_EQUAL(1, found.holes.size());
    DOUBLES_EQUAL(-2.5, found.holes[0].span->top, 1e-6);
    CHECK(found.cones[0].has_value());
    DOUBLES_EQUAL(10, found.cones[0]->diameter, 1e-6);
    DOUBLES_EQUAL(2.5, found.cones[0]->depth, 1e-6);
    DOUBLES_EQUAL(90, found.cones[0]->angle, 1e-6);
    CHECK_FALSE(holes(drilled).cones[0].has_value());
}

TEST(CadHoles, CornersOfPocketsAreCountedByTheirRadius)
{
    const TopoDS_Shape pocket = BRepPrimAPI_MakeBox(gp_Pnt(20, 10, -5), gp_Pnt(60, 40, 5)).Shape();
    LONGS_EQUAL(0, holes(without(plate(), pocket)).corners.size());
    // a slot's two ends
    const TopoDS_Shape ends =
        without(without(plate(), cylinder(20, 25, -5, 5, 4)), cylinder(60, 25, -5, 5, 4));
    const CadHoles found =
        holes(without(ends, BRepPrimAPI_MakeBox(gp_Pnt(20, 21, -5), gp_Pnt(60, 29, 5)).Shape()));
    LONGS_EQUAL(2, found.corners.size());
    DOUBLES_EQUAL(4, found.corners[0], 1e-6);
    LONGS_EQUAL(0, found.holes.size());
}

TEST(CadHoles, OpenBelowHorizontalAndSolidCylindersAreNone)
{
    const CadHoles below = holes(without(plate(), cylinder(30, 20, -25, -12, 2.5)));
    LONGS_EQUAL(0, below.holes.size());
    LONGS_EQUAL(1, below.closed_above);
    const TopoDS_Shape lying =
        BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(-5, 20, -10), gp_Dir(1, 0, 0)), 2.5, 120).Shape();
    LONGS_EQUAL(0, holes(without(plate(), lying)).holes.size());
    LONGS_EQUAL(0, holes(cylinder(30, 20, -10, 0, 6)).holes.size());
    // a half of one, at the plate's edge
    LONGS_EQUAL(0, holes(without(plate(), cylinder(30, 0, -25, 5, 4))).holes.size());
}

TEST(CadHoles, TheyLieWhereTheFileIsPlaced)
{
    Similarity placed;
    placed.axes = {Vec3d{0, 2, 0}, Vec3d{-2, 0, 0}, Vec3d{0, 0, 2}};
    placed.shift = {100, 0, 40};
    const CadHoles found = holes(without(plate(), cylinder(30, 20, -8, 5, 2.5)), placed);
    LONGS_EQUAL(1, found.holes.size());
    DOUBLES_EQUAL(60, found.holes[0].at.x, 1e-6);
    DOUBLES_EQUAL(60, found.holes[0].at.y, 1e-6);
    DOUBLES_EQUAL(10, found.holes[0].diameter, 1e-6);
    DOUBLES_EQUAL(24, found.holes[0].span->bottom, 1e-6);
}

// Against the numbers that they were drilled by.
TEST(CadHoles, RandomPlatesHaveTheHolesThatWereDrilled)
{
    constexpr unsigned kSeed = 29;
    const int cases = property_cases(12);
    std::printf("plates with holes: seed %u, %d cases\n", kSeed, cases);
    std::mt19937 engine{kSeed};
    const auto draw = [&](double low, double high) {
        return std::uniform_real_distribution<double>{low, high}(engine);
    };
    for (int i = 0; i < cases; ++i) {
        TopoDS_Shape body = plate();
        std::vector<Hole> drilled;
        for (int k = 0; k < 6; ++k) {
            const bool through = draw(0, 1) < 0.5;
            const Hole hole{{10 + 16.0 * k, draw(10, 50)},
                            draw(1, 12),
                            Hole::Span{0, through ? -20 : draw(-18, -1), through}};
            body = without(body, cylinder(hole.at.x, hole.at.y, through ? -25 : hole.span->bottom,
                                          5, hole.diameter / 2));
            drilled.push_back(hole);
        }
        const CadHoles found = holes(body);
        LONGS_EQUAL(drilled.size(), found.holes.size());
        for (const Hole& hole : drilled) {
            CHECK(std::any_of(found.holes.begin(), found.holes.end(), [&](const Hole& other) {
                return norm(other.at - hole.at) < 1e-6 &&
                       std::abs(other.diameter - hole.diameter) < 1e-6 &&
                       std::abs(other.span->bottom - hole.span->bottom) < 1e-6 &&
                       other.span->through == hole.span->through;
            }));
        }
    }
}

TEST(CadHoles, AJobDrillsThemToTheirDepths)
{
    step(without(without(plate(), cylinder(30, 20, -25, 5, 2.5)), cylinder(60, 20, -8, 5, 2.5)));
    const std::string head =
        "[tool]\nshape = \"drill\"\ndiameter = 5\n[cutting]\nfeed = 100\n[[operation]]\n"
        "strategy = \"drill\"\nboundary = \"part.step\"\n";
    const auto job_of = [&](const std::string& keys) {
        return read_job(folder.with("job.toml", head + keys), cusp::strategies::all());
    };
    const Operation operation = job_of("").operations.front();
    const Prismatic& cut = *operation.prismatic;
    LONGS_EQUAL(2, cut.holes.size());
    const double tip = 2.5 / std::tan(59 * 3.14159265358979 / 180);
    DOUBLES_EQUAL(-20.5 - tip, tip_in_hole(cut, cut.holes[0], operation.tool), 1e-6);
    DOUBLES_EQUAL(-8, tip_in_hole(cut, cut.holes[1], operation.tool), 1e-6);
    DOUBLES_EQUAL(20.5 + tip, cut.depth, 1e-6);
    const Operation equal = job_of("depth = 3\n").operations.front();
    DOUBLES_EQUAL(-3, tip_in_hole(*equal.prismatic, equal.prismatic->holes[0], equal.tool), 1e-9);
    STRCMP_CONTAINS("part.step: no hole of the wanted diameter; there are 5 mm",
                    refusal([&] { job_of("diameter = 4\n"); }).c_str());
    STRCMP_CONTAINS("ends 2 mm above the top of z -10 mm; raise top",
                    refusal([&] { job_of("top = -10\n"); }).c_str());
}
