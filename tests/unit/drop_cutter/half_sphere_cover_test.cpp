// Caps against directions spread evenly over the half sphere.
#include "host_tools/geometry/drop_cutter/half_sphere_cover.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::drop_cutter;

namespace {

constexpr int kDirections = 1500;
constexpr double kApart = 0.08;  // rad: no direction is farther from one of these
constexpr double kGoldenTurn = 2.39996322972865332;

Vec3d direction_of(int k)
{
    const double z = (k + 0.5) / kDirections;
    const double away = std::sqrt(1 - z * z);
    return {away * std::cos(kGoldenTurn * k), away * std::sin(kGoldenTurn * k), z};
}

// How far a direction is within a cap, at least; negative: outside.
double within(const HalfSphereCover::Cap& cap, Vec3d direction)
{
    return dot(cap.towards, direction) - cap.least;
}

double most_within(const std::vector<HalfSphereCover::Cap>& caps, Vec3d direction)
{
    double most = -2;
    for (const HalfSphereCover::Cap& cap : caps) {
        most = std::max(most, within(cap, direction));
    }
    return most;
}

Vec3d random_unit(std::mt19937& random)
{
    std::normal_distribution<double> any{0, 1};
    const Vec3d a{any(random), any(random), any(random)};
    return a / norm(a);
}

}  // namespace

TEST_GROUP(HalfSphereCover){};

TEST(HalfSphereCover, IsOpenWithoutCapsAndCoveredByTwoHalves)
{
    HalfSphereCover cover;
    CHECK_TRUE(cover.open().has_value());
    CHECK_TRUE(cover.add({{1, 0, 0}, -0.01}));
    CHECK_TRUE(cover.open().has_value());
    CHECK_TRUE(cover.add({{-1, 0, 0}, -0.01}));
    CHECK_FALSE(cover.open().has_value());
}

TEST(HalfSphereCover, LeavesOpenTheCircleWhereTwoCapsMeet)
{
    HalfSphereCover cover;
    CHECK_TRUE(cover.add({{1, 0, 0}, 0}));
    CHECK_TRUE(cover.add({{-1, 0, 0}, 0}));
    const auto open = cover.open();
    CHECK_TRUE(open.has_value());
    DOUBLES_EQUAL(0, open->x, 1e-12);
    // A cap that is tilted by less than a ten-thousandth counts as the untilted part of it.
    CHECK_FALSE(cover.add({{std::cos(5e-5), std::sin(5e-5), 0}, -2e-5}));
    CHECK_TRUE(cover.open().has_value());
    CHECK_TRUE(cover.add({{std::cos(5e-5), std::sin(5e-5), 0}, -1e-4}));
    CHECK_FALSE(cover.open().has_value());
}

TEST(HalfSphereCover, TakesNoCapThatAddsNothing)
{
    HalfSphereCover cover;
    CHECK_TRUE(cover.add({{0, 0, 1}, 0.5}));
    CHECK_FALSE(cover.add({{0, 0, 1}, 0.6}));
    CHECK_FALSE(cover.add({{0, 1, 0}, 1}));
    CHECK_TRUE(cover.add({{0, 0, 1}, 0.4}));
}

// A thin gap between two caps, and one that leaves a point.
TEST(HalfSphereCover, FindsSmallOpenPlaces)
{
    for (const double gap : {1e-2, 1e-4, 1e-6}) {
        HalfSphereCover cover;
        cover.add({{1, 0, 0}, gap});
        cover.add({{-1, 0, 0}, 0.0});
        const auto open = cover.open();
        CHECK_TRUE(open.has_value());
        CHECK_TRUE(open->x >= -1e-12 && open->x <= gap + 1e-12);
    }
}

TEST(HalfSphereCover, AgreesWithDirectionsOfAGrid)
{
    const unsigned seed = 5;
    std::printf("seed %u\n", seed);
    std::mt19937 random{seed};
    std::uniform_real_distribution<double> least{-0.4, 0.5};
    std::uniform_int_distribution<int> count{3, 12};
    int covered = 0;
    int open_ones = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        HalfSphereCover cover;
        std::vector<HalfSphereCover::Cap> caps;
        std::optional<Vec3d> open = cover.open();
        for (int k = count(random); k > 0 && open; --k) {
            CHECK_TRUE(open->z > -1e-9);
            DOUBLES_EQUAL(1, norm(*open), 1e-9);
            CHECK_TRUE(most_within(caps, *open) < 1e-6);
            caps.push_back({random_unit(random), least(random)});
            cover.add(caps.back());
            open = cover.open();
        }
        double worst = 1;
        for (int k = 0; k < kDirections; ++k) {
            worst = std::min(worst, most_within(caps, direction_of(k)));
        }
        covered += open ? 0 : 1;
        open_ones += open ? 1 : 0;
        CHECK_TRUE(open || worst > 0);
        CHECK_TRUE(!open || worst < kApart);
    }
    std::printf("%d covered, %d open\n", covered, open_ones);
    CHECK_TRUE(covered > 50 && open_ones > 50);
}
