// Facets of the vertical parts of faces lie on them, within what they say, and cover them.
#include "host_tools/cam/finishing/vertical_faces.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/math.hpp"
#include "tests/generators/round_walls.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::finishing;
using namespace cusp::nurbs;
using namespace cusp::part_model;
using namespace cusp::test;
using namespace cusp::toolpath;

namespace {

constexpr double kScallop = 0.05;
constexpr double kRadius = 4;  // mm, of walls

std::vector<WallFacet> facets_of(const std::vector<Surface>& faces)
{
    const Tool ball{1, ToolShape::kBall, 3, 3};
    const PartModel model{faces};
    const GougeFreePathFitter path_fitter{model, ball, make_tolerance_band(0.01, true)};
    const ScallopAtPoint places{faces, path_fitter, kScallop, 0};
    return vertical_faces(faces, path_fitter, places, kScallop);
}

double area_of(const std::vector<WallFacet>& facets)
{
    double sum = 0;
    for (const WallFacet& facet : facets) {
        Vec3d twice{};
        for (std::size_t k = 2; k < facet.corners.size(); ++k) {
            twice = twice + cross(facet.corners[k - 1] - facet.corners[0],
                                  facet.corners[k] - facet.corners[0]);
        }
        sum += 0.5 * norm(twice);
    }
    return sum;
}

RoundWall round_wall(double middle_radius, double high_radius)
{
    return {{0, 0},
            {0, 0.5 * kPi, kPi, 1.5 * kPi, 2 * kPi},
            0,
            6,
            {kRadius, middle_radius, high_radius}};
}

}  // namespace

TEST_GROUP(VerticalFaces){};

TEST(VerticalFaces, LeavesAPlaneFaceWhole)
{
    Surface wall = plane_face({{0, 0, 0}, {10, 0, 0}, {10, 0, 5}, {0, 0, 5}}, Vec3d{0, -1, 0});
    CHECK_EQUAL(1, facets_of({wall}).size());
    wall.trims.push_back(loop_of({{3, 1}, {3, 4}, {6, 4}, {6, 1}}));
    const std::vector<WallFacet> facets = facets_of({wall});
    CHECK_EQUAL(4, facets.size());
    DOUBLES_EQUAL(41, area_of(facets), 1e-6);
    for (const WallFacet& facet : facets) {
        DOUBLES_EQUAL(0, facet.off, 1e-12);
    }
}

TEST(VerticalFaces, FollowsACylinderWithinWhatItSays)
{
    const std::vector<WallFacet> facets = facets_of({round_wall(kRadius, kRadius).surface()});
    DOUBLES_EQUAL(2 * kPi * kRadius * 6, area_of(facets), 0.05);
    for (const WallFacet& facet : facets) {
        CHECK(facet.off > 0 && facet.off < 0.06 * kScallop);
        const Vec3d along{-facet.normal.y, facet.normal.x, 0};
        for (const Vec3d& corner : facet.corners) {
            DOUBLES_EQUAL(kRadius, std::hypot(corner.x, corner.y), facet.off);
            // The normal that turns along the facet is that of the cylinder.
            const Vec3d out =
                facet.normal + along * (facet.bend * (dot(corner, along) - facet.middle));
            const Vec3d radial = Vec3d{corner.x, corner.y, 0} / std::hypot(corner.x, corner.y);
            CHECK(norm(cross(out / norm(out), radial)) * kScallop < facet.off);
        }
    }
}

// A barrel is vertical where it is widest, at half its height, in a band about as high as its normal says.
TEST(VerticalFaces, TakesTheBandAtTheEquatorOnly)
{
    constexpr double kBulge = 1;  // control point: half of it at the equator
    const std::vector<WallFacet> facets =
        facets_of({round_wall(kRadius + 2 * kBulge, kRadius).surface()});
    // r(z) = R + 4 b t (1 - t) with t = z / 6: its slope is 8 b / 6 (t - 0.5) = 2 b (z - 3) / 9.
    const double normal = 0.98 * kScallop / 6;
    const double high = 2 * normal * 9 / (2 * kBulge);
    DOUBLES_EQUAL(2 * kPi * (kRadius + kBulge) * high, area_of(facets), 0.25 * area_of(facets));
    CHECK(!facets.empty());
    for (const WallFacet& facet : facets) {
        for (const Vec3d& corner : facet.corners) {
            DOUBLES_EQUAL(3, corner.z, high);
        }
    }
}

TEST(VerticalFaces, FindsNoneWhereNoneStands)
{
    const Surface slope = plane_face({{0, 0, 0}, {10, 0, 0}, {10, 1, 5}, {0, 1, 5}},
                                     Vec3d{0, -5, 1} / std::sqrt(26.0));
    CHECK_EQUAL(0, facets_of({slope}).size());
    CHECK_EQUAL(0, facets_of({round_wall(3.7, 3.2).surface()}).size());
}
