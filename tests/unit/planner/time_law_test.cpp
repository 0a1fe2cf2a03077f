// Windows of the time law: final cells hold every limit however the stations come, and a line from
// stop to stop takes hardly longer than the closed form.
#include "firmware/planner/time_law.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/generators/line_stretch.hpp"
#include "tests/generators/random_stations.hpp"
#include "tests/judges/law_judge.hpp"

using namespace cusp;
using namespace cusp::planner;
using namespace cusp::test;

namespace {

constexpr std::uint64_t kLawSeed = 6260;
constexpr int kLawCases = 120;

Stretch any_stretch(RandomStations& random)
{
    Stretch made;
    const std::size_t count = 8 + random.number() % 200;
    for (std::size_t k = 0; k < count; ++k) {
        made.stations.push_back(random.next());
        made.stations.back().travel = static_cast<std::uint32_t>(k);
    }
    made.start = element_for(made.stations.front(), static_cast<float>(random.between(0.1, 30)));
    made.stop = element_for(made.stations.back(), static_cast<float>(random.between(0.1, 30)));
    return made;
}

// Plays all stations through a law; some plans are thrown away. Cells that are certain, in order,
// without the elements.
std::vector<LawCell> plan(TimeLaw& law,
                          const Stretch& stretch,
                          RandomStations& random,
                          std::uint64_t refused_of_eight,
                          std::uint32_t* windows = nullptr)
{
    std::vector<LawCell> cells;
    LawPlans plans;
    std::size_t next = 0;
    bool ended = false;
    law.begin(stretch.start);
    while (law.state() != TimeLaw::State::kDone && law.state() != TimeLaw::State::kBlocked) {
        while (next < stretch.stations.size() && law.has_room() && random.number() % 8 != 0) {
            law.add(stretch.stations[next]);
            ++next;
        }
        if (next == stretch.stations.size() && !ended) {
            law.end(stretch.stop);
            ended = true;
        }
        law.work();
        if (law.state() == TimeLaw::State::kChecks && random.number() % 8 < refused_of_eight) {
            law.retreat();
        } else if (law.state() == TimeLaw::State::kChecks ||
                   law.state() == TimeLaw::State::kStays) {
            law.accept(plans);
            if (windows != nullptr) {
                ++*windows;
            }
            LawCell cell;
            do {
                CHECK(plans.next(cell));
                if (cell.piece == LawPiece::kCell) {
                    cells.push_back(cell);
                }
            } while (!plans.chooses());
        }
    }
    return cells;
}

double time_of(const std::vector<LawCell>& cells, const Stretch& stretch)
{
    constexpr int kParts = 64;
    const auto at_ends = [](const StopElement& element, float x) {
        return 3.0 * static_cast<double>(element.length) / std::sqrt(static_cast<double>(x));
    };
    const float h = stretch.stations.back().length;
    double time = at_ends(stretch.start, cells.front().start.value) +
                  at_ends(stretch.stop, advanced(cells.back().start, h).value);
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const float length = stretch.stations[k].length;
        for (int i = 0; i < kParts; ++i) {
            const float s = length * (static_cast<float>(i) + 0.5F) / kParts;
            time += static_cast<double>(length) / kParts /
                    std::sqrt(static_cast<double>(advanced(cells[k].start, s).value));
        }
    }
    return time;
}

}  // namespace

TEST_GROUP(TimeLaw){};

TEST(TimeLaw, final_cells_hold_every_limit_and_meet)
{
    int rests = 0;
    for (int n = 0; n < kLawCases; ++n) {
        const std::uint64_t seed = kLawSeed + static_cast<std::uint64_t>(n);
        const std::string which = "seed " + std::to_string(seed);
        RandomStations random{seed};
        const Stretch stretch = any_stretch(random);
        TimeLaw law;
        law.set_limits(random.limits);
        const std::vector<LawCell> cells = plan(law, stretch, random, 1);
        CHECK_TEXT(law.state() == TimeLaw::State::kDone, which.c_str());
        rests += law.rests() ? 1 : 0;
        const LaneVec ratio =
            quotient(to_lanes(random.limits.jerk), to_lanes(random.limits.acceleration));
        for (std::size_t k = 0; k < cells.size(); ++k) {
            const Station& station = stretch.stations[k];
            const SquaredSpeed& start = cells[k].start;
            for (unsigned p = 0; p < kPlacesOfCell; ++p) {
                const SquaredSpeed x =
                    advanced(start, 0.5F * static_cast<float>(p) * station.length);
                const ExactSpeed exact{static_cast<long double>(x.value),
                                       static_cast<long double>(x.slope),
                                       static_cast<long double>(x.bend)};
                const long double use = use_at(station.places[p], station.kept, ratio, exact,
                                               p < 2 || station.acceleration_at_end);
                CHECK_TEXT(use < 1.0001L, which.c_str());
                CHECK_TEXT(x.value > 0 && x.value <= 1.00001F * station.cap, which.c_str());
            }
            if (k > 0) {
                const SquaredSpeed before =
                    advanced(cells[k - 1].start, stretch.stations[k - 1].length);
                DOUBLES_EQUAL(1.0, static_cast<double>(before.value / start.value), 1e-4);
            }
        }
        CHECK_TEXT(law.rests() || cells.size() == stretch.stations.size(), which.c_str());
    }
    CHECK_TEXT(rests * 20 < kLawCases, std::to_string(rests).c_str());
}

TEST(TimeLaw, a_line_takes_hardly_longer_than_the_closed_form)
{
    struct Machine {
        MachineLimits limits;
        float feed;
    };
    MachineLimits slow;
    slow.velocity = slow.velocity * 0.5F;
    slow.acceleration = slow.acceleration * 0.2F;
    slow.jerk = slow.jerk * 0.04F;
    MachineLimits fast;
    fast.velocity = fast.velocity * 5;
    fast.acceleration = fast.acceleration * 5;
    fast.jerk = fast.jerk * 10;
    const Machine machines[] = {{MachineLimits{}, 100.0F}, {slow, 50.0F}, {fast, 500.0F}};
    for (const Machine& machine : machines) {
        const float length = 200.0F;
        TimeLaw law;
        law.set_limits(machine.limits);
        const Stretch stretch = line(machine.limits, length, machine.feed, law.station_time());
        RandomStations order{kLawSeed};
        std::uint32_t windows = 0;
        const std::vector<LawCell> cells = plan(law, stretch, order, 0, &windows);
        CHECK(law.state() == TimeLaw::State::kDone);
        const double closed = static_cast<double>(
            length / machine.feed + machine.feed / machine.limits.acceleration.x +
            machine.limits.acceleration.x / machine.limits.jerk.x);
        const double time = time_of(cells, stretch);
        CHECK_TEXT(time > closed, std::to_string(time / closed).c_str());
        CHECK_TEXT(time < 1.01 * closed, std::to_string(time / closed).c_str());
        // From afar it would be 16 and more.
        CHECK_TEXT(law.steps() < 8 * windows, std::to_string(law.steps()).c_str());
    }
}
