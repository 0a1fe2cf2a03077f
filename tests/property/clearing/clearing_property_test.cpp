// Passes of random regions: nothing of the region is farther than half a step from all of them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "host_tools/cam/clearing/clearing.hpp"
#include "tests/generators/random_regions.hpp"
#include "tests/support/property_cases.hpp"

// Last: CppUTest redefines new, which the standard headers can not bear.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace clearing;
using namespace offset;

namespace {

constexpr int kRegions = 200;
constexpr double kEnough = 1.01;  // of half a step

// The point farthest from all passes among those at least `wall_clearance` inside the region,
// found by halving squares, to a two hundredth of `enough`. Below `enough` the result may be
// inexact.
class FarthestPlace {
public:
    FarthestPlace(const Region2d& region, const ClearedRegion& cleared, double first, double enough)
        : walls_{region}, passes_{edges_of(paths(cleared))}, first_{first}, apart_{enough}
    {
        search({0.0, 0.0}, 64.0, 0.005 * enough);
    }

    double apart() const { return apart_; }
    Vec2d at() const { return at_; }

private:
    static Region2d paths(const ClearedRegion& cleared)
    {
        Region2d result;
        for (const ClearingPass& pass : cleared.passes) {
            result.contours.push_back(pass.path);
        }
        return result;
    }

    void search(Vec2d centre, double half, double least)
    {
        const double reach = half * std::sqrt(2.0);
        if (passes_.any_nearer(centre, apart_ - reach)) {
            return;
        }
        const double room = walls_.clearance(centre);
        if (room < first_ - reach) {
            return;
        }
        const double apart = passes_.nearest(centre, 1e300);
        if (room >= first_ && apart > apart_) {
            apart_ = apart;
            at_ = centre;
        }
        if (half < least || apart + reach <= apart_) {
            return;
        }
        for (const Vec2d way : {Vec2d{-1, -1}, Vec2d{-1, 1}, Vec2d{1, -1}, Vec2d{1, 1}}) {
            search(centre + way * (0.5 * half), 0.5 * half, least);
        }
    }

    RegionOffset walls_;
    EdgeTree passes_;
    double first_;
    double apart_;
    Vec2d at_{};
};

TEST_GROUP(RandomClearing){};

TEST(RandomClearing, LeavesNoPlaceFartherThanHalfAStepFromAPass)
{
    constexpr unsigned kSeed = 1990;
    Random random{kSeed};
    int far = 0;
    for (int i = 0; i < property_cases(kRegions); ++i) {
        const Region2d region = random_region(random);
        ClearingSettings settings;
        settings.wall_clearance = uniform(random, 1.5, 8.0);
        settings.stepover = settings.wall_clearance * uniform(random, 0.5, 1.9);
        const ClearedRegion cleared = clear_region(region, settings);
        if (cleared.passes.empty()) {
            continue;
        }
        const double half = 0.5 * settings.stepover;
        const FarthestPlace farthest{region, cleared, settings.wall_clearance, kEnough * half};
        if (farthest.apart() > kEnough * half) {
            std::printf(
                "seed %u case %d first %.6g step %.6g: %.4g of half a step at (%.4f, %.4f)\n",
                kSeed, i, settings.wall_clearance, settings.stepover, farthest.apart() / half,
                farthest.at().x, farthest.at().y);
            ++far;
        }
    }
    LONGS_EQUAL(0, far);
}

}  // namespace
}  // namespace cusp::test
