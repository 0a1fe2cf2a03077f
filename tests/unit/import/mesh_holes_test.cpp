// Holes that a tool from above would fall through are found and closed; borders that are none are not.
#include "host_tools/job/import/mesh_holes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "host_tools/job/import/mesh_borders.hpp"
#include "tests/support/box_mesh.hpp"

using namespace cusp;
using namespace cusp::import;
using cusp::test::add_quad;
using cusp::test::Triangles;

namespace {

using Height = std::function<double(double, double)>;
using Squares = std::set<std::pair<int, int>>;

constexpr int kWide = 10;  // squares of 4 mm
constexpr int kDeep = 8;

double hilly(double x, double y) { return 5 + 2 * std::sin(x / 4) * std::cos(y / 5); }
double even(double, double) { return 12; }
double tilted(double x, double) { return 4 + 0.2 * x; }

Vec3d on(const Height& height, int i, int j)
{
    return {4.0 * i, 4.0 * j, height(4.0 * i, 4.0 * j)};
}

Triangles sheet(const Height& height, const Squares& missing = {})
{
    Triangles out;
    for (int i = 0; i < kWide; ++i) {
        for (int j = 0; j < kDeep; ++j) {
            if (missing.count({i, j}) == 0) {
                add_quad(out, on(height, i, j), on(height, i + 1, j), on(height, i + 1, j + 1),
                         on(height, i, j + 1));
            }
        }
    }
    return out;
}

Vec3d at_ground(Vec3d p) { return {p.x, p.y, 0}; }

// The sheet with walls down to z = 0 that face outwards, without underside.
Triangles open_below(const Height& height, const Squares& missing = {})
{
    std::vector<Vec3d> ring;
    for (int i = 0; i < kWide; ++i) {
        ring.push_back(on(height, i, 0));
    }
    for (int j = 0; j < kDeep; ++j) {
        ring.push_back(on(height, kWide, j));
    }
    for (int i = kWide; i > 0; --i) {
        ring.push_back(on(height, i, kDeep));
    }
    for (int j = kDeep; j > 0; --j) {
        ring.push_back(on(height, 0, j));
    }
    Triangles out = sheet(height, missing);
    for (std::size_t k = 0; k < ring.size(); ++k) {
        const Vec3d a = ring[k];
        const Vec3d b = ring[(k + 1) % ring.size()];
        add_quad(out, at_ground(a), at_ground(b), b, a);
    }
    return out;
}

Triangles solid(const Height& height, const Squares& missing = {})
{
    Triangles out = open_below(height, missing);
    for (const auto& t : sheet([](double, double) { return 0.0; })) {
        out.push_back({t[0], t[2], t[1]});
    }
    return out;
}

Triangles turned(Triangles triangles)
{
    for (auto& t : triangles) {
        std::swap(t[1], t[2]);
    }
    return triangles;
}

// Corners that belong to one facet each, and differ by up to `by`.
Triangles shaken(Triangles triangles, double by)
{
    constexpr unsigned kSeed = 7;
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> shift{-by, by};
    for (auto& t : triangles) {
        for (Vec3d& p : t) {
            p = p + Vec3d{shift(random), shift(random), shift(random)};
        }
    }
    return triangles;
}

Squares all_squares()
{
    Squares all;
    for (int i = 0; i < kWide; ++i) {
        for (int j = 0; j < kDeep; ++j) {
            all.insert({i, j});
        }
    }
    return all;
}

void check_none(const Triangles& mesh) { UNSIGNED_LONGS_EQUAL(0, holes_from_above(mesh).size()); }

// One hole of that box, closed: none is left with the cover.
void check_one(Triangles mesh, Vec3d middle, Vec3d size, double tolerance = 1e-9)
{
    const std::vector<MeshHole> holes = holes_from_above(mesh);
    UNSIGNED_LONGS_EQUAL(1, holes.size());
    for (unsigned axis = 0; axis < 3; ++axis) {
        DOUBLES_EQUAL(middle[axis], holes[0].middle[axis], tolerance);
        DOUBLES_EQUAL(size[axis], holes[0].size[axis], tolerance);
    }
    const auto& cover = holes[0].cover;
    mesh.insert(mesh.end(), cover.begin(), cover.end());
    check_none(mesh);
}

std::vector<Vec3d> circle(int corners, double z)
{
    std::vector<Vec3d> out;
    for (int k = 0; k < corners; ++k) {
        const double angle = 2 * M_PI * k / corners;
        out.push_back({20 + 8 * std::cos(angle), 16 + 8 * std::sin(angle), z});
    }
    return out;
}

// A plate with a round pocket; its top, wall and floor have circles of so many corners.
Triangles round_pocket(int top, int wall, int floor)
{
    Triangles out;
    const std::vector<Vec3d> rim = circle(top, 12);
    const auto outer = [](Vec3d p) {  // on the square round the plate
        const double longest = std::max(std::abs(p.x - 20), std::abs(p.y - 16));
        return Vec3d{20 + (p.x - 20) * 16 / longest, 16 + (p.y - 16) * 16 / longest, p.z};
    };
    for (std::size_t k = 0; k < rim.size(); ++k) {
        const Vec3d a = rim[k];
        const Vec3d b = rim[(k + 1) % rim.size()];
        add_quad(out, a, outer(a), outer(b), b);
    }
    const std::vector<Vec3d> low = circle(wall, 4);
    const std::vector<Vec3d> high = circle(wall, 12);
    for (std::size_t k = 0; k < low.size(); ++k) {
        const std::size_t next = (k + 1) % low.size();
        add_quad(out, low[next], low[k], high[k], high[next]);
    }
    const std::vector<Vec3d> ground = circle(floor, 4);
    for (std::size_t k = 0; k < ground.size(); ++k) {
        out.push_back({Vec3d{20, 16, 4}, ground[k], ground[(k + 1) % ground.size()]});
    }
    return out;
}

}  // namespace

