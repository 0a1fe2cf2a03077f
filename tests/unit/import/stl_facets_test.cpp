// Meshes: what is read, what is refused, and that the height field never lies below them.
#include "host_tools/job/import/stl_facets.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "CppUTest/TestHarness.h"

#include "host_tools/job/import/facet_groups.hpp"
#include "host_tools/job/import/height_field.hpp"
#include "host_tools/job/import/import.hpp"
#include "host_tools/job/import/mesh_file.hpp"
#include "host_tools/job/import/mesh_patches.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::nurbs;

namespace {

using Triangle = std::array<Vec3d, 3>;

// Binary STL, least byte first; `count` is the number in the header.
std::string binary(const std::vector<Triangle>& triangles, std::uint32_t count)
{
    std::string out(80, ' ');
    const auto put = [&](std::uint32_t word) {
        for (int i = 0; i < 4; ++i) {
            out += static_cast<char>(word >> (8 * i) & 0xffU);
        }
    };
    put(count);
    for (const Triangle& t : triangles) {
        put(0), put(0), put(0);
        for (const Vec3d& p : t) {
            for (const double value : {p.x, p.y, p.z}) {
                const auto number = static_cast<float>(value);
                std::uint32_t word = 0;
                std::memcpy(&word, &number, sizeof word);
                put(word);
            }
        }
        out += std::string(2, '\0');
    }
    return out;
}

// A square sheet of 2 n^2 triangles over [0, 20]^2.
std::vector<Triangle> sheet(int n, double (*height)(double, double))
{
    std::vector<Triangle> out;
    const auto corner = [&](int i, int j) {
        const double x = 20.0 * i / n;
        const double y = 20.0 * j / n;
        return Vec3d{x, y, height(x, y)};
    };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            out.push_back({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
            out.push_back({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
        }
    }
    return out;
}

double wave(double x, double y) { return 2 * std::sin(0.4 * x) * std::cos(0.3 * y); }
double level(double /*x*/, double /*y*/) { return 1; }
double step(double x, double /*y*/) { return x > 10.5 ? 3 : 0; }

// Least of surface - mesh over points inside the triangles.
double least_room(const HeightField& field, const std::vector<Triangle>& triangles)
{
    double least = std::numeric_limits<double>::infinity();
    for (const Triangle& t : triangles) {
        for (int k = 0; k <= 20; ++k) {
            const double a = (k % 6) / 5.0;
            const double b = (1 - a) * (k / 6) / 3.0;
            const Vec3d p = t[0] + a * (t[1] - t[0]) + b * (t[2] - t[0]);
            least = std::min(least, point_at(field.surface, p.x - field.surface.points[0].x,
                                             p.y - field.surface.points[0].y)
                                            .z -
                                        p.z);
        }
    }
    return least;
}

const char* const kOneFacet =
    "solid a part\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 10 0 0\n"
    "   vertex 0 10 2\n  endloop\n endfacet\nendsolid a part\n";

}  // namespace

TEST_GROUP(StlFacets)
{
    cusp::test::TemporaryFolder folder;
    std::string refused(const std::string& text)
    {
        const std::string file = folder.with("m.stl", text);
        return cusp::test::refusal([&] { read_facets(file, 1.0); });
    }
};

TEST(StlFacets, AreReadFromWordsAndFromBytes)
{
    const Facets words = read_stl(folder.with("a.stl", kOneFacet), 25.4);
    LONGS_EQUAL(1, words.triangles.size());
    DOUBLES_EQUAL(254, words.triangles[0][1].x, 1e-9);
    const Facets bytes = read_stl(folder.with("b.stl", binary(sheet(3, wave), 18)), 1.0);
    LONGS_EQUAL(18, bytes.triangles.size());
}

TEST(StlFacets, OfABinaryFileWhoseTitleSaysSolid)
{
    std::string text = binary(sheet(2, wave), 8);
    text.replace(0, 5, "solid");
    LONGS_EQUAL(8, read_stl(folder.with("b.stl", text), 1.0).triangles.size());
}

TEST(StlFacets, CountThoseWithoutArea)
{
    std::vector<Triangle> triangles = sheet(1, wave);
    triangles.push_back({Vec3d{0, 0, 0}, Vec3d{1, 1, 1}, Vec3d{2, 2, 2}});
    const Facets facets = read_stl(folder.with("b.stl", binary(triangles, 3)), 1.0);
    LONGS_EQUAL(2, facets.triangles.size());
    LONGS_EQUAL(1, facets.degenerate);
}

TEST(StlFacets, AreRefusedWhereTheFileIsCutShort)
{
    STRCMP_CONTAINS("9 facets need 534 bytes; the file has 484",
                    refused(binary(sheet(2, wave), 9)).c_str());
    const std::string text = kOneFacet;
    STRCMP_CONTAINS("m.stl:6: truncated",
                    refused(text.substr(0, text.find("   vertex 0 10"))).c_str());
    STRCMP_CONTAINS("no STL", refused("solder").c_str());
    STRCMP_CONTAINS("no facet with an area", refused("solid x\nendsolid x\n").c_str());
    STRCMP_CONTAINS("4 mm wide in x and 0 mm in y",
                    refused(binary({{Vec3d{0, 2, 0}, Vec3d{4, 2, 0}, Vec3d{0, 2, 3}}}, 1)).c_str());
}

TEST(StlFacets, AreRefusedWithACoordinateThatIsNoNumber)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    STRCMP_CONTAINS(
        "facet 1: a corner has z = nan mm",
        refused(binary({{Vec3d{0, 0, nan}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}}}, 1)).c_str());
    std::string text = kOneFacet;
    text.replace(text.find("10 2"), 4, "ten 2");
    STRCMP_CONTAINS("m.stl:6: \"ten\" found, a number is needed", refused(text).c_str());
}

