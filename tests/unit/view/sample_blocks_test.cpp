// Every set point is restored exactly.
#include "host_tools/judge/view/sample_blocks.hpp"

#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/unit/view/inflated.hpp"

using namespace cusp;
using namespace cusp::view;

namespace {

std::int64_t unzigzag(std::uint64_t value)
{
    const auto half = static_cast<std::int64_t>(value >> 1U);
    return (value & 1U) != 0 ? -half - 1 : half;
}

// The set point `ticks` before a tick; before the first nothing moved.
Position before(const std::vector<Position>& points, std::size_t tick, std::size_t ticks)
{
    return points[tick < ticks ? 0 : tick - ticks];
}

std::vector<Position> unpacked(const std::string& bytes)
{
    ByteReader reader{bytes};
    const std::size_t ticks = reader.whole(4);
    const std::size_t block = reader.whole(4);
    std::vector<Position> out(ticks);
    std::array<std::vector<std::int64_t>, 3> third;
    third.fill(std::vector<std::int64_t>(ticks));
    for (std::size_t begin = 0; begin < ticks; begin += block) {
        const std::size_t end = std::min(ticks, begin + block);
        std::array<std::array<std::int64_t, 3>, 3> seeds{};
        std::array<unsigned, 3> planes{};
        for (unsigned axis = 0; axis < 3; ++axis) {
            for (std::int64_t& seed : seeds[axis]) {
                seed = static_cast<std::int64_t>(reader.f64());
            }
            planes[axis] = static_cast<unsigned>(reader.whole(1));
        }
        const std::string raw = inflated(reader.take(reader.whole(4)));
        ByteReader packed{raw};
        // For each tick how long ago its third differences were; 0: it has its own.
        std::vector<std::size_t> ago(end - begin, 0);
        std::size_t own = end - begin - 1;
        std::size_t tick = 1;
        for (std::uint64_t left = packed.varint(); left > 0; --left) {
            tick += packed.varint();
            const std::uint64_t repeated = packed.varint();
            std::fill_n(ago.begin() + static_cast<std::ptrdiff_t>(tick), repeated, packed.varint());
            tick += repeated;
            own -= repeated;
        }
        for (unsigned axis = 0; axis < 3; ++axis) {
            const std::string_view own_planes = packed.take(planes[axis] * own);
            auto [place, velocity, acceleration] = seeds[axis];
            third[axis][begin] = 0;
            out[begin][axis] = place;
            if (begin > 0) {
                third[axis][begin] =
                    acceleration - (out[begin - 1][axis] - 2 * before(out, begin, 2)[axis] +
                                    before(out, begin, 3)[axis]);
            }
            std::size_t at = 0;
            for (std::size_t k = 1; k < end - begin; ++k) {
                std::uint64_t value = 0;
                for (unsigned plane = 0; ago[k] == 0 && plane < planes[axis]; ++plane) {
                    value |= std::uint64_t{static_cast<unsigned char>(own_planes[at + plane * own])}
                             << 8U * plane;
                }
                at += ago[k] == 0 ? 1U : 0U;
                third[axis][begin + k] =
                    ago[k] == 0 ? unzigzag(value) : third[axis][begin + k - ago[k]];
                acceleration += third[axis][begin + k];
                velocity += acceleration;
                place += velocity;
                out[begin + k][axis] = place;
            }
        }
        CHECK(packed.done());
    }
    CHECK(reader.done());
    return out;
}

void check_round_trip(const std::vector<Position>& points)
{
    SampleBlocks blocks;
    for (const Position& point : points) {
        blocks.add(point);
    }
    CHECK(unpacked(blocks.finish().text()) == points);
}

}  // namespace

TEST_GROUP(SampleBlocks){};

TEST(SampleBlocks, OfNoneAndFewSetPointsComeBack)
{
    check_round_trip({});
    check_round_trip({{5, -6, 7}});
    check_round_trip({{5, -6, 7}, {-1000000000000, 0, 1}, {0, 0, 0}});
}