TEST_GROUP(MeshHoles){};

TEST(MeshHoles, SoundSolidsAndSheetsHaveNone)
{
    for (const Height& height : {Height{hilly}, Height{even}, Height{tilted}}) {
        check_none(solid(height));
        check_none(sheet(height));
        check_none(turned(sheet(height)));
        check_none(open_below(height));
    }
}

TEST(MeshHoles, AHoleInASolidsTopOnASlopeAndInASheetIsClosed)
{
    const Squares middle{{4, 3}, {5, 3}};
    check_one(solid(even, middle), {20, 14, 12}, {8, 4, 0});
    check_one(solid(tilted, middle), {20, 14, 8}, {8, 4, 1.6});
    check_one(open_below(tilted, middle), {20, 14, 8}, {8, 4, 1.6});
    check_one(sheet(tilted, middle), {20, 14, 8}, {8, 4, 1.6});
    check_one(turned(sheet(tilted, middle)), {20, 14, 8}, {8, 4, 1.6});
}

TEST(MeshHoles, AMissingFacetIsClosed)
{
    Triangles mesh = solid(even);
    mesh.erase(mesh.begin() + 2 * (4 * kDeep + 3));
    check_one(mesh, {18, 14, 12}, {4, 4, 0});
}

TEST(MeshHoles, SeveralAreFoundTheLargestFirst)
{
    const std::vector<MeshHole> holes = holes_from_above(solid(hilly, {{2, 2}, {7, 4}, {7, 5}}));
    UNSIGNED_LONGS_EQUAL(2, holes.size());
    DOUBLES_EQUAL(30, holes[0].middle.x, 1e-9);
    DOUBLES_EQUAL(8, holes[0].size.y, 1e-9);
    DOUBLES_EQUAL(10, holes[1].middle.x, 1e-9);
}

TEST(MeshHoles, AHoleAtTheRimOfASolidIsClosed)
{
    check_one(solid(even, {{0, 3}}), {2, 14, 12}, {4, 4, 0});
    check_one(solid(even, {{0, 0}}), {2, 2, 12}, {4, 4, 0});
    check_one(solid(even, all_squares()), {20, 16, 12}, {40, 32, 0});
}