TEST_GROUP(HeightFieldOfAMesh){};

TEST(HeightFieldOfAMesh, LiesNowhereBelowIt)
{
    for (double (*height)(double, double) : {wave, step}) {
        const std::vector<Triangle> triangles = sheet(40, height);
        const HeightField field = height_field({triangles, 0}, 0.01);
        CHECK(least_room(field, triangles) >= -1e-9);
    }
}

TEST(HeightFieldOfAMesh, FollowsASmoothOneToTheTolerance)
{
    const HeightField field = height_field({sheet(60, wave), 0}, 0.01);
    CHECK(field.lift <= 0.01);
    DOUBLES_EQUAL(0, field.loose_share, 0);
    DOUBLES_EQUAL(0, field.overhang_area, 0);
}

TEST(HeightFieldOfAMesh, ReportsStepsOverhangsAndOpenGround)
{
    std::vector<Triangle> triangles = sheet(40, step);
    triangles.push_back({Vec3d{0, 0, 5}, Vec3d{0, 4, 5}, Vec3d{4, 0, 5}});  // faces down
    triangles.push_back({Vec3d{20, 0, 0}, Vec3d{40, 0, 0}, Vec3d{20, 20, 0}});
    const HeightField field = height_field({triangles, 0}, 0.01);
    DOUBLES_EQUAL(8, field.overhang_area, 1e-9);
    CHECK(field.loose_share > 0 && field.loose_share < 0.5);
    CHECK(field.open_share > 0.2 && field.open_share < 0.3);
}

TEST(HeightFieldOfAMesh, IsAFloorLikeAnyOther)
{
    const cusp::test::TemporaryFolder folder;
    std::vector<std::string> notes;
    const auto surfaces =
        read_surfaces(folder.with("m.STL", binary(sheet(30, wave), 1800)), 1.0, 0.01, &notes);
    LONGS_EQUAL(1, surfaces.size());
    LONGS_EQUAL(1, notes.size());
    STRCMP_CONTAINS("covered by 1 surface, nowhere below them", notes.front().c_str());
}

