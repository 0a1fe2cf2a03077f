// OBJ files: what is read and refused; polygons are covered by their triangles.
#include "host_tools/job/import/obj_facets.hpp"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "host_tools/job/import/polygon_triangles.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::import;

namespace {

const char* const kFour = "v 0 0 0\nv 10 0 1\nv 10 10 2\nv 0 10 3\n";

Vec3d area_of(const std::array<Vec3d, 3>& t) { return cross(t[1] - t[0], t[2] - t[0]) / 2.0; }

}  // namespace

TEST_GROUP(ObjFacets)
{
    cusp::test::TemporaryFolder folder;
    Facets read(const std::string& text, double unit = 1.0)
    {
        return read_obj(folder.with("m.obj", text), unit);
    }
    std::string refused(const std::string& text)
    {
        return cusp::test::refusal([&] { read(text); });
    }
};

TEST(ObjFacets, TakeVerticesInAllFormsOfAnIndex)
{
    for (const char* const face : {"f 1 2 3\n", "f 1/1 2/2 3/3\n", "f 1/1/1 2/2/2 3/3/3\n",
                                   "f 1//1 2//2 3//3\n", "f -4 -3 -2\n", "f 1 \\\n 2 \\\r\n 3\n"}) {
        const Facets facets = read(std::string{kFour} + face, 25.4);
        LONGS_EQUAL(1, facets.triangles.size());
        DOUBLES_EQUAL(254, facets.triangles[0][2].y, 1e-9);
        DOUBLES_EQUAL(50.8, facets.triangles[0][2].z, 1e-9);
    }
    STRCMP_EQUAL("", read(kFour).unit.c_str());
}

TEST(ObjFacets, PassOverAllElse)
{
    const Facets facets = read(std::string{"# a part\nmtllib a.mtl\no part\ng group\n"} + kFour +
                               "vn 0 0 1\nvt 0 0\nusemtl steel\ns off\nl 1 2\np 1\n"
                               "f 1 2 3 # a comment\nf 1 3 4\nf 1 1 2\n");
    LONGS_EQUAL(2, facets.triangles.size());
    LONGS_EQUAL(1, facets.degenerate);
}

TEST(ObjFacets, AreRefusedWithTheirLine)
{
    STRCMP_CONTAINS("m.obj:5: \"7\" found, a vertex is needed, 1 to 4 so far",
                    refused(std::string{kFour} + "f 1 2 7\n").c_str());
    STRCMP_CONTAINS("m.obj:5: \"0\" found", refused(std::string{kFour} + "f 1 2 0\n").c_str());
    STRCMP_CONTAINS("m.obj:5: a face has 2 corners, at least 3 are needed",
                    refused(std::string{kFour} + "f 1 2\n").c_str());
    STRCMP_CONTAINS("m.obj:1: \"x\" found, a number is needed", refused("v 0 x 0\n").c_str());
    STRCMP_CONTAINS("m.obj:2: cut short: a number is needed", refused("\nv 0 0").c_str());
    STRCMP_CONTAINS("m.obj:1: a corner has y = 1e+30 mm", refused("v 0 1e30 0\n").c_str());
    STRCMP_CONTAINS("a corner has x = nan mm", refused("v nan 0 0\n").c_str());
}

// Star-shaped about the origin, so simple; turned anywhere in space. The oracle is the shoelace.
TEST(ObjFacets, CoverPolygonsExactly)
{
    for (unsigned seed = 1; seed <= 3000; ++seed) {
        std::mt19937_64 random{seed};
        const auto between = [&](double low, double high) {
            return std::uniform_real_distribution<double>{low, high}(random);
        };
        const auto direction = [&] {
            const Vec3d d{between(-1, 1), between(-1, 1), between(0.1, 1)};
            return d / norm(d);
        };
        const int size = 3 + static_cast<int>(random() % 12);
        const Vec3d u = direction();
        Vec3d v = cross(u, direction());
        v = v / norm(v);
        std::vector<Vec3d> corners;
        for (int i = 0; i < size; ++i) {
            const double angle = 2 * 3.141592653589793 * (i + between(0.1, 0.9)) / size;
            const double radius = between(1, 20);
            corners.push_back(radius * std::cos(angle) * u + radius * std::sin(angle) * v);
        }
        Vec3d whole{};
        for (std::size_t i = 0; i < corners.size(); ++i) {
            whole = whole + cross(corners[i], corners[(i + 1) % corners.size()]) / 2.0;
        }
        double sum = 0;
        const auto triangles = polygon_triangles(corners);
        const std::string place = "seed " + std::to_string(seed);
        LONGS_EQUAL_TEXT(size - 2, triangles.size(), place.c_str());
        for (const auto& t : triangles) {
            CHECK_TEXT(dot(area_of(t), whole) > -1e-9 * dot(whole, whole), place.c_str());
            sum += norm(area_of(t));
        }
        DOUBLES_EQUAL_TEXT(norm(whole), sum, 1e-9 * sum, place.c_str());
    }
}
