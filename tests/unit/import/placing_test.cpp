// Parts scaled, turned and moved: against corners turned by hand, and the box that an origin asks for.
#include "host_tools/job/import/placing.hpp"

#include <cmath>
#include <random>

#include "CppUTest/TestHarness.h"

#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/job/import/import.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::import;

namespace {

// A wedge of 40 x 20 x 10 from its own corner at (5, 6, 7); the file's z points up.
const char* const kWedge =
    "v 5 6 7\nv 45 6 7\nv 45 26 7\nv 5 26 7\nv 5 6 17\nv 5 26 17\n"
    "f 4 3 2 1\nf 5 2 3 6\nf 1 2 5\nf 4 6 3\nf 1 5 6 4\n";

const char* const kJob =
    "[tool]\nshape = \"ball\"\ndiameter = 4\n[cutting]\nfeed = 500\n"
    "[[operation]]\nstrategy = \"adaptive_isocurve\"\nfloor = [\"w.obj\"]\nscallop = 0.1\n";

void check_at(Vec3d wanted, Vec3d found)
{
    DOUBLES_EQUAL(wanted.x, found.x, 1e-9);
    DOUBLES_EQUAL(wanted.y, found.y, 1e-9);
    DOUBLES_EQUAL(wanted.z, found.z, 1e-9);
}

}  // namespace

TEST_GROUP(Placing)
{
    cusp::test::TemporaryFolder folder;
    job::Job read(const std::string& keys)
    {
        folder.with("w.obj", kWedge);
        return read_job(folder.with("job.toml", kJob + keys), cusp::strategies::all());
    }
    PartExtent box(const std::string& keys)
    {
        return extent_of_triangles(read(keys).operations[0].part.mesh);
    }
    std::string refused(const std::string& keys)
    {
        return cusp::test::refusal([&] { read(keys); });
    }
    void check_box(Vec3d low, Vec3d high, const std::string& keys)
    {
        const PartExtent found = box(keys);
        check_at(low, found.low);
        check_at(high, found.high);
    }
};

// The axis that points up becomes z; a right hand stays one.
TEST(Placing, TurnsAnyAxisUp)
{
    for (const std::string& up : kUpAxes) {
        Placing placing;
        placing.up = up;
        const Similarity turn = turn_of(placing);
        Vec3d axis{};
        axis[static_cast<unsigned>(up[1] - 'x')] = up[0] == '+' ? 1 : -1;
        check_at({0, 0, 1}, turn.of(axis));
        check_at(turn.axes[2], cross(turn.axes[0], turn.axes[1]));
    }
}

// Against the matrices of the three turns, multiplied out by hand.
TEST(Placing, TurnsAboutXThenYThenZ)
{
    std::mt19937_64 random{1};
    std::uniform_real_distribution<double> degrees{-360, 360};
    std::uniform_real_distribution<double> place{-10, 10};
    for (int k = 0; k < 2000; ++k) {
        Placing placing;
        placing.scale = 1 + std::abs(place(random));
        placing.rotate = {degrees(random), degrees(random), degrees(random)};
        const Vec3d p{place(random), place(random), place(random)};
        const Vec3d t = placing.rotate * (3.141592653589793 / 180);
        Vec3d q = placing.scale * p;
        q = {q.x, std::cos(t.x) * q.y - std::sin(t.x) * q.z,
             std::sin(t.x) * q.y + std::cos(t.x) * q.z};
        q = {std::cos(t.y) * q.x + std::sin(t.y) * q.z, q.y,
             -std::sin(t.y) * q.x + std::cos(t.y) * q.z};
        q = {std::cos(t.z) * q.x - std::sin(t.z) * q.y, std::sin(t.z) * q.x + std::cos(t.z) * q.y,
             q.z};
        check_at(q, turn_of(placing).of(p));
    }
}

TEST(Placing, OfNoneLeavesTheFile) { check_box({5, 6, 7}, {45, 26, 17}, ""); }

