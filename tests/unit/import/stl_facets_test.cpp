// Meshes: what is read, what is refused, and that the height field never lies below them.
#include "host_tools/import/stl_facets.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "CppUTest/TestHarness.h"

#include "host_tools/import/height_field.hpp"
#include "host_tools/import/job.hpp"
#include "tests/unit/import/scratch_folder.hpp"

using namespace cusp;
using namespace cusp::host;

namespace {

using Triangle = std::array<Vec3d, 3>;

// As programs write it, least byte first; `count` is what the head announces.
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
    ScratchFolder folder;
    std::string refused(const std::string& text)
    {
        const std::string file = folder.write("m.stl", text);
        return refusal([&] { read_stl(file, 1.0); });
    }
};

TEST(StlFacets, AreReadFromWordsAndFromBytes)
{
    const Facets words = read_stl(folder.write("a.stl", kOneFacet), 25.4);
    LONGS_EQUAL(1, words.triangles.size());
    DOUBLES_EQUAL(254, words.triangles[0][1].x, 1e-9);
    const Facets bytes = read_stl(folder.write("b.stl", binary(sheet(3, wave), 18)), 1.0);
    LONGS_EQUAL(18, bytes.triangles.size());
}

TEST(StlFacets, OfABinaryFileWhoseTitleSaysSolid)
{
    std::string text = binary(sheet(2, wave), 8);
    text.replace(0, 5, "solid");
    LONGS_EQUAL(8, read_stl(folder.write("b.stl", text), 1.0).triangles.size());
}

TEST(StlFacets, CountThoseWithoutArea)
{
    std::vector<Triangle> triangles = sheet(1, wave);
    triangles.push_back({Vec3d{0, 0, 0}, Vec3d{1, 1, 1}, Vec3d{2, 2, 2}});
    const Facets facets = read_stl(folder.write("b.stl", binary(triangles, 3)), 1.0);
    LONGS_EQUAL(2, facets.triangles.size());
    LONGS_EQUAL(1, facets.degenerate);
}

TEST(StlFacets, AreRefusedWhereTheFileIsCutShort)
{
    STRCMP_CONTAINS("9 facets are announced, that is 534 bytes; the file has 484",
                    refused(binary(sheet(2, wave), 9)).c_str());
    const std::string text = kOneFacet;
    STRCMP_CONTAINS("m.stl:6: cut short",
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
    triangles.push_back({Vec3d{0, 0, 5}, Vec3d{0, 4, 5}, Vec3d{4, 0, 5}});  // looks down
    triangles.push_back({Vec3d{20, 0, 0}, Vec3d{40, 0, 0}, Vec3d{20, 20, 0}});
    const HeightField field = height_field({triangles, 0}, 0.01);
    DOUBLES_EQUAL(8, field.overhang_area, 1e-9);
    CHECK(field.loose_share > 0 && field.loose_share < 0.5);
    CHECK(field.open_share > 0.2 && field.open_share < 0.3);
}

TEST(HeightFieldOfAMesh, IsAFloorLikeAnyOther)
{
    const ScratchFolder folder;
    std::vector<std::string> notes;
    const auto surfaces =
        read_surfaces(folder.write("m.STL", binary(sheet(30, wave), 1800)), 1.0, 0.01, &notes);
    LONGS_EQUAL(1, surfaces.size());
    LONGS_EQUAL(0, notes.size());
}