TEST(MeshHoles, ANotchInTheOuterBorderOfASheetIsPartOfIt)
{
    check_none(sheet(hilly, {{0, 3}}));
    check_none(sheet(hilly, {{0, 0}, {1, 0}}));
    // the second square meets the notch at one corner
    const std::vector<MeshHole> holes = holes_from_above(sheet(hilly, {{0, 3}, {1, 2}}));
    UNSIGNED_LONGS_EQUAL(1, holes.size());
    DOUBLES_EQUAL(6, holes[0].middle.x, 1e-9);
    DOUBLES_EQUAL(10, holes[0].middle.y, 1e-9);
}

TEST(MeshHoles, CornersThatAreNotSharedAreNoHoles)
{
    check_none(shaken(solid(hilly), 1e-3));
    check_none(shaken(sheet(hilly), 1e-3));
    check_one(shaken(solid(even, {{4, 3}}), 1e-3), {18, 14, 12}, {4, 4, 0}, 5e-3);
}

TEST(MeshHoles, AThinCrackIsNoneAndAWideOneIs)
{
    const auto cracked = [](double width) {
        Triangles mesh = sheet(tilted);
        for (auto& t : mesh) {
            const bool right = t[0].x + t[1].x + t[2].x > 60;
            for (Vec3d& p : t) {
                p.x += right && p.x == 20 && p.y > 2 && p.y < 30 ? width : 0;
            }
        }
        return mesh;
    };
    check_none(cracked(1e-4));
    check_none(cracked(0.02));
    UNSIGNED_LONGS_EQUAL(1, holes_from_above(cracked(0.5)).size());
}

TEST(MeshHoles, EdgesThatMeetOthersBetweenTheirCornersAreSewn)
{
    // the top's squares against one large facet pair of the underside and of each wall
    Triangles mesh = sheet(even);
    Triangles box = test::box_mesh({0, 0, 0}, {40, 32, 12});
    mesh.insert(mesh.end(), box.begin() + 2, box.end());
    UNSIGNED_LONGS_EQUAL(0, border_loops(mesh).size());
    Triangles open = sheet(even, {{4, 3}});
    open.insert(open.end(), box.begin() + 2, box.end());
    check_one(open, {18, 14, 12}, {4, 4, 0});
}

TEST(MeshHoles, PocketsOfFacesThatDoNotShareCornersStayOpen)
{
    check_none(round_pocket(32, 32, 32));
    check_none(round_pocket(48, 96, 64));
}

TEST(MeshHoles, AMissingFloorIsClosedAtItsHeight)
{
    Triangles mesh = round_pocket(32, 32, 32);
    mesh.resize(mesh.size() - 32);
    // a part below, so that the floor is not the mesh's lowest place
    const Triangles below = test::box_mesh({0, 0, 0}, {40, 32, 1});
    mesh.insert(mesh.end(), below.begin(), below.end());
    check_one(mesh, {20, 16, 4}, {16, 16, 0});
}

TEST(MeshHoles, AThroughHoleOfAPartWithoutUndersideStaysOpen)
{
    Triangles mesh = round_pocket(32, 32, 32);
    mesh.resize(mesh.size() - 32);
    check_none(mesh);
}

TEST(MeshHoles, HolesUnderOtherFacetsAreNoneFromAbove)
{
    Triangles mesh = solid(even);
    const Triangles under = sheet(tilted, {{4, 3}});
    mesh.insert(mesh.end(), under.begin(), under.end());
    check_none(mesh);
}

TEST(MeshHoles, AreNamedWithPlaceAndSizeAndClosedForPlanners)
{
    Triangles mesh = solid(even, {{4, 3}});
    const std::size_t facets = mesh.size();
    std::vector<std::string> notes;
    cover_holes("p.stl", mesh, notes);
    UNSIGNED_LONGS_EQUAL(facets + 2, mesh.size());
    UNSIGNED_LONGS_EQUAL(1, notes.size());
    CHECK(notes[0].find("p.stl: facets are missing: 1 hole of the part open above: "
                        "4 x 4 mm at x 18 y 14 z 12 mm") == 0);
    cover_holes("p.stl", mesh, notes);
    UNSIGNED_LONGS_EQUAL(1, notes.size());
}