TEST(Placing, PutsTheOriginWhereItIsAskedFor)
{
    check_box({0, 0, -10}, {40, 20, 0}, "[placing]\norigin = \"corner\"\n");
    check_box({-20, -10, -10}, {20, 10, 0}, "[placing]\norigin = \"centre\"\n");
    check_box({5, 6, -10}, {45, 26, 0}, "[placing]\norigin = \"top\"\n");
}

TEST(Placing, ScalesTurnsAndMovesInThatOrder)
{
    // twice as large, its y up: (x, y, z) to (x, -z, y); a quarter turn; its corner to (1, 2, 3)
    check_box({1, 2, 3 - 40}, {21, 82, 3},
              "[placing]\nscale = 2\nup = \"+y\"\nrotate = 90\norigin = \"corner\"\n"
              "move = [1, 2, 3]\n");
    check_box({5, 6, 8}, {45, 26, 18}, "[placing]\nmove = [0, 0, 1]\n");
}

// Files of one placing keep their relative positions; a file with its own placing is measured alone.
TEST(Placing, KeepsTheFilesOfOnePlacingTogether)
{
    folder.with("a.obj", "v 0 0 0\nv 10 0 0\nv 0 10 2\nf 1 2 3\n");
    folder.with("b.obj", "v 20 0 0\nv 30 0 0\nv 20 10 4\nf 1 2 3\n");
    const std::string job =
        "[tool]\nshape = \"ball\"\ndiameter = 4\n[cutting]\nfeed = 500\n"
        "[[operation]]\nstrategy = \"adaptive_isocurve\"\nfloor = [\"a.obj\", \"b.obj\"]\n"
        "scallop = 0.1\n";
    const auto mesh = [&](const std::string& keys) {
        return read_job(folder.with("job.toml", job + keys), cusp::strategies::all())
            .operations[0]
            .part.mesh;
    };
    const auto together = mesh("[placing]\norigin = \"centre\"\n");
    check_at({-15, -5, -4}, together[0][0]);
    check_at({5, -5, -4}, together[1][0]);
    const auto apart =
        mesh("[[placing]]\nfile = \"b.obj\"\norigin = \"corner\"\n[[placing]]\nscale = 3\n");
    check_at({30, 0, 0}, apart[0][1]);
    check_at({0, 0, -4}, apart[1][0]);
}

// Drawings follow: scaled, turned about z and moved, but never turned up.
TEST(Placing, TakesDrawingsAlong)
{
    folder.with("floor.json", R"({"shape": {"type": "surface", "count": 1, "data": [{
        "degree_u": 1, "degree_v": 1, "size_u": 2, "size_v": 2,
        "knotvector_u": [0, 0, 1, 1], "knotvector_v": [0, 0, 1, 1],
        "control_points": {"points": [[0, 0, 3], [0, 40, 3], [60, 0, 3], [60, 40, 3]]}}]}})");
    folder.with("edge.dxf",
                "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\ncut\n10\n30\n20\n20\n40\n15\n0\n"
                "ENDSEC\n0\nEOF\n");
    const job::Job job = read_job(
        folder.with("job.toml",
                    "[tool]\nshape = \"ball\"\ndiameter = 4\n[cutting]\nfeed = 500\n"
                    "[placing]\nrotate = 90\norigin = \"corner\"\nmove = [100, 0, 0]\n"
                    "[stock]\nmargin = [1, 2]\nmargin_bottom = 4\n"
                    "[[operation]]\nstrategy = \"contour_pocket\"\nfloor = [\"floor.json\"]\n"
                    "boundary = \"edge.dxf#cut\"\nscallop = 0.1\n"),
        cusp::strategies::all());
    // the floor's corner (60, 0) was turned to (0, 60): its box was x -40 to 0, y 0 to 60
    check_at({140, 0, 0}, job.operations[0].part.floor[0].points[0]);
    DOUBLES_EQUAL(105 - 1, (*job.stock_x)[0], 1e-3);
    DOUBLES_EQUAL(135 + 1, (*job.stock_x)[1], 1e-3);
    DOUBLES_EQUAL(15 - 2, (*job.stock_y)[0], 1e-3);
    DOUBLES_EQUAL(-4, *job.stock_bottom, 1e-9);
}

