// Slivers of a level stand when the next one is entered.
#include "host_tools/cam/adaptive_clearing/standing_slivers.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/cam/adaptive_clearing/adaptive_path_writer.hpp"
#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace adaptive_clearing;
using offset::contains;
using offset::line_edge;
using offset::Region2d;
using toolpath::MoveKind;
using toolpath::ToolMove;
using toolpath::ToolpathWriter;

namespace {

constexpr double kCutter = 3.0;

AdaptivePath path_with_sliver(Vec2d start, Vec2d sliver)
{
    AdaptivePath path;
    path.runs.emplace_back();
    path.runs.front().path = {line_edge(start, start + Vec2d{10.0, 0.0})};
    path.left = {sliver};
    return path;
}

// z of the lowest end of a rapid move.
double lowest_rapid(const std::vector<ToolMove>& moves)
{
    double lowest = kUnbounded;
    for (const ToolMove& move : moves) {
        lowest =
            move.kind == MoveKind::kRapid ? std::min(lowest, toolpath::end_of(move).z) : lowest;
    }
    return lowest;
}

// The same where the path is written at z = -2, -4 and -6, as if each level were cut to its height.
double lowest_rapid_of_three_levels(const AdaptivePath& path)
{
    std::vector<ToolMove> moves;
    ToolpathWriter writer{moves, {5.0, toolpath::EntryKind::kHelix, kCutter}};
    AdaptivePathWriter cutter{writer, {true, 1e-3, false}};
    for (const double z : {0.0, -2.0, -4.0}) {
        cutter.write(path, z, z - 2.0);
        writer.retract();
    }
    return lowest_rapid(moves);
}

}  // namespace

TEST_GROUP(StandingSlivers){};

TEST(StandingSlivers, EntriesBesideThemBeginOverTheirTop)
{
    DOUBLES_EQUAL(1.0, lowest_rapid_of_three_levels(path_with_sliver({0, 0}, {1, 2})), 1e-9);
    DOUBLES_EQUAL(-3.0, lowest_rapid_of_three_levels(path_with_sliver({0, 0}, {1, 4})), 1e-9);
}

TEST(StandingSlivers, HelicesBesideThemBeginOverTheirTop)
{
    AdaptivePath path = path_with_sliver({0, 0}, {1, 2});
    path.runs.front().helix = EntryHelix{{0, 0}, 1.0};
    DOUBLES_EQUAL(1.0, lowest_rapid_of_three_levels(path), 1e-9);
    path.left = {{1, 4}};
    DOUBLES_EQUAL(-3.0, lowest_rapid_of_three_levels(path), 1e-9);
}

TEST(StandingSlivers, TheToolIsOffThemInTheRegionThatIsLeft)
{
    const Region2d square{{{line_edge({0, 0}, {20, 0}), line_edge({20, 0}, {20, 20}),
                            line_edge({20, 20}, {0, 20}), line_edge({0, 20}, {0, 0})}}};
    const Region2d off = off_slivers(square, path_with_sliver({0, 0}, {10, 10}), kCutter);
    for (int i = 0; i < 36; ++i) {
        const double angle = i * 0.17453292519943295;
        const Vec2d out{std::cos(angle), std::sin(angle)};
        CHECK(!contains(off, Vec2d{10, 10} + out * 3.05));
        CHECK(contains(off, Vec2d{10, 10} + out * 4.8));
    }
    LONGS_EQUAL(1, off_slivers(square, {}, kCutter).contours.size());
}

}  // namespace cusp::test
