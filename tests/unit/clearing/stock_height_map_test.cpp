#include "host_tools/cam/clearing/stock_height_map.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "host_tools/base/parallel/parallel.hpp"

// Last: CppUTest redefines new, which breaks standard headers included after it.
#include "CppUTest/TestHarness.h"

namespace cusp::test {

using namespace clearing;
using namespace offset;
using namespace toolpath;

namespace {

constexpr double kSide = 24.0;
constexpr double kTop = 0.0;

double lower_side(const Tool& tool, double out)
{
    const double flat = tool.radius - tool.corner_radius;
    const double beyond = std::max(0.0, out - flat);
    const double c = tool.corner_radius;
    return c - std::sqrt(std::max(0.0, c * c - beyond * beyond));
}

// One place of stock under every position of the tool, none left out.
class OnePlace {
public:
    OnePlace(Vec2d at, const Tool& tool) : at_{at}, tool_{tool} {}

    void cut(Vec3d from, Vec3d to)
    {
        const int n = std::max(1, static_cast<int>(std::ceil(norm(to - from) / tool_.radius * 10)));
        for (int i = 1; i <= n; ++i) {
            const Vec3d tip = from + (to - from) * (static_cast<double>(i) / n);
            const double out = distance(at_, {tip.x, tip.y});
            if (out <= tool_.radius) {
                height_ = std::min(height_, tip.z + lower_side(tool_, out));
            }
        }
    }
    Vec2d at() const { return at_; }
    double height() const { return height_; }

private:
    Vec2d at_;
    Tool tool_;
    double height_{kTop};
};

TEST_GROUP(StockHeightMap){};

// Level, up, down, plunging, from another place: the map relies on the last position.
TEST(StockHeightMap, IsWhatAllPositionsOfTheToolLeave)
{
    constexpr unsigned kSeed = 20261122;
    constexpr double kGraze = 1e-6;
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> any{0.0, 1.0};
    int cut = 0;
    for (int n = 0; n < 60; ++n) {
        Tool tool{};
        tool.radius = 1.0 + 2.0 * any(random);
        tool.corner_radius = n % 3 == 0 ? 0.0 : n % 3 == 1 ? tool.radius : 0.4 * tool.radius;
        constexpr double kShare = 1.0 / 8;
        const double pitch = tool.radius * kShare;
        StockHeightMap stock{{0.0, 0.0, kSide, kSide}, tool, kTop, kShare};
        // A pin thinner than the pitch touches one point of the map.
        Tool pin{};
        pin.radius = 0.5 * pitch;
        std::vector<OnePlace> places;
        for (int i = 0; i < 12; ++i) {
            const auto place = [&] {
                return pitch * std::floor(any(random) * kSide / pitch);
            };
            places.push_back({{place(), place()}, tool});
        }
        Vec3d at{12.0, 12.0, 1.0};
        for (int move = 0; move < 60; ++move) {
            Vec3d to{kSide * any(random), kSide * any(random), at.z};
            const double kind = any(random);
            to.z = kind < 0.4 ? std::min(at.z, -0.5) : 1.0 - 4.0 * any(random);
            to = kind > 0.9 ? Vec3d{at.x, at.y, to.z} : to;
            to = any(random) < 0.5 ? at + (to - at) * (0.3 / kSide) : to;
            stock.cut(at, to);
            for (OnePlace& place : places) {
                place.cut(at, to);
            }
            at = any(random) < 0.05 ? Vec3d{kSide * any(random), kSide * any(random), 0.5} : to;
        }
        StockHeightMap uncut{{0.0, 0.0, kSide, kSide}, tool, kTop, kShare};
        uncut.set_tool(pin);
        stock.set_tool(pin);
        for (const OnePlace& place : places) {
            const double taken =
                uncut.contact_height(place.at()) - stock.contact_height(place.at());
            DOUBLES_EQUAL(kTop - place.height(), taken, kGraze);
            cut += taken > 0.5 ? 1 : 0;
        }
    }
    CHECK(cut > 300);
}

// The later cuts and heights are those of a map that was never tried on.
TEST(StockHeightMap, TrialsLeaveNoTrace)
{
    constexpr unsigned kSeed = 20261126;
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> any{0.0, 1.0};
    const auto place = [&] {
        return Vec3d{kSide * any(random), kSide * any(random), -3.0 * any(random)};
    };
    Tool tool;
    tool.radius = 2.0;
    for (const double corner : {0.0, 0.5, 2.0}) {
        tool.corner_radius = corner;
        StockHeightMap stock{{0.0, 0.0, kSide, kSide}, tool, kTop};
        StockHeightMap untried = stock;
        Vec3d at = place();
        double deepest_trial = 0.0;
        for (int i = 0; i < 60; ++i) {
            const Vec3d to = any(random) < 0.5 ? at + (place() - at) * 0.05 : place();
            stock.begin_trial();
            deepest_trial =
                std::max(deepest_trial, stock.cut_with_shrunk_tool({{place(), at}}).front());
            deepest_trial = std::max(deepest_trial, stock.cut(at, to));
            stock.end_trial();
            CHECK_EQUAL(untried.cut(at, to), stock.cut(at, to));
            const Vec3d probe = place();
            CHECK_EQUAL(untried.contact_height({probe.x, probe.y}),
                        stock.contact_height({probe.x, probe.y}));
            at = to;
        }
        CHECK(deepest_trial > 1.0);
    }
}

// The height itself where all places are one.
TEST(StockHeightMap, BoundsContactsNearAPlace)
{
    constexpr unsigned kSeed = 20261128;
    constexpr double kRim = 1e-4;  // mm: where the tool is steep, of rounding in plan
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> any{0.0, 1.0};
    const auto place = [&] {
        return Vec3d{kSide * any(random), kSide * any(random), -3.0 * any(random)};
    };
    Tool tool;
    tool.radius = 2.0;
    int tight = 0;
    for (const double corner : {0.0, 0.5, 2.0}) {
        tool.corner_radius = corner;
        StockHeightMap stock{{0.0, 0.0, kSide, kSide}, tool, kTop};
        for (int i = 0; i < 120; ++i) {
            const Vec3d from = place();
            stock.cut(from, from + (place() - from) * 0.2);
        }
        for (int i = 0; i < 2000; ++i) {
            const Vec2d at{kSide * any(random), kSide * any(random)};
            const double here = stock.contact_height(at);
            CHECK(here <= stock.most_contact_height(at, 0.0));
            DOUBLES_EQUAL(here, stock.most_contact_height(at, 0.0), kRim);
            const double within = 0.5 * any(random);
            const double most = stock.most_contact_height(at, within);
            const double angle = 6.3 * any(random);
            const Vec2d away = Vec2d{std::cos(angle), std::sin(angle)} * (within * any(random));
            const double there = stock.contact_height(at + away);
            CHECK(there <= most);
            tight += there > most - 0.01 ? 1 : 0;
        }
    }
    CHECK(tight > 1000);
}

// Long enough to be shared out: the same bits as move by move.
TEST(StockHeightMap, CutsManyMovesAsOneByOne)
{
    constexpr unsigned kSeed = 20261127;
    std::mt19937 random{kSeed};
    std::uniform_real_distribution<double> any{0.0, 1.0};
    const auto place = [&] {
        return Vec3d{kSide * any(random), kSide * any(random), 0.5 - 3.0 * any(random)};
    };
    Tool tool;
    tool.radius = 2.0;
    parallel::set_threads(3);
    for (const double corner : {0.0, 0.5, 2.0}) {
        tool.corner_radius = corner;
        StockHeightMap stock{{0.0, 0.0, kSide, kSide}, tool, kTop};
        StockHeightMap one_by_one = stock;
        StockHeightMap untouched = stock;
        std::vector<StockHeightMap::Move> moves;
        Vec3d at = place();
        for (int i = 0; i < 60; ++i) {
            const Vec3d to = any(random) < 0.5 ? at + (place() - at) * 0.05 : place();
            moves.push_back({at, to});
            at = to;
        }
        stock.begin_trial();
        stock.cut_with_shrunk_tool(moves);
        stock.end_trial();
        const std::vector<double> deepest = stock.cut(moves);
        int deep = 0;
        for (std::size_t k = 0; k < moves.size(); ++k) {
            CHECK_EQUAL(one_by_one.cut(moves[k].from, moves[k].to), deepest[k]);
            deep += deepest[k] > 0.5 ? 1 : 0;
        }
        CHECK(deep > 5);
        int lower = 0;
        for (int i = 0; i < 500; ++i) {
            const Vec3d probe = place();
            const double left = stock.contact_height({probe.x, probe.y}, 0.2);
            CHECK_EQUAL(one_by_one.contact_height({probe.x, probe.y}, 0.2), left);
            lower += left < untouched.contact_height({probe.x, probe.y}, 0.2) ? 1 : 0;
        }
        CHECK(lower > 250);
    }
}

}  // namespace
}  // namespace cusp::test
