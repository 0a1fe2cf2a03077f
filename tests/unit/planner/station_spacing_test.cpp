// Stations along random paths: they meet, reach the end, follow the feed, and hardly depend on how
// the path becomes known.
#include "firmware/planner/station_spacing.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/planner/law_check.hpp"

using namespace cusp;
using namespace cusp::planner;

namespace {

constexpr std::uint64_t kSpacingSeed = 3030;
constexpr int kSpacingCases = 60;
constexpr int kSlicedCases = 120;
constexpr float kStationTime = 0.005F;
constexpr StopChoice kStop{0.016F, 1.0F};

Block arc_block(float radius, float angle, float heading)
{
    Block block{};
    block.shape = BlockShape::kArc;
    block.filter = {4, 2};
    block.arc = {{std::cos(heading), std::sin(heading), 0},
                 {-std::sin(heading), std::cos(heading), 0},
                 {},
                 radius,
                 0,
                 1.0F / (radius * kPathUnitsPerMillimetre)};
    set_length(block, static_cast<std::uint32_t>(radius * angle * kPathUnitsPerMillimetre));
    return block;
}

Block line_block(float length, float heading)
{
    Block block{};
    block.filter = {4, 2};
    const float units = length * kPathUnitsPerMillimetre;
    block.displacement = {static_cast<std::int32_t>(units * std::cos(heading)),
                          static_cast<std::int32_t>(units * std::sin(heading)), 0};
    set_length(block, static_cast<std::uint32_t>(units));
    return block;
}

// Lines and arcs that meet tangentially.
std::vector<Block> any_path(std::mt19937_64& random)
{
    const auto between = [&random](float low, float high) {
        return std::exp(
            std::uniform_real_distribution<float>{std::log(low), std::log(high)}(random));
    };
    std::vector<Block> blocks;
    float heading = 0;
    const std::size_t count = 2 + random() % 30;
    for (std::size_t i = 0; i < count; ++i) {
        if (random() % 2 == 0) {
            blocks.push_back(line_block(between(0.05F, 30.0F), heading));
        } else {
            const float angle = between(0.05F, 1.5F);
            blocks.push_back(arc_block(between(0.3F, 20.0F), angle, heading));
            heading += angle;
        }
    }
    return blocks;
}

// Short lines that turn a little at each joint, and longer ones between.
std::vector<Block> dense_path(std::mt19937_64& random)
{
    std::uniform_real_distribution<float> part{0, 1};
    const float step = 0.12F + 0.2F * part(random);
    const float bend = 0.02F * part(random);
    std::vector<Block> blocks;
    float heading = 0;
    const std::size_t count = 100 + random() % 300;
    for (std::size_t i = 0; i < count; ++i) {
        const float length = random() % 20 == 0 ? 40.0F * step : step;
        blocks.push_back(line_block(length * (0.8F + 0.4F * part(random)), heading));
        heading += bend * (part(random) - 0.3F);
    }
    return blocks;
}

struct Spaced {
    std::vector<Station> stations;
    StopElement start{};
    StopElement stop{};
};

bool are_same(const StopElement& a, const StopElement& b)
{
    return a.length == b.length && a.cap == b.cap;
}

bool are_same(const AxisVecf& a, const AxisVecf& b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

bool are_same(const Station& a, const Station& b)
{
    const auto lanes = [](const LaneVec& one, const LaneVec& other) {
        return are_same(to_vec(one), to_vec(other));
    };
    bool same = a.begin == b.begin && a.travel == b.travel && a.length == b.length &&
                a.cap == b.cap && a.acceleration_at_end == b.acceleration_at_end &&
                lanes(a.moving, b.moving) && lanes(a.kept.always, b.kept.always) &&
                lanes(a.kept.jump, b.kept.jump) && lanes(a.kept.turn, b.kept.turn) &&
                lanes(a.kept.bend, b.kept.bend) &&
                lanes(a.kept.turn_acceleration, b.kept.turn_acceleration) &&
                lanes(a.kept.bend_acceleration, b.kept.bend_acceleration);
    for (unsigned i = 0; i < kPlacesOfCell; ++i) {
        same = same && lanes(a.places[i].first, b.places[i].first) &&
               lanes(a.places[i].second, b.places[i].second) &&
               lanes(a.places[i].third, b.places[i].third);
    }
    return same;
}

bool are_same(const Spaced& a, const Spaced& b)
{
    return are_same(a.start, b.start) && are_same(a.stop, b.stop) &&
           std::equal(
               a.stations.begin(), a.stations.end(), b.stations.begin(), b.stations.end(),
               [](const Station& one, const Station& other) { return are_same(one, other); });
}

// The path is known `burst` blocks at a time; the law keeps up with it, and drops what it has passed.
Spaced space(std::vector<Block>& blocks, std::size_t burst, float feed)
{
    const auto path = std::make_unique<LawPath>();
    StationSpacing spacing{*path};
    spacing.set_limits(MachineLimits{}, kStationTime);
    spacing.begin(kStop, {}, 0);
    spacing.set_stop(kStop);
    Spaced made;
    PathCursor passed;
    std::size_t next = 0;
    bool started = false;
    while (!spacing.finished()) {
        for (std::size_t i = 0; i < burst && next < blocks.size() && !path->full(); ++i) {
            blocks[next].feed = feed * feed;
            blocks[next].centripetal = 1e6F;
            path->append(blocks[next]);
            ++next;
        }
        if (next == blocks.size() && !path->closed()) {
            path->close();
        }
        started = started || spacing.start(made.start);
        Station station;
        while (started && spacing.next(station)) {
            made.stations.push_back(station);
            path->seek(passed, station.begin);
            path->drop_before(passed);
        }
    }
    made.stop = spacing.stop();
    return made;
}

std::int64_t units(float mm)
{
    return static_cast<std::int64_t>(static_cast<double>(mm) * 16e6 + 0.5);
}

}  // namespace

TEST_GROUP(StationSpacing){};
TEST_GROUP(LawCheck){};

TEST(StationSpacing, stations_meet_and_reach_from_element_to_element)
{
    std::mt19937_64 random{kSpacingSeed};
    for (int n = 0; n < kSpacingCases; ++n) {
        const std::string which = "case " + std::to_string(n);
        std::vector<Block> blocks = any_path(random);
        std::int64_t whole = 0;
        for (const Block& block : blocks) {
            whole += block.length;
        }
        const Spaced made = space(blocks, 1 + random() % 8, 100.0F);
        std::int64_t at = units(made.start.length);
        float last = 0.55F * made.start.length;
        for (const Station& station : made.stations) {
            CHECK_TEXT(station.begin == at, which.c_str());
            const float growth = last < 0.002F ? 1.51F : 1.26F;
            CHECK_TEXT(station.length <= growth * last + 1e-6F, which.c_str());
            CHECK_TEXT(station.cap <= 10000.0F, which.c_str());
            CHECK_TEXT(station.length <= 1.01F * kStationTime * 100.0F, which.c_str());
            last = station.length;
            at += station.travel;
        }
        CHECK_TEXT(at == whole - units(made.stop.length), which.c_str());
        CHECK_TEXT(last <= 0.7F * made.stop.length, which.c_str());
    }
}

TEST(StationSpacing, stations_do_not_depend_on_how_the_path_becomes_known)
{
    std::mt19937_64 random{kSpacingSeed + 1};
    for (int n = 0; n < kSlicedCases; ++n) {
        std::vector<Block> blocks = n % 2 == 0 ? any_path(random) : dense_path(random);
        const float feed = n % 3 == 0 ? 8.0F : 80.0F;
        const Spaced at_once = space(blocks, blocks.size(), feed);
        for (const std::size_t burst : {1U, 2U, 7U, 40U}) {
            const std::string which = "case " + std::to_string(n) + ", " + std::to_string(burst);
            CHECK_TEXT(are_same(at_once, space(blocks, burst, feed)), which.c_str());
        }
    }
}

TEST(StationSpacing, a_joint_is_kept_of_the_limits_around_it)
{
    // An arc of 5 mm behind a line: the curvature jumps by 0.2 at 10 mm.
    std::vector<Block> blocks{line_block(10, 0), arc_block(5, 1.5F, 0)};
    const Spaced made = space(blocks, 2, 50.0F);
    const float share = 0.2F / 0.004F / MachineLimits{}.jerk.y;
    unsigned kept = 0;
    for (const Station& station : made.stations) {
        const float from = static_cast<float>(station.begin) / kPathUnitsPerMillimetre;
        const float jump = to_vec(station.kept.jump).y;
        const bool is_near = from < 10.4F && from + station.length > 9.6F;
        CHECK(!is_near || std::fabs(jump - share) < 0.01F * share);
        const bool is_far = from > 11.5F || from + station.length < 8.5F;
        CHECK(!is_far || jump == 0);
        kept += is_near ? 1U : 0U;
    }
    CHECK(kept > 2);
}

TEST(LawCheck, refuses_a_plan_whose_rows_miss_a_bend)
{
    // The rows of 0.6 mm cells stand on the lines; a bend of 1 mm radius lies between two of them.
    for (const bool has_bend : {false, true}) {
        std::vector<Block> blocks{line_block(10.05F, 0), arc_block(1, 0.2F, 0),
                                  line_block(10, 0.2F)};
        if (!has_bend) {
            blocks = {line_block(20.25F, 0)};
        }
        const auto path = std::make_unique<LawPath>();
        for (Block& block : blocks) {
            block.feed = 1e4F;
            block.centripetal = 1e6F;
            path->append(block);
        }
        path->close();
        StationMaker maker;
        maker.set_limits(MachineLimits{});
        TimeLaw law;
        law.set_limits(MachineLimits{});
        PathCursor cursor = path->begin();
        // v = 3 s/t at the end of an element with the jerk of the axis.
        constexpr StopElement kElement{1.2F, 2900.0F};
        law.begin(kElement);
        const std::int64_t begin = units(0.6F);
        std::vector<Station> stations;
        for (std::int64_t k = 0; k < 29; ++k) {
            Station station =
                maker.make(*path, cursor, begin * (k + 2), begin * (k + 3), {}, 100.0F);
            station.kept.bend = all_lanes(0.0F);
            station.kept.bend_acceleration = all_lanes(0.0F);
            station.cap = 1e4F;
            station.acceleration_at_end = k == 28;
            law.add(station);
        }
        law.end(kElement);
        LawPlans plans;
        float use = 0;
        while (law.state() != TimeLaw::State::kDone) {
            law.work();
            CHECK(law.state() != TimeLaw::State::kBlocked);
            if (law.state() == TimeLaw::State::kChecks) {
                PathCursor near = path->begin();
                use = std::max(use, greatest_use(law, *path, near, MachineLimits{}));
                law.accept(plans);
            }
        }
        CHECK_TEXT(has_bend == (use > 1.0F), std::to_string(use).c_str());
    }
}
