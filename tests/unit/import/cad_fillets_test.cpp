// Fillets of solids that Open CASCADE puts together and writes, read back: its own fillets come out reversed at times.
#include "host_tools/job/import/cad_fillets.hpp"

#include <cmath>

#include "opencascade/BRepAlgoAPI_Cut.hxx"
#include "opencascade/BRepAlgoAPI_Fuse.hxx"
#include "opencascade/BRepPrimAPI_MakeBox.hxx"
#include "opencascade/BRepPrimAPI_MakeCylinder.hxx"
#include "opencascade/BRepPrimAPI_MakeSphere.hxx"
#include "opencascade/BRepPrimAPI_MakeTorus.hxx"
#include "opencascade/gp_Ax2.hxx"
// CppUTest's macros come last
#include "CppUTest/TestHarness.h"
// it needs the harness before it
#include "CppUTest/MemoryLeakWarningPlugin.h"

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/import/cad_writing.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::job;
using namespace cusp::test;

namespace {

// Open CASCADE keeps its tables to the end of the process: counting leaks is off from the start on.
const bool leaks_uncounted = [] {
    MemoryLeakWarningPlugin::turnOffNewDeleteOverloads();
    return true;
}();

constexpr double kTurn = 6.283185307179586;

TopoDS_Shape box(double x0, double y0, double z0, double x1, double y1, double z1)
{
    return BRepPrimAPI_MakeBox(gp_Pnt(x0, y0, z0), gp_Pnt(x1, y1, z1)).Shape();
}
TopoDS_Shape block() { return box(0, 0, 0, 40, 30, 10); }

TopoDS_Shape pin(double x, double y, double radius, double low, double high)
{
    return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(x, y, low), gp_Dir(0, 0, 1)), radius, high - low)
        .Shape();
}
TopoDS_Shape rod(double y, double z, double radius)
{
    return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(-1, y, z), gp_Dir(1, 0, 0)), radius, 42).Shape();
}
TopoDS_Shape ring(double z, double radius, double tube)
{
    return BRepPrimAPI_MakeTorus(gp_Ax2(gp_Pnt(20, 15, z), gp_Dir(0, 0, 1)), radius, tube).Shape();
}
TopoDS_Shape without(const TopoDS_Shape& a, const TopoDS_Shape& b)
{
    return BRepAlgoAPI_Cut(a, b).Shape();
}
TopoDS_Shape joined(const TopoDS_Shape& a, const TopoDS_Shape& b)
{
    return BRepAlgoAPI_Fuse(a, b).Shape();
}

}  // namespace

TEST_GROUP(CadFillets)
{
    TemporaryFolder folder;

    std::vector<PartFillets> found(const TopoDS_Shape& shape)
    {
        const std::string file = folder.file("part.step");
        CHECK(write_step(shape, file));
        return fillets_of(read_whole_cad_model(file));
    }
    void check(double radius, bool concave, std::size_t count, double length,
               const PartFillets& one)
    {
        DOUBLES_EQUAL(radius, one.radius, 1e-3);
        CHECK_EQUAL(concave, one.concave);
        UNSIGNED_LONGS_EQUAL(count, one.count);
        DOUBLES_EQUAL(length, one.length, 0.005 * length);
    }
};

TEST(CadFillets, ARoundedUpperEdgeIsConvexAndAsLongAsTheEdge)
{
    const auto all = found(without(block(), without(box(-1, -1, 8, 41, 2, 11), rod(2, 8, 2))));
    UNSIGNED_LONGS_EQUAL(1, all.size());
    check(2, false, 1, 40, all.front());
}

TEST(CadFillets, UprightEdgesOfOneRadiusAreOneKind)
{
    TopoDS_Shape body = block();
    body = without(body, without(box(-1, -1, -1, 3, 3, 11), pin(3, 3, 3, -2, 12)));
    body = without(body, without(box(37, 27, -1, 41, 31, 11), pin(37, 27, 3, -2, 12)));
    body = without(body, without(box(-1, 26, -1, 4, 31, 11), pin(4, 26, 4, -2, 12)));
    const auto all = found(body);
    UNSIGNED_LONGS_EQUAL(2, all.size());
    check(3, false, 2, 20, all[0]);
    check(4, false, 1, 10, all[1]);
}

TEST(CadFillets, TheFootOfABossIsConcaveAndItsRimConvex)
{
    const TopoDS_Shape rim = without(
        pin(20, 15, 8, 5, 20),
        without(without(pin(20, 15, 9, 17.5, 21), pin(20, 15, 5.5, 17, 22)), ring(17.5, 5.5, 2.5)));
    const TopoDS_Shape foot =
        without(without(pin(20, 15, 9.5, 10, 11.5), ring(11.5, 9.5, 1.5)), pin(20, 15, 8, 9, 12));
    const auto all = found(joined(joined(block(), rim), foot));
    UNSIGNED_LONGS_EQUAL(2, all.size());
    check(1.5, true, 1, kTurn * (9.5 - 1.5 * std::sqrt(0.5)), all[0]);
    check(2.5, false, 1, kTurn * (5.5 + 2.5 * std::sqrt(0.5)), all[1]);
}

TEST(CadFillets, HolesPinsBallsSharpRoundsAndInnerCornersAreNone)
{
    UNSIGNED_LONGS_EQUAL(0, found(block()).size());
    UNSIGNED_LONGS_EQUAL(0, found(without(block(), pin(20, 15, 4, -1, 11))).size());
    UNSIGNED_LONGS_EQUAL(0, found(joined(block(), pin(20, 15, 4, 5, 20))).size());
    const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(gp_Pnt(20, 15, 10), 6).Shape();
    UNSIGNED_LONGS_EQUAL(0, found(joined(block(), ball)).size());
    // a groove with a round bottom of 120 degrees has edges at both sides
    UNSIGNED_LONGS_EQUAL(0, found(without(block(), rod(15, 12, 4))).size());
    // the end of a slot
    const TopoDS_Shape slot = joined(box(10, 12, 5, 30, 18, 11), pin(30, 15, 3, 5, 11));
    UNSIGNED_LONGS_EQUAL(0, found(without(block(), slot)).size());
    // a corner of a pocket
    const TopoDS_Shape pocket = without(box(10, 10, 5, 30, 20, 11),
                                        without(box(9, 9, 4, 12, 12, 12), pin(12, 12, 2, 3, 13)));
    UNSIGNED_LONGS_EQUAL(0, found(without(block(), pocket)).size());
}

TEST(CadFillets, TheRoundOfAFloorIsConcave)
{
    const TopoDS_Shape groove = without(box(-1, 10, 5, 41, 20, 11),
                                        without(box(-2, 9, 4, 42, 11.5, 6.5), rod(11.5, 6.5, 1.5)));
    const auto all = found(without(block(), groove));
    UNSIGNED_LONGS_EQUAL(1, all.size());
    check(1.5, true, 1, 40, all.front());
}
