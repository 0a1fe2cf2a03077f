// Blocks in, plans out, with a main loop and lines as late as they may be: the whole path is planned,
// and the plan does not depend on how the path came.
#include "firmware/planner/stretch_planner.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/planner/corner_overlap.hpp"

using namespace cusp;
using namespace cusp::planner;

namespace {

constexpr std::uint64_t kStretchSeed = 8811;
constexpr int kStretchCases = 12;
constexpr unsigned kMostSteps = 200'000;  // of the main loop without a cell played

struct Line {
    float length;   // mm
    float heading;  // radians
    float feed;     // mm/s
};

class Bench {
public:
    explicit Bench(const MachineLimits& limits = {}) { law_.set_limits(limits); }

    bool push(const Line& line)
    {
        if (queue_->free_blocks() == 0) {
            return false;
        }
        Block& block = queue_->new_block();
        block = Block{};
        const float units = line.length * kPathUnitsPerMillimetre;
        block.displacement = {static_cast<std::int32_t>(units * std::cos(line.heading)),
                              static_cast<std::int32_t>(units * std::sin(line.heading)), 0};
        set_length(block, static_cast<std::uint32_t>(units));
        block.filter = {4, 2};
        block.feed = line.feed * line.feed;
        block.centripetal = 1e6F;
        given_ += block.length;
        lengths_.push_back(block.length);
        queue_->append_block();
        return true;
    }
    void stop() { queue_->block(queue_->block_end() - 1).stops = true; }

    bool step() { return law_.work(); }

    void work()
    {
        unsigned steps = 0;
        while (law_.work()) {
            CHECK(++steps < kMostSteps);
        }
    }

    // The tick plays a cell; true if there is one.
    bool play()
    {
        LawCell cell;
        if (!queue_->plans().next(cell)) {
            return false;
        }
        cells_.push_back(cell);
        way_ += cell.travel;
        while (!lengths_.empty() && passed_ + lengths_.front() <= way_) {
            stops_ += queue_->block(queue_->block_begin()).stops ? 1 : 0;
            passed_ += lengths_.front();
            lengths_.erase(lengths_.begin());
            queue_->drop_block();
        }
        return true;
    }
    // Plays what is played in any case.
    bool play_certain() { return queue_->plans().certain_way().length > 0 && play(); }

    const std::vector<LawCell>& cells() const { return cells_; }
    std::int64_t way() const { return way_; }
    std::int64_t given() const { return given_; }
    int stops() const { return stops_; }
    bool finished() const { return law_.finished(); }
    LawPlans& plans() { return queue_->plans(); }

private:
    std::unique_ptr<PathQueue> queue_{std::make_unique<PathQueue>()};
    StretchPlanner law_{*queue_};
    std::vector<LawCell> cells_;
    std::vector<std::uint32_t> lengths_;
    std::int64_t given_{0};
    std::int64_t way_{0};
    std::int64_t passed_{0};
    int stops_{0};
};

// Gives the lines `burst` at a time to a main loop that plans all it can before it gets more.
void play_path(Bench& bench, const std::vector<Line>& lines, std::size_t burst)
{
    std::size_t next = 0;
    unsigned idle = 0;
    while (bench.way() != bench.given() || next != lines.size()) {
        for (std::size_t i = 0; i < burst && next < lines.size() && bench.push(lines[next]); ++i) {
            ++next;
            if (next == lines.size()) {
                bench.stop();
            }
        }
        bench.work();
        idle = bench.play_certain() ? 0 : idle + 1;
        CHECK(idle < 1000);
        if (idle >= 1000) {
            return;
        }
    }
}

bool are_same(const LawCell& a, const LawCell& b)
{
    return a.start.value == b.start.value && a.start.slope == b.start.slope &&
           a.start.bend == b.start.bend && a.travel == b.travel && a.piece == b.piece &&
           a.ends == b.ends;
}

// Lines of a length that turn a little at each joint.
std::vector<Line> bent_lines(std::size_t count, float length, float turn, float feed)
{
    std::vector<Line> lines;
    for (std::size_t i = 0; i < count; ++i) {
        lines.push_back({length, turn * static_cast<float>(i), feed});
    }
    return lines;
}

}  // namespace

