// Ways of a tool that stays down, and how it comes down beside stock.
#include "host_tools/cam/adaptive_clearing/keep_down_links.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace adaptive_clearing;
using namespace offset;

namespace {

// A pocket of 60 x 60 mm, of which a tool of radius 3 has cut a strip 14 mm wide along y = 0.
struct CutStrip {
    CutStrip()
    {
        for (const double y : {-4.0, -2.0, 0.0, 2.0, 4.0}) {
            swept.add(line_edge({-20, y}, {20, y}));
        }
    }

    SweptArea swept{{-30, -30, 30, 30}, 3.0};
    RegionOffset walls{
        Region2d{{{line_edge({-30, -30}, {30, -30}), line_edge({30, -30}, {30, 30}),
                   line_edge({30, 30}, {-30, 30}), line_edge({-30, 30}, {-30, -30})}}}};
    KeepDownLinks links{swept, walls, 3.0};
};

TEST_GROUP(KeepDownLinks){};

TEST(KeepDownLinks, ApproachAStartInStockFromAPlaceWithoutAny)
{
    const CutStrip strip;
    const Vec2d start{0, 4.2};  // 0.2 mm in the stock
    const auto in = strip.links.approach(start);
    CHECK(in.has_value());
    DOUBLES_EQUAL(0, norm(in->end - start), 1e-12);
    DOUBLES_EQUAL(0, strip.swept.engagement(in->start, {1, 0}, 0, 3.2), 1e-9);
    CHECK(norm(in->start - start) < 3.0);
}

TEST(KeepDownLinks, ComeDownOnAPathThatWasCut)
{
    const CutStrip strip;
    CHECK(!strip.links.approach({0, 4}).has_value());
    CHECK(!strip.links.approach({3, 1}).has_value());
}

TEST(KeepDownLinks, HaveNoApproachWhereNoPlaceIsNear)
{
    const CutStrip strip;
    CHECK(!strip.links.approach({0, 20}).has_value());
}

}  // namespace
}  // namespace cusp::test