TEST(Placing, MakesTheStockByMargins)
{
    const job::Job job = read("[stock]\nmargin = 2\nmargin_top = 1.5\nmargin_bottom = 3\n");
    DOUBLES_EQUAL(3, (*job.stock_x)[0], 1e-9);
    DOUBLES_EQUAL(47, (*job.stock_x)[1], 1e-9);
    DOUBLES_EQUAL(4, (*job.stock_y)[0], 1e-9);
    DOUBLES_EQUAL(18.5, job.stock_top, 1e-9);
    DOUBLES_EQUAL(4, *job.stock_bottom, 1e-9);
    STRCMP_CONTAINS("margin: is given beside x",
                    refused("[stock]\nmargin = 2\nx = [0, 9]\n").c_str());
    STRCMP_CONTAINS("margin_top: is given beside top",
                    refused("[stock]\nmargin_top = 2\ntop = 20\n").c_str());
    STRCMP_CONTAINS("margin: has 3 numbers", refused("[stock]\nmargin = [1, 2, 3]\n").c_str());
}

// A drawing has sides, and neither top nor bottom.
TEST(Placing, MakesTheSidesOfAPlateByMarginsOfItsDrawing)
{
    folder.with("holes.dxf",
                "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\n0\n10\n30\n20\n20\n40\n2\n0\nCIRCLE\n8\n"
                "0\n10\n70\n20\n-10\n40\n2\n0\nENDSEC\n0\nEOF\n");
    const auto plate = [&](const std::string& stock) {
        return read_job(
            folder.with(
                "plate.toml",
                "[tool]\nshape = \"drill\"\ndiameter = 4\n[cutting]\nfeed = 500\n[stock]\n" +
                    stock +
                    "[[operation]]\nstrategy = \"drill\"\nboundary = \"holes.dxf\"\ndepth = 3\n"),
            cusp::strategies::all());
    };
    const job::Job job = plate("margin = [6, 8]\ntop = 1\nbottom = -5\n");
    DOUBLES_EQUAL(24, (*job.stock_x)[0], 1e-9);
    DOUBLES_EQUAL(76, (*job.stock_x)[1], 1e-9);
    DOUBLES_EQUAL(-18, (*job.stock_y)[0], 1e-9);
    DOUBLES_EQUAL(28, (*job.stock_y)[1], 1e-9);
    STRCMP_CONTAINS("margin_bottom: no operation has a floor",
                    cusp::test::refusal([&] { plate("margin_bottom = 2\n"); }).c_str());
    STRCMP_CONTAINS("margin_top: no operation has a floor",
                    cusp::test::refusal([&] { plate("margin_top = 2\n"); }).c_str());
}

TEST(Placing, IsRefusedWithItsKey)
{
    STRCMP_CONTAINS("other.obj is no file that an operation names",
                    refused("[placing]\nfile = \"other.obj\"\n").c_str());
    STRCMP_CONTAINS("is placed twice", refused("[[placing]]\nfile = \"w.obj\"\n[[placing]]\n"
                                               "file = \"w.obj\"\n")
                                           .c_str());
    STRCMP_CONTAINS("two tables have no file",
                    refused("[[placing]]\nscale = 2\n[[placing]]\nscale = 3\n").c_str());
    STRCMP_CONTAINS("scale", refused("[placing]\nscale = 0\n").c_str());
    STRCMP_CONTAINS("up", refused("[placing]\nup = \"y\"\n").c_str());
    STRCMP_CONTAINS("rotate: has 2 numbers", refused("[placing]\nrotate = [1, 2]\n").c_str());
    STRCMP_CONTAINS("move: a list of numbers is needed", refused("[placing]\nmove = 3\n").c_str());
    STRCMP_CONTAINS("origin", refused("[placing]\norigin = \"left\"\n").c_str());
    STRCMP_CONTAINS("the limit is", refused("[placing]\nscale = 1e6\n").c_str());
}