TEST_GROUP(StretchPlanner){};

TEST(StretchPlanner, plans_do_not_depend_on_how_the_path_comes)
{
    std::mt19937_64 random{kStretchSeed};
    std::uniform_real_distribution<float> part{0, 1};
    for (int n = 0; n < kStretchCases; ++n) {
        std::vector<Line> lines = bent_lines(150 + random() % 100, 0.1F + 0.3F * part(random),
                                             0.006F * part(random), 10.0F + 70.0F * part(random));
        for (Line& line : lines) {
            line.length *= random() % 10 == 0 ? 20.0F : 1.0F;
        }
        Bench at_once;
        play_path(at_once, lines, lines.size());
        CHECK(at_once.finished());
        for (const std::size_t burst : {1U, 3U, 17U}) {
            Bench bench;
            play_path(bench, lines, burst);
            const std::string which = "case " + std::to_string(n) + ", " + std::to_string(burst);
            CHECK_TEXT(std::equal(at_once.cells().begin(), at_once.cells().end(),
                                  bench.cells().begin(), bench.cells().end(), are_same),
                       which.c_str());
        }
    }
}

TEST(StretchPlanner, a_plan_that_starves_ends_at_rest_and_the_path_goes_on_from_there)
{
    const std::vector<Line> lines = bent_lines(60, 1.0F, 0.002F, 50.0F);
    Bench bench;
    for (std::size_t i = 0; i < 50; ++i) {
        CHECK(bench.push(lines[i]));
    }
    bench.work();
    CHECK(!bench.finished());
    while (bench.play()) {
    }
    CHECK(bench.way() > 0 && bench.way() < bench.given());
    CHECK(bench.cells().back().piece == LawPiece::kStop && !bench.cells().back().ends);
    CHECK(bench.plans().starves());
    const std::size_t before = bench.cells().size();
    for (std::size_t i = 50; i < lines.size(); ++i) {
        CHECK(bench.push(lines[i]));
    }
    bench.stop();
    for (int i = 0; i < 10; ++i) {
        bench.work();
        while (bench.play_certain()) {
        }
    }
    CHECK(bench.cells()[before].piece == LawPiece::kStart);
    CHECK(bench.cells().back().piece == LawPiece::kStop && bench.cells().back().ends);
    CHECK(bench.way() == bench.given());
    CHECK(bench.finished());
}

// By an axis with a short ramp stations are dense at the start: the slowest processor needs this time for
// the next plan.
TEST(StretchPlanner, the_first_plan_lasts_while_the_next_is_made)
{
    constexpr float kLeastTime = 0.039F;  // s; packed times are a part in 100 less
    MachineLimits limits;
    limits.velocity.x = 150.0F;
    limits.acceleration.x = 5000.0F;
    limits.jerk.x = 1e6F;
    Bench bench{limits};
    CHECK(bench.push({100.0F, 0.0F, 150.0F}));
    bench.stop();
    for (int i = 0; bench.plans().certain_way().time <= 0.0F && i < 100; ++i) {
        CHECK(bench.step());
    }
    CHECK(bench.plans().certain_way().time >= kLeastTime);
}

// 96 blocks are shorter than the way that a station must know: the path stops at the last of them.
TEST(StretchPlanner, a_full_ring_of_too_short_lines_stops_at_its_end)
{
    Bench bench;
    play_path(bench, bent_lines(400, 0.01F, 0, 50.0F), 400);
    CHECK(bench.way() == bench.given());
    CHECK(bench.stops() > 1 && bench.stops() < 10);
}

// They have stations enough for a window, but not for the way behind it.
TEST(StretchPlanner, a_full_ring_of_short_lines_begins_a_short_window)
{
    Bench bench;
    play_path(bench, bent_lines(400, 0.05F, 0, 12.0F), 400);
    CHECK(bench.way() == bench.given());
    CHECK_EQUAL(1, bench.stops());
}
