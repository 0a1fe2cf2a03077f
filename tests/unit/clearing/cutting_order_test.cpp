#include "host_tools/cam/clearing/cutting_order.hpp"

#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace clearing;

namespace {

TEST_GROUP(CuttingOrder){};

TEST(CuttingOrder, IsThePrintedOneForTheTreeOfFigure220)
{
    // Parents of the profiles 1 to 23 of the figure; profile n is node n - 1.
    const std::vector<int> parents = {-1, 0, 1, 2,  2,  3,  4,  4,  4,  5,  6, 7,
                                      8,  9, 9, 10, 11, 12, 13, 14, 17, 20, 21};
    const std::vector<int> printed = {23, 22, 21, 18, 13, 9,  17, 12, 8, 16, 11, 7,
                                      5,  20, 15, 19, 14, 10, 6,  4,  3, 2,  1};
    const std::vector<int> order = cutting_order(parents);
    LONGS_EQUAL(printed.size(), order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        LONGS_EQUAL(printed[i], order[i] + 1);
    }
}

}  // namespace
}  // namespace cusp::test