namespace {

void add_quad(std::vector<Triangle>& out, Vec3d a, Vec3d b, Vec3d c, Vec3d d)
{
    out.push_back({a, b, c});
    out.push_back({a, c, d});
}

// A box without a bottom; its upper side is smaller by `draft` all round.
void add_box(std::vector<Triangle>& out, Vec2d low, Vec2d high, double z0, double z1, double draft)
{
    const std::array<Vec3d, 4> foot{
        {{low.x, low.y, z0}, {high.x, low.y, z0}, {high.x, high.y, z0}, {low.x, high.y, z0}}};
    const std::array<Vec3d, 4> head{{{low.x + draft, low.y + draft, z1},
                                     {high.x - draft, low.y + draft, z1},
                                     {high.x - draft, high.y - draft, z1},
                                     {low.x + draft, high.y - draft, z1}}};
    add_quad(out, head[0], head[1], head[2], head[3]);
    for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t next = (k + 1) % 4;
        add_quad(out, foot[k], foot[next], head[next], head[k]);
    }
}

}  // namespace

TEST_GROUP(MeshPatchesOfAMesh){};

TEST(MeshPatchesOfAMesh, AreThePlanesOfABoxOnAPlateAndNoWalls)
{
    std::vector<Triangle> triangles;
    add_box(triangles, {0, 0}, {30, 20}, -5, 0, 0);
    add_box(triangles, {8, 5}, {15, 12}, 0, 4, 0);
    const auto patches = mesh_patches({triangles, 0}, 0.01);
    CHECK(patches.has_value());
    LONGS_EQUAL(2, patches->surfaces.size());
    DOUBLES_EQUAL(0, patches->lift, 0);
    const Surface& top = patches->surfaces[1];
    CHECK(top.trims.empty());  // the domain is the rectangle
    DOUBLES_EQUAL(4, point_at(top, top.u_begin(), top.v_end()).z, 1e-9);
    DOUBLES_EQUAL(8, point_at(top, top.u_begin(), top.v_end()).x, 1e-9);
}

TEST(MeshPatchesOfAMesh, KeepDraftedWallsAsPlanesInTheirOwnDomain)
{
    std::vector<Triangle> triangles;
    add_box(triangles, {0, 0}, {10, 10}, 0, 8, 0.4);
    const auto patches = mesh_patches({triangles, 0}, 0.01);
    LONGS_EQUAL(5, patches->surfaces.size());
    for (std::size_t k = 1; k < 5; ++k) {
        const Surface& wall = patches->surfaces[k];
        const double long_way = std::hypot(8, 0.4);
        DOUBLES_EQUAL(10, wall.u_end() - wall.u_begin(), 1e-9);
        DOUBLES_EQUAL(long_way, wall.v_end() - wall.v_begin(), 1e-9);
        LONGS_EQUAL(1, wall.trims.size());
        CHECK(upward_normal(derivatives_at(wall, wall.u_begin(), wall.v_begin())).z > 0.04);
    }
}

TEST(MeshPatchesOfAMesh, LieNowhereBelowACurvedLidAndEndWhereItEnds)
{
    std::vector<Triangle> triangles = sheet(40, wave);
    // A triangle of the sheet is left out: a hole.
    triangles.erase(triangles.begin() + 1000);
    const auto patches = mesh_patches({triangles, 0}, 0.01);
    LONGS_EQUAL(1, patches->surfaces.size());
    const Surface& lid = patches->surfaces.front();
    LONGS_EQUAL(2, lid.trims.size());
    CHECK(patches->lift <= 0.01);
    for (const Triangle& t : triangles) {
        const Vec3d middle = (t[0] + t[1] + t[2]) / 3.0;
        const double over =
            point_at(lid, lid.u_begin() + middle.x, lid.v_begin() + middle.y).z - middle.z;
        CHECK(over >= -1e-9);
        CHECK(over <= 0.05);
    }
}

TEST(MeshPatchesOfAMesh, AreNoneWhereFacetsRunAgainstEachOther)
{
    std::vector<Triangle> triangles = sheet(4, level);
    std::swap(triangles[10][0], triangles[10][1]);
    // That one faces down: it is left out, and a hole is left.
    const auto groups = facet_groups({triangles, 0});
    CHECK(groups.has_value());
    LONGS_EQUAL(2, groups->front().loops.size());
    // Two facets on the same side of an edge do run against each other.
    std::vector<Triangle> doubled = sheet(2, level);
    doubled.push_back({doubled[0][0], doubled[0][1], doubled[0][2] + Vec3d{0, -0.5, 0.1}});
    CHECK(!facet_groups({doubled, 0}).has_value());
}
