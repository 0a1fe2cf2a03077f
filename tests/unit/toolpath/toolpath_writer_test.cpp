// Entries, rapids and retracts as written, against their slope, drop and ends.
#include "host_tools/geometry/toolpath/toolpath_writer.hpp"

#include <algorithm>
#include <cmath>

#include "CppUTest/TestHarness.h"

#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

using namespace cusp;
using namespace cusp::toolpath;

namespace {

constexpr double kClearanceZ = 5.0;
constexpr double kRadius = 3.0;
constexpr double kSteepest = 0.053;  // 3 degrees
const std::vector<Vec3d> kRun{{0, 0, -2}, {30, 0, -2}};

const auto kNoRoom = [](Vec2d, double) {
    return std::optional<double>{};
};

struct Written {
    std::vector<ToolMove> moves;
    ToolpathWriter writer;

    explicit Written(EntryKind kind, double max_drop = kUnbounded)
        : writer{moves, {kClearanceZ, kind, kRadius, max_drop}}
    {
        writer.approach({0, 0}, kRapidClearance);
    }
};

// The steepest fall over way in plan of all plunges, and the largest fall between two visits of the
// run's start.
struct Descent {
    double steepest{0.0};
    double largest_trip{0.0};
};

Descent descent_of(const std::vector<ToolMove>& moves, double from)
{
    Descent out;
    Vec3d at{};
    double last = from;
    for (const ToolMove& move : moves) {
        const Vec3d end = end_of(move);
        if (move.kind == MoveKind::kPlunge && end.z < from) {
            double way = 0.0;
            Vec3d before = at;
            for (const Vec3d p : points_of(move, at, 1e-4)) {
                way += norm(in_plan(p) - in_plan(before));
                before = p;
            }
            out.steepest = std::max(out.steepest, (at.z - end.z) / std::max(way, 1e-9));
            if (norm(in_plan(end)) < 1e-9) {
                out.largest_trip = std::max(out.largest_trip, last - end.z);
                last = end.z;
            }
        }
        at = end;
    }
    return out;
}

}  // namespace

TEST_GROUP(ToolpathWriter){};

TEST(ToolpathWriter, RapidsRunAtTheClearanceHeightAndEndAboveTheStock)
{
    Written out{EntryKind::kPlunge};
    LONGS_EQUAL(2, out.moves.size());
    CHECK((end_of(out.moves[0]) == Vec3d{0, 0, kClearanceZ}));
    CHECK((end_of(out.moves[1]) == Vec3d{0, 0, kRapidClearance}));
    out.writer.enter(kRun, 0.0, kNoRoom);
    CHECK((out.writer.at() == kRun.front()));
    LONGS_EQUAL(0, out.writer.steep_plunges());
    out.writer.approach({9, 0}, 8.0);
    LONGS_EQUAL(1, out.writer.retracts());
    CHECK((out.writer.at() == Vec3d{9, 0, kClearanceZ}));
    const std::size_t count = out.moves.size();
    out.writer.retract();
    out.writer.line(MoveKind::kRapid, out.writer.at());
    LONGS_EQUAL(count, out.moves.size());
}

TEST(ToolpathWriter, ARampFallsByThreeDegreesAndEndsAtTheStartAtDepth)
{
    Written out{EntryKind::kRamp};
    out.writer.enter(kRun, 0.0, kNoRoom);
    CHECK((out.writer.at() == kRun.front()));
    const Descent descent = descent_of(out.moves, 0.0);
    CHECK(descent.steepest < kSteepest);
    CHECK(descent.steepest > 0.9 * kSteepest);
    LONGS_EQUAL(0, out.writer.steep_plunges());
}

TEST(ToolpathWriter, NoTripOfARampFallsByMoreThanTheLargestDrop)
{
    Written out{EntryKind::kRamp, 0.5};
    out.writer.enter(kRun, 0.0, kNoRoom);
    const Descent descent = descent_of(out.moves, 0.0);
    CHECK(descent.largest_trip <= 0.5 + 1e-9);
    CHECK(descent.steepest < kSteepest);
}

TEST(ToolpathWriter, AHelixGoesAsLowAsItsFloorARampTheRest)
{
    Written out{EntryKind::kHelix};
    out.writer.enter(kRun, 0.0, [](Vec2d, double radius) {
        DOUBLES_EQUAL(0.5 * kRadius, radius, 1e-12);
        return std::optional{-1.5};
    });
    LONGS_EQUAL(1, out.writer.helices());
    LONGS_EQUAL(0, out.writer.narrow_entries());
    double lowest = 0.0;
    for (const ToolMove& move : out.moves) {
        lowest =
            std::holds_alternative<ArcTo>(move.shape) ? std::min(lowest, end_of(move).z) : lowest;
    }
    DOUBLES_EQUAL(-1.5, lowest, 1e-12);
    CHECK((out.writer.at() == kRun.front()));
    CHECK(descent_of(out.moves, 0.0).steepest < kSteepest);
}

TEST(ToolpathWriter, EntriesWithoutRoomAreCounted)
{
    Written out{EntryKind::kHelix};
    const std::vector<Vec3d> point{{0, 0, -2}, {0.1, 0, -2}};
    out.writer.enter(point, 0.0, kNoRoom);
    LONGS_EQUAL(1, out.writer.narrow_entries());
    LONGS_EQUAL(1, out.writer.steep_plunges());
    CHECK((out.writer.at() == point.front()));
}
