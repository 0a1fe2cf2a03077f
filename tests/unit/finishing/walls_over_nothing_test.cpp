// Sides of walls beside which a ball rests on nothing, in mm.
#include "host_tools/cam/finishing/walls_over_nothing.hpp"

#include <cmath>

#include "host_tools/cam/finishing/vertical_faces.hpp"
#include "tests/generators/faces_of_mesh.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::finishing;
using namespace cusp::nurbs;
using namespace cusp::part_model;
using namespace cusp::test;
using namespace cusp::toolpath;

namespace {

constexpr double kBallRadius = 1;
constexpr double kSide = 20;  // mm, of a plate

double free_walls(const std::vector<Surface>& faces)
{
    constexpr double kAllowed = 0.05;
    const Tool ball{1, ToolShape::kBall, kBallRadius, kBallRadius};
    const PartModel model{faces};
    const GougeFreePathFitter path_fitter{model, ball, make_tolerance_band(0.01, true)};
    const ScallopAtPoint places{faces, path_fitter, kAllowed, 0};
    return walls_over_nothing(vertical_faces(faces, path_fitter, places, kAllowed), path_fitter);
}

Surface level_plate(double z)
{
    return plane_face({{0, 0, z}, {kSide, 0, z}, {kSide, kSide, z}, {0, kSide, z}}, {0, 0, 1});
}

// A wall over y = `at`.
Surface wall_at(double at, double low, double high)
{
    return plane_face({{0, at, low}, {kSide, at, low}, {kSide, at, high}, {0, at, high}},
                      Vec3d{0, -1, 0});
}

}  // namespace

TEST_GROUP(WallsOverNothing){};

TEST(WallsOverNothing, CountsTheOuterSideOfAWallOnABorder)
{
    DOUBLES_EQUAL(kSide, free_walls({level_plate(0), wall_at(0, 0, 5)}), 1e-9);
    // Two over each other are one.
    DOUBLES_EQUAL(kSide, free_walls({level_plate(0), wall_at(0, 0, 2), wall_at(0, 2, 5)}), 1e-9);
    // The side of a plate, as of a block without a bottom.
    DOUBLES_EQUAL(kSide, free_walls({level_plate(0), wall_at(0, -5, 0)}), 1e-9);
}

TEST(WallsOverNothing, CountsNoneWithinThePart)
{
    DOUBLES_EQUAL(0, free_walls({level_plate(0), wall_at(8, 0, 5)}), 0);
    DOUBLES_EQUAL(0, free_walls({level_plate(0)}), 0);
}

// Over the plate and beyond: beside the latter the ball may still rest on the border.
TEST(WallsOverNothing, CountsThePartOfAWallThatIsBeyondAPlate)
{
    const Vec3d along = Vec3d{1, 1, 0} / std::sqrt(2.0);
    const Vec3d from{4, -10, 0};
    const Vec3d to = from + along * 20;
    const Surface wall = plane_face({from, to, to + Vec3d{0, 0, 3}, from + Vec3d{0, 0, 3}},
                                    Vec3d{along.y, -along.x, 0});
    const double beyond = 10 * std::sqrt(2.0);
    const double both = free_walls({level_plate(0), wall});
    CHECK(both < 2 * beyond);
    CHECK(both > 2 * beyond - 6 * kBallRadius);
}
