// Plans between the main loop and a tick that comes at any time: the tick never leaves a plan but at
// its place of choice, and the main loop knows which way it went.
#include "firmware/planner/law_plans.hpp"

#include <random>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

using namespace cusp;
using namespace cusp::planner;

namespace {

constexpr std::uint64_t kPlansSeed = 7470;
constexpr int kPlansCases = 200;

LawCell cell_of(std::uint32_t number, LawPiece piece) { return {{}, number, piece}; }

// The main loop's belief: the numbers of the cells that the tick plays, in order.
struct Loop {
    // One more plan: some certain cells, then the way to rest, if the path goes on.
    void plan(LawPlans& plans, std::mt19937_64& random)
    {
        const std::uint32_t certain = 1 + static_cast<std::uint32_t>(random() % 20);
        const std::uint32_t rest = ends ? 0U : 2 + static_cast<std::uint32_t>(random() % 10);
        if (plans.room() < certain + rest) {
            return;
        }
        for (std::uint32_t i = 0; i < certain + rest; ++i) {
            plans.add(cell_of(next + i, i == 0 && from_rest ? LawPiece::kStart : LawPiece::kCell));
        }
        if (!plans.publish(certain)) {
            CHECK(!from_rest);
            ++refused;
            for (std::uint32_t i = 0; i < tail; ++i) {
                expected.push_back(tail_begin + i);
            }
            from_rest = true;
            return;
        }
        for (std::uint32_t i = 0; i < certain; ++i) {
            expected.push_back(next + i);
        }
        tail_begin = next + certain;
        tail = rest;
        next += certain + rest;
        from_rest = ends;
        ends = random() % 5 == 0;
    }

    std::vector<std::uint32_t> expected;
    std::uint32_t next{0};
    std::uint32_t tail_begin{0};
    std::uint32_t tail{0};
    bool from_rest{true};
    bool ends{false};  // the next plan reaches the end of its stretch
    int refused{0};
};

}  // namespace

TEST_GROUP(LawPlans){};

TEST(LawPlans, the_tick_plays_what_the_main_loop_believes)
{
    int refused = 0;
    for (int n = 0; n < kPlansCases; ++n) {
        std::mt19937_64 random{kPlansSeed + static_cast<std::uint64_t>(n)};
        const std::uint64_t cells_a_plan = 2 + random() % 40;
        LawPlans plans;
        Loop loop;
        std::vector<std::uint32_t> played;
        for (int i = 0; i < 3000; ++i) {
            LawCell cell;
            if (random() % cells_a_plan == 0) {
                loop.plan(plans, random);
            } else if (plans.next(cell)) {
                played.push_back(cell.travel);
            }
        }
        refused += loop.refused;
        // The tick may be on its way to rest, which the loop hasn't heard of.
        CHECK(played.size() <= loop.expected.size() + loop.tail);
        for (std::size_t i = 0; i < played.size() && i < loop.expected.size(); ++i) {
            CHECK_TEXT(played[i] == loop.expected[i], ("case " + std::to_string(n)).c_str());
        }
    }
    CHECK(refused > kPlansCases);
}

TEST(LawPlans, nothing_is_played_before_a_start_and_after_an_end)
{
    LawPlans plans;
    LawCell cell;
    CHECK(!plans.next(cell));
    plans.add(cell_of(1, LawPiece::kStart));
    plans.add(cell_of(2, LawPiece::kStop));
    CHECK(!plans.next(cell));
    CHECK(plans.publish(2));
    CHECK(plans.next(cell) && cell.travel == 1);
    CHECK(plans.next(cell) && cell.travel == 2);
    CHECK(!plans.next(cell));
}

// The tick plays the cell that it has looked at: a plan that comes later does not change it.
TEST(LawPlans, what_is_looked_at_is_what_is_played)
{
    for (int n = 0; n < kPlansCases; ++n) {
        std::mt19937_64 random{kPlansSeed + 5000 + static_cast<std::uint64_t>(n)};
        LawPlans plans;
        Loop loop;
        std::vector<std::uint32_t> promised;
        for (int i = 0; i < 2000; ++i) {
            LawCell cell;
            if (random() % 12 == 0) {
                loop.plan(plans, random);
            } else if (random() % 2 == 0) {
                const auto ahead = static_cast<std::uint32_t>(random() % 8);
                for (std::uint32_t k = 0; k <= ahead; ++k) {
                    const LawCell* seen = nullptr;
                    const PackedBounds* bounds = nullptr;
                    const bool is_there = plans.look(k, seen, bounds);
                    if (k < promised.size()) {
                        CHECK(is_there && seen->travel == promised[k]);
                    } else if (is_there) {
                        promised.push_back(seen->travel);
                    }
                }
            } else if (plans.next(cell)) {
                CHECK(promised.empty() || cell.travel == promised.front());
                if (!promised.empty()) {
                    promised.erase(promised.begin());
                }
            } else {
                CHECK(promised.empty());
            }
        }
    }
}
