// The ground that a job owes, by the areas of its operations.
#include "host_tools/judge/verify/owed_ground.hpp"

#include <cmath>

#include "CppUTest/TestHarness.h"

#include "firmware/base/math.hpp"
#include "tests/support/loops.hpp"

using namespace cusp;
using namespace cusp::job;
using namespace cusp::test;
using namespace cusp::verify;

namespace {

Strategy finishing()
{
    Strategy strategy;
    strategy.name = "finishing";
    return strategy;
}

}  // namespace

TEST_GROUP(OwedGround)
{
    const Strategy finish = finishing();
    Job job;
    OwedGround owed() const { return OwedGround{job}; }
    Operation& add(double least_slope, double most_slope)
    {
        Operation operation;
        operation.strategy = &finish;
        operation.tolerance.scallop = 0.05;
        finish_keys(operation).range.least_slope = least_slope;
        finish_keys(operation).range.most_slope = most_slope;
        job.operations.push_back(operation);
        return job.operations.back();
    }
    bool holds(double x, double slope) const
    {
        return owed().holds({x, 0, -1}, std::cos(slope * kPi / 180));
    }
};

TEST(OwedGround, IsAllOfAPartWithoutAnArea)
{
    add(0, 90);
    add(30, 60);
    CHECK(holds(0, 10));
    CHECK(holds(0, 89));
}

TEST(OwedGround, IsWhatSomeAreaHolds)
{
    add(0, 40);
    add(60, 90);
    CHECK(holds(0, 39));
    CHECK(!holds(0, 41));
    CHECK(!holds(0, 59));
    CHECK(holds(0, 61));
}

TEST(OwedGround, LiesInsideBoundariesAndOutsideIslands)
{
    Operation& operation = add(0, 90);
    operation.outline.boundary = loop_of({{-5, -5}, {5, -5}, {5, 5}, {-5, 5}});
    operation.outline.islands = {loop_of({{1, -1}, {2, -1}, {2, 1}, {1, 1}})};
    CHECK(holds(0, 20));
    CHECK(!holds(1.5, 20));
    CHECK(holds(3, 20));
    CHECK(!holds(6, 20));
}

TEST(OwedGround, IsNotLimitedByAnOperationWithoutAScallop)
{
    add(0, 40).tolerance.scallop.reset();
    add(60, 90);
    CHECK(!holds(0, 39));
    CHECK(holds(0, 61));
}
