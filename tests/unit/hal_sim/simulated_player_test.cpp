// The simulated player: two frames in flight, absolute ticks, underrun.
#include "hal/sim/simulated_player.hpp"

#include <utility>
#include <vector>

#include "CppUTest/TestHarness.h"

namespace {

using namespace cusp;

struct Recorder : hal::FrameListener {
    void frame_played(std::uint64_t start, const PulseFrame& frame) override
    {
        starts.push_back(start);
        for (const PulseEdge& edge : frame.edges) {
            edges.push_back({start + edge.tick, edge});
        }
    }
    std::vector<std::uint64_t> starts;
    std::vector<std::pair<std::uint64_t, PulseEdge>> edges;
};

PulseFrame frame_with(std::uint16_t tick, PulseLines raise, PulseLines lower = 0)
{
    PulseFrame frame;
    frame.edges.try_push_back({tick, raise, lower});
    return frame;
}

}  // namespace

TEST_GROUP(SimulatedPlayer)
{
    hal::SimulatedPlayer player;
    Recorder recorder;
    void setup() override { player.add_listener(recorder); }
};

TEST(SimulatedPlayer, StartsFrameKAtTickThousandK)
{
    for (int k = 0; k < 3; ++k) {
        CHECK(player.try_play(frame_with(7, step_line(0))));
        player.advance();
    }
    player.try_play({});
    player.advance();
    LONGS_EQUAL(3, recorder.edges.size());
    LONGS_EQUAL(7, recorder.edges[0].first);
    LONGS_EQUAL(1007, recorder.edges[1].first);
    LONGS_EQUAL(2007, recorder.edges[2].first);
}

TEST(SimulatedPlayer, HoldsExactlyTwoFramesInFlight)
{
    CHECK(player.try_play({}));
    player.advance();
    CHECK(player.try_play({}));
    CHECK_FALSE(player.try_play({}));
    player.advance();
    CHECK(player.try_play({}));
}

TEST(SimulatedPlayer, LetsNoTimePassBeforeItsFirstFrame)
{
    player.advance();
    player.advance();
    LONGS_EQUAL(0, player.next_frame_start());
    player.try_play({});
    player.advance();
    LONGS_EQUAL(1000, player.next_frame_start());
}

TEST(SimulatedPlayer, CallsAFrameMissingAmidMotionAnUnderrunAndLowersTheSteps)
{
    player.try_play(frame_with(1, step_line(1)));
    player.advance();
    player.advance();
    CHECK(player.underrun());
    LONGS_EQUAL(0, player.levels());
    player.try_play(frame_with(1, step_line(1)));
    player.advance();
    player.advance();
    LONGS_EQUAL(2, recorder.edges.size());  // up, and down by the underrun: nothing more is played
}

TEST(SimulatedPlayer, PlaysAgainOnceTheUnderrunIsCleared)
{
    player.try_play(frame_with(1, step_line(0)));
    player.advance();
    player.advance();
    player.clear_underrun();
    player.try_play(frame_with(5, step_line(2)));
    player.advance();
    player.try_play({});
    player.advance();
    CHECK(recorder.edges.back().second.raise == step_line(2));
}

TEST(SimulatedPlayer, TakesAMissingFrameAtRestForNoUnderrun)
{
    player.try_play({});
    player.advance();
    player.advance();
    player.advance();
    CHECK_FALSE(player.underrun());
}

TEST(SimulatedPlayer, LosesAFrameOnDemand)
{
    player.try_play(frame_with(3, step_line(0)));
    player.advance();
    player.lose_next_frame();
    player.try_play(frame_with(3, 0, step_line(0)));
    player.advance();
    CHECK(player.underrun());
}