TEST(SampleBlocks, OfTwoBlocksAndOneTickComeBack)
{
    std::vector<Position> points;
    std::mt19937 random{7};
    std::uniform_int_distribution<std::int64_t> jerk{-60, 60};
    Position at{1234567890123, -5, 0};
    Position velocity{};
    Position acceleration{};
    for (std::size_t k = 0; k < 2 * SampleBlocks::kBlock + 1; ++k) {
        acceleration = acceleration + Position{jerk(random), jerk(random), 0};
        velocity = velocity + acceleration;
        at = at + velocity;
        points.push_back(at);
    }
    check_round_trip(points);
}

TEST(SampleBlocks, ThatJumpAcrossTheMachineComeBack)
{
    std::vector<Position> points;
    std::mt19937_64 random{9};
    std::uniform_int_distribution<std::int64_t> place{-1000000000000, 1000000000000};
    for (int k = 0; k < 3000; ++k) {
        points.push_back({place(random), place(random), place(random)});
    }
    check_round_trip(points);
}

TEST(SampleBlocks, OfASteadyMoveTakeAlmostNothing)
{
    SampleBlocks blocks;
    for (std::int64_t k = 0; k < 100000; ++k) {
        blocks.add({20000 * k, 0, 0});
    }
    CHECK(blocks.finish().size() < 1000);
}

// Layers of one shape with random motion between them: repetitions are found at any distance.
TEST(SampleBlocks, OfLayersTakeHardlyMoreThanOfOne)
{
    constexpr unsigned kSeeds = 20;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
        std::mt19937 random{seed};
        std::uniform_int_distribution<std::int64_t> jerk{-60, 60};
        const auto walk = [&](std::size_t ticks) {
            std::vector<Position> thirds;
            for (std::size_t k = 0; k < ticks; ++k) {
                thirds.push_back({jerk(random), jerk(random), k % 7 == 0 ? jerk(random) : 0});
            }
            return thirds;
        };
        const std::vector<Position> layer = walk(30000 + 7 * seed);
        std::vector<Position> points;
        std::array<Position, 3> now{};
        const auto go = [&](const std::vector<Position>& thirds) {
            for (const Position& third : thirds) {
                now[2] = now[2] + third;
                now[1] = now[1] + now[2];
                now[0] = now[0] + now[1];
                points.push_back(now[0]);
            }
        };
        SampleBlocks one;
        go(layer);
        for (const Position& point : points) {
            one.add(point);
        }
        for (int k = 0; k < 6; ++k) {
            go(walk(50 + seed));
            go(layer);
        }
        SampleBlocks all;
        for (const Position& point : points) {
            all.add(point);
        }
        const std::string bytes = all.finish().text();
        CHECK(unpacked(bytes) == points);
        CHECK(bytes.size() < one.finish().size() * 6 / 5);
    }
}

// Short stretches that come again and again, also over themselves, over the ends of blocks, with huge differences.
TEST(SampleBlocks, OfRandomRepetitionsComeBack)
{
    constexpr unsigned kSeeds = 300;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) {
        std::mt19937_64 random{seed};
        const std::size_t count =
            seed % 25 == 0 ? SampleBlocks::kBlock + 5000 : 1 + random() % 4000;
        const std::int64_t most =
            seed % 3 == 0 ? 3000000000 : 1 + static_cast<std::int64_t>(random() % 3);
        std::vector<Position> thirds;
        while (thirds.size() < count) {
            if (thirds.size() > 100 && random() % 3 == 0) {
                const std::size_t from = random() % thirds.size();
                const std::size_t length = random() % 500;
                for (std::size_t k = from; k < from + length; ++k) {
                    thirds.push_back(thirds[k]);
                }
            } else {
                const auto any = [&] {
                    return static_cast<std::int64_t>(random() %
                                                     static_cast<std::uint64_t>(2 * most + 1)) -
                           most;
                };
                for (std::size_t left = random() % 100; left > 0; --left) {
                    thirds.push_back({any(), any(), any()});
                }
            }
        }
        // Differences of the second order only: positions stay exact in double.
        std::vector<Position> points;
        Position at{};
        for (const Position& third : thirds) {
            at = at + third;
            points.push_back(at);
        }
        check_round_trip(points);
    }
}
