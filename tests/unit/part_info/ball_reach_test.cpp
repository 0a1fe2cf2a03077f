// The largest ball, the smallest hollow and the ground of parts whose answers are known.
#include "host_tools/job/part_info/ball_reach.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "host_tools/job/import/part_geometry_reader.hpp"
#include "host_tools/job/part_info/part_info.hpp"
#include "tests/support/box_mesh.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::part_info;
using namespace cusp::test;
using cusp::test::TemporaryFolder;

namespace {

// A point of a profile: distance from the axis, height, weight.
struct ProfilePoint {
    double r, z, w;
};

std::string list(const std::vector<double>& numbers)
{
    std::string out;
    for (const double number : numbers) {
        out += fmt::format("{}{}", out.empty() ? "" : ", ", number);
    }
    return "[" + out + "]";
}

std::vector<double> even_knots(int degree, std::size_t points)
{
    std::vector<double> knots(static_cast<std::size_t>(degree) + 1, 0.0);
    const auto d = static_cast<std::size_t>(degree);
    for (std::size_t k = 1; k * d + 1 < points; ++k) {
        knots.insert(knots.end(), d, static_cast<double>(k));
    }
    knots.insert(knots.end(), d + 1, static_cast<double>((points - 1) / d));
    return knots;
}

std::string surface_json(int degree_v,
                         const std::vector<std::vector<ProfilePoint>>& rows,
                         const std::vector<Vec2d>& ways,
                         const std::vector<double>& way_weights,
                         int degree_u)
{
    std::string all;
    for (const auto& row : rows) {
        std::string points;
        std::vector<double> weights;
        for (std::size_t i = 0; i < ways.size(); ++i) {
            for (const ProfilePoint& p : row) {
                points += fmt::format("{}[{}, {}, {}]", points.empty() ? "" : ", ", p.r * ways[i].x,
                                      p.r * ways[i].y, p.z);
                weights.push_back(p.w * way_weights[i]);
            }
        }
        all += fmt::format(
            "{}{{\"degree_u\": {}, \"degree_v\": {}, \"size_u\": {}, \"size_v\": {}, "
            "\"knotvector_u\": {}, \"knotvector_v\": {}, \"control_points\": {{\"points\": [{}], "
            "\"weights\": {}}}}}",
            all.empty() ? "" : ", ", degree_u, degree_v, ways.size(), row.size(),
            list(even_knots(degree_u, ways.size())), list(even_knots(degree_v, row.size())), points,
            list(weights));
    }
    return fmt::format("{{\"shape\": {{\"type\": \"surface\", \"count\": {}, \"data\": [{}]}}}}",
                       rows.size(), all);
}

// Profiles of degree 2 turned about the z axis, each a surface.
std::string revolved(const std::vector<std::vector<ProfilePoint>>& profiles)
{
    const std::vector<Vec2d> ring{{1, 0},   {1, 1},  {0, 1},  {-1, 1}, {-1, 0},
                                  {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
    std::vector<double> weights;
    for (std::size_t k = 0; k < ring.size(); ++k) {
        weights.push_back(k % 2 == 0 ? 1 : std::sqrt(0.5));
    }
    return surface_json(2, profiles, ring, weights, 2);
}

// An arc of the profile, angles in radians from the r axis.
std::vector<ProfilePoint> arc(double r, double z, double radius, double from, double to)
{
    const double half = (to - from) / 2;
    const double out = radius / std::cos(half);
    const double middle = (from + to) / 2;
    return {{r + radius * std::cos(from), z + radius * std::sin(from), 1},
            {r + out * std::cos(middle), z + out * std::sin(middle), std::cos(half)},
            {r + radius * std::cos(to), z + radius * std::sin(to), 1}};
}

std::vector<ProfilePoint> straight(double r0, double z0, double r1, double z1)
{
    return {{r0, z0, 1}, {(r0 + r1) / 2, (z0 + z1) / 2, 1}, {r1, z1, 1}};
}

PartInfo inspected(const std::string& name, const std::string& text, double tolerance = 0.01)
{
    const TemporaryFolder folder;
    return inspect_part(import::read_part_geometry(folder.with(name, text), 1.0), tolerance);
}

// Half a pipe of n facets along y, its rims level, in a plate.
Triangles pipe(double radius, int n)
{
    Triangles out;
    const auto strip = [&](double x0, double z0, double x1, double z1) {
        add_quad(out, {x0, 0, z0}, {x1, 0, z1}, {x1, 40, z1}, {x0, 40, z0});
    };
    strip(-3 * radius, 0, -radius, 0);
    strip(radius, 0, 3 * radius, 0);
    for (int k = 0; k < n; ++k) {
        const double a = kPi * (1 + static_cast<double>(k) / n);
        const double b = kPi * (1 + static_cast<double>(k + 1) / n);
        strip(radius * std::cos(a), radius * std::sin(a), radius * std::cos(b),
              radius * std::sin(b));
    }
    return out;
}

// A box with a pocket of square corners: 100 x 80 x 20, the pocket 40 x 20 and 8 deep.
Triangles pocketed_box()
{
    Triangles out = box_mesh({-50, -40, -20}, {50, 40, 0});
    out.erase(out.begin(), out.begin() + 2);  // the top
    const Vec3d outer[] = {{-50, -40, 0}, {50, -40, 0}, {50, 40, 0}, {-50, 40, 0}};
    const Vec3d inner[] = {{-20, -10, 0}, {20, -10, 0}, {20, 10, 0}, {-20, 10, 0}};
    for (int k = 0; k < 4; ++k) {
        const int next = (k + 1) % 4;
        const Vec3d down{0, 0, -8};
        add_quad(out, outer[k], outer[next], inner[next], inner[k]);
        add_quad(out, inner[k], inner[next], inner[next] + down, inner[k] + down);
    }
    add_quad(out, {-20, -10, -8}, {20, -10, -8}, {20, 10, -8}, {-20, 10, -8});
    return out;
}

}  // namespace

TEST_GROUP(BallReach){};

TEST(BallReach, ABowlTakesItsOwnBall)
{
    const double rim = kPi * 80 / 180;
    const PartInfo info =
        inspected("bowl.json", revolved({arc(0, 0, 20, -kPi / 2, rim - kPi / 2)}));
    DOUBLES_EQUAL(20, info.hollow->radius, 1e-4);
    CHECK(info.ball->radius.has_value());
    DOUBLES_EQUAL(20, *info.ball->radius, 0.2);
    CHECK(!info.ball->corner);
    DOUBLES_EQUAL(80, info.ground->steepest, 1.0);
    // of a cap: 2 pi R h
    DOUBLES_EQUAL(1, info.ground->area / (2 * kPi * 400 * (1 - std::cos(rim))), 2e-3);
    DOUBLES_EQUAL(-20, info.part.box_low.z, 1e-6);
    DOUBLES_EQUAL(20 * std::sin(rim), info.part.box_high.x, 1e-6);
}

TEST(BallReach, ADomeTakesAnyBall)
{
    const PartInfo info = inspected("dome.json", revolved({arc(0, 0, 20, kPi / 2, 0.3)}));
    CHECK(!info.ball->radius);
    CHECK(!info.hollow);
    DOUBLES_EQUAL(0, info.ground->hidden_area, 1e-9);
}

TEST(BallReach, AFilletedBossTakesTheBallOfItsFillet)
{
    const PartInfo info =
        inspected("boss.json", revolved({straight(40, 0, 13, 0), arc(13, 3, 3, -kPi / 2, -kPi),
                                         straight(10, 3, 10, 12), straight(10, 12, 0, 12)}));
    DOUBLES_EQUAL(3, info.hollow->radius, 1e-4);
    // larger ones by d leave d (sqrt(2) - 1) in the middle of the fillet
    DOUBLES_EQUAL(3 + 0.01 / (std::sqrt(2.0) - 1), *info.ball->radius, 0.03);
    CHECK(!info.ball->corner);
    DOUBLES_EQUAL(90, info.ground->steepest, 0.01);
    CHECK(info.ground->level_at.has_value());
    DOUBLES_EQUAL(12, info.ground->level_at->z, 1e-6);
}

TEST(BallReach, NoBallReachesTheBottomOfACone)
{
    const PartInfo info = inspected("cone.json", revolved({straight(0, -10, 10, 0)}));
    CHECK(info.ball->corner);
    DOUBLES_EQUAL(0, std::hypot(info.ball->at.x, info.ball->at.y), 1e-6);
    DOUBLES_EQUAL(-10, info.ball->at.z, 1e-6);
    // a cone of 45 degrees: R (sqrt(2) - 1) stays
    DOUBLES_EQUAL(0.01 / (std::sqrt(2.0) - 1), *info.ball->radius, 0.001);
    DOUBLES_EQUAL(45, *info.ground->steepest_slope, 0.01);
}

TEST(BallReach, AGrooveOfFacetsTakesTheBallOfItsRadius)
{
    const PartInfo info = inspected("pipe.stl", ascii_stl(pipe(5, 100)));
    DOUBLES_EQUAL(5, *info.ball->radius, 0.05);
    CHECK(!info.ball->corner);
}

// Facets off the groove by more than the tolerance are creases of their own.
TEST(BallReach, CoarseFacetsNeedATolerance)
{
    const double sagitta = 5 * (1 - std::cos(kPi / 20 / 2));
    CHECK(*inspected("pipe.stl", ascii_stl(pipe(5, 20)), sagitta / 4).ball->radius < 3);
    DOUBLES_EQUAL(5, *inspected("pipe.stl", ascii_stl(pipe(5, 20)), 2 * sagitta).ball->radius,
                  0.15);
}

TEST(BallReach, NoBallReachesTheCornersOfAPocket)
{
    const PartInfo info = inspected("pocket.stl", ascii_stl(pocketed_box()));
    CHECK(info.mesh->closed);
    CHECK(info.ball->corner);
    DOUBLES_EQUAL(20, std::abs(info.ball->at.x), 1e-9);
    DOUBLES_EQUAL(10, std::abs(info.ball->at.y), 1e-9);
    DOUBLES_EQUAL(-8, info.ball->at.z, 1e-9);
    // three square walls: R (sqrt(3) - 1) stays
    DOUBLES_EQUAL(0.01 / (std::sqrt(3.0) - 1), *info.ball->radius, 0.0005);
    DOUBLES_EQUAL(0, info.ground->hidden_area, 1e-9);
    DOUBLES_EQUAL(90, info.ground->steepest, 1e-6);
    DOUBLES_EQUAL(100 * 80, info.ground->level_area, 1);
}

// A slot with a round bottom, narrower than its bottom's ball at the top.
TEST(BallReach, AWaistIsTighterThanTheHollowUnderIt)
{
    Triangles part = pipe(5, 400);
    // two sheets over the groove leave 6 mm
    add_quad(part, {-15, 0, 2}, {-3, 0, 2}, {-3, 40, 2}, {-15, 40, 2});
    add_quad(part, {3, 0, 2}, {15, 0, 2}, {15, 40, 2}, {3, 40, 2});
    const PartInfo info = inspected("waist.stl", ascii_stl(part));
    CHECK(*info.ball->radius < 3.01);
    CHECK(info.ground->hidden_area > 0);
}
