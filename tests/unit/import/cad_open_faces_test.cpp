// CAD files with a missing face, and in all units.
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "host_tools/job/import/cad_surfaces.hpp"
#include "host_tools/job/import/import.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/import/cad_writing.hpp"
#include "tests/unit/import/seen_from_above.hpp"

#include "opencascade/BRepAlgoAPI_Cut.hxx"
#include "opencascade/BRepGProp.hxx"
#include "opencascade/BRepPrimAPI_MakeBox.hxx"
#include "opencascade/BRepPrimAPI_MakeCylinder.hxx"
#include "opencascade/BRep_Builder.hxx"
#include "opencascade/GProp_GProps.hxx"
#include "opencascade/TopExp_Explorer.hxx"
#include "opencascade/TopoDS.hxx"
#include "opencascade/TopoDS_Compound.hxx"
#include "opencascade/gp_Ax2.hxx"
// CppUTest's macros come last
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::import;
using cusp::test::Seen;
using cusp::test::seen_from_above;

namespace {

// 60 x 40 x 20, the top at z = 0: a pocket 30 x 20 with its floor at -6, and a blind hole of radius 5 to -9.
TopoDS_Shape pocketed_block()
{
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, -20), gp_Pnt(60, 40, 0)).Shape();
    const TopoDS_Shape pocket = BRepPrimAPI_MakeBox(gp_Pnt(5, 10, -6), gp_Pnt(35, 30, 5)).Shape();
    const TopoDS_Shape hole =
        BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(48, 20, -9), gp_Dir(0, 0, 1)), 5, 20).Shape();
    return BRepAlgoAPI_Cut(BRepAlgoAPI_Cut(box, pocket).Shape(), hole).Shape();
}

// The faces but the one whose middle lies nearest to `left_out`.
TopoDS_Shape faces_without(const TopoDS_Shape& solid, gp_Pnt left_out)
{
    std::vector<TopoDS_Face> faces;
    std::size_t nearest = 0;
    double least = 1e9;
    for (TopExp_Explorer at{solid, TopAbs_FACE}; at.More(); at.Next()) {
        GProp_GProps facts;
        BRepGProp::SurfaceProperties(at.Current(), facts);
        const double off = facts.CentreOfMass().Distance(left_out);
        if (off < least) {
            least = off;
            nearest = faces.size();
        }
        faces.push_back(TopoDS::Face(at.Current()));
    }
    const BRep_Builder builder;
    TopoDS_Compound rest;
    builder.MakeCompound(rest);
    for (std::size_t k = 0; k < faces.size(); ++k) {
        if (k != nearest) {
            builder.Add(rest, faces[k]);
        }
    }
    return rest;
}

// A face that may be missing, and what is said of it; "": it is not seen from above.
struct MissingFace {
    gp_Pnt middle;
    const char* said;
};

const std::vector<MissingFace>& missing_faces()
{
    static const std::vector<MissingFace> all{
        {{20, 20, -6}, "30 x 20 mm at x 20 y 20 z -6 mm"},
        {{48, 20, -9}, " z -9 mm; closed"},
        {{31, 20, 0}, "60 x 40 mm at x 30 y 20 z 0 mm"},
        {{30, 20, -20}, ""},
        {{5, 20, -3}, ""},
        {{0, 20, -10}, ""},
    };
    return all;
}

// The height of what is seen from above where it is lowest, in squares of 2 mm.
double lowest_seen(const std::vector<nurbs::Surface>& surfaces)
{
    constexpr int kColumns = 30;
    constexpr int kRows = 20;
    std::vector<double> tops(kColumns * kRows, -1e9);
    cusp::test::for_places(surfaces, [&](Vec3d point, Vec3d) {
        const int i = std::min(static_cast<int>(point.x / 2), kColumns - 1);
        const int j = std::min(static_cast<int>(point.y / 2), kRows - 1);
        double& top = tops[static_cast<std::size_t>(i + kColumns * j)];
        top = std::max(top, point.z);
    });
    return *std::min_element(tops.begin(), tops.end());
}

void check_closed(const std::string& file, const MissingFace& missing)
{
    std::vector<std::string> notes;
    CHECK(lowest_seen(read_cad_surfaces(file, {}, &notes)) > -9.01);
    if (*missing.said == '\0') {
        LONGS_EQUAL(0, notes.size());
    } else {
        CHECK(lowest_seen(read_cad_model(file).faces) < -19.99);  // as the file is
        LONGS_EQUAL(1, notes.size());
        STRCMP_CONTAINS("faces are missing: 1 hole of the part open above: ",
                        notes.front().c_str());
        STRCMP_CONTAINS(missing.said, notes.front().c_str());
    }
}

}  // namespace

TEST_GROUP(CadOpenFaces) { cusp::test::TemporaryFolder folder; };

TEST(CadOpenFaces, AreClosedWhereAToolWouldFallThrough)
{
    const TopoDS_Shape block = pocketed_block();
    for (const MissingFace& missing : missing_faces()) {
        const TopoDS_Shape rest = faces_without(block, missing.middle);
        const std::string step = folder.file("open.step");
        CHECK(cusp::test::write_step(rest, step));
        check_closed(step, missing);
        const std::string iges = folder.file("open.igs");
        CHECK(cusp::test::write_iges(rest, iges, false));
        check_closed(iges, missing);
    }
}

TEST(CadOpenFaces, AreNoneOfAClosedSolid)
{
    const std::string file = folder.file("closed.step");
    CHECK(cusp::test::write_step(pocketed_block(), file));
    std::vector<std::string> notes;
    read_cad_surfaces(file, {}, &notes);
    LONGS_EQUAL(0, notes.size());
}

TEST(CadOpenFaces, OfASheetHaveAnOuterBorderThatIsNoHole)
{
    const TopoDS_Shape top =
        TopExp_Explorer{BRepPrimAPI_MakeBox(gp_Pnt(0, 0, -20), gp_Pnt(60, 40, 0)).Shape(),
                        TopAbs_FACE}
            .Current();
    const std::string file = folder.file("sheet.step");
    CHECK(cusp::test::write_step(top, file));
    std::vector<std::string> notes;
    read_cad_surfaces(file, {}, &notes);
    LONGS_EQUAL(0, notes.size());
}

TEST(CadOpenFaces, AreInMillimetresFromAllUnits)
{
    const TopoDS_Shape block = pocketed_block();
    for (const char* unit : {"UIN", "MIL", "IN", "FT", "MI", "UM", "MM", "CM", "M", "KM"}) {
        const std::string step = folder.file("unit.step");
        CHECK(cusp::test::write_step(block, step, unit));
        const std::string iges = folder.file("unit.igs");
        CHECK(cusp::test::write_iges(block, iges, true, unit));
        for (const std::string& file : {step, iges}) {
            const Seen seen = seen_from_above(read_surfaces(file));
            DOUBLES_EQUAL_TEXT(60 * 40, seen.area, 2.0, unit);
            DOUBLES_EQUAL_TEXT(-9, seen.low, 1e-2, unit);
        }
    }
}
