// The halves of cells that queries make: by several threads at once, and how many beside poor parametrizations.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>
#include <thread>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "host_tools/geometry/part_model/part_model.hpp"
#include "tests/support/leaks_on_threads.hpp"
#include "tests/support/three_tools.hpp"

using namespace cusp;
using namespace cusp::nurbs;
using namespace cusp::part_model;
using namespace cusp::test;
using namespace cusp::toolpath;

namespace {

// size x size points of degree 3, `pitch` mm apart, at random heights.
Surface rough_sheet(std::mt19937& random, int size, double pitch)
{
    std::uniform_real_distribution<double> height{-2, 2};
    Surface s;
    s.degree_u = s.degree_v = 3;
    for (std::vector<double>* const knots : {&s.knots_u, &s.knots_v}) {
        knots->assign(3, 0);
        for (int k = 0; k <= size - 3; ++k) {
            knots->push_back(k);
        }
        knots->insert(knots->end(), 3, size - 3);
    }
    s.size_u = s.size_v = size;
    for (int i = 0; i < size; ++i) {
        for (int j = 0; j < size; ++j) {
            s.points.push_back({pitch * i, pitch * j, height(random)});
        }
    }
    s.weights.assign(s.points.size(), 1.0);
    return s;
}

// A cubic strip whose first three rows of points coincide: the derivative along u vanishes with the
// square of u. The side u = 0 is an arc of radius `radius` about (0, y, radius), nearly.
Surface strip_with_coincident_rows(double radius)
{
    Surface s;
    s.degree_u = s.degree_v = 3;
    s.knots_u = s.knots_v = {0, 0, 0, 0, 1, 1, 1, 1};
    s.size_u = s.size_v = 4;
    constexpr double kHalf = 0.5;  // radians of the arc, to each side
    const double handle = 4.0 / 3.0 * std::tan(kHalf / 2);
    const Vec3d a{-radius * std::sin(kHalf), 0, radius * (1 - std::cos(kHalf))};
    const Vec3d b{-a.x, 0, a.z};
    const Vec3d along{radius * handle * std::cos(kHalf), 0, radius * handle * std::sin(kHalf)};
    const Vec3d rows[4]{a, {a.x + along.x, 0, a.z - along.z}, {b.x - along.x, 0, b.z - along.z}, b};
    for (int i = 0; i < 4; ++i) {
        for (const Vec3d& p : rows) {
            s.points.push_back(p + Vec3d{0, i == 3 ? 20.0 : 0.0, i == 3 ? 8.0 : 0.0});
        }
    }
    s.weights.assign(16, 1.0);
    return s;
}

Curve line(Vec2d a, Vec2d b) { return {1, {0, 0, 1, 1}, {{a.x, a.y, 0}, {b.x, b.y, 0}}, {1, 1}}; }

// From u = `from` on.
std::vector<std::vector<Curve>> trims_from(double from)
{
    return {{line({from, 0}, {1, 0}), line({1, 0}, {1, 1}), line({1, 1}, {from, 1}),
             line({from, 1}, {from, 0})}};
}

// A quarter of a cylinder about z, from z = 0 up.
Surface upright_quarter(double radius, double high, double trimmed_from)
{
    Surface s;
    s.degree_u = 2;
    s.degree_v = 1;
    s.size_u = 3;
    s.size_v = 2;
    s.knots_u = {0, 0, 0, 1, 1, 1};
    s.knots_v = {0, 0, 1, 1};
    for (const Vec2d p : {Vec2d{radius, 0}, Vec2d{radius, radius}, Vec2d{0, radius}}) {
        s.points.push_back({p.x, p.y, 0});
        s.points.push_back({p.x, p.y, high});
        s.weights.insert(s.weights.end(), 2, p.x == p.y ? std::sqrt(0.5) : 1.0);
    }
    s.trims = trims_from(trimmed_from);
    return s;
}

// A level square of 2 mm that begins at `edge`, in plan, and lies beyond.
Surface plate_from(Vec3d edge, Vec3d beyond, double z)
{
    Surface s;
    s.degree_u = s.degree_v = 1;
    s.size_u = s.size_v = 2;
    s.knots_u = s.knots_v = {0, 0, 1, 1};
    const Vec3d aside{-beyond.y, beyond.x, 0};
    for (const double u : {0.0, 2.0}) {
        for (const double v : {-1.0, 1.0}) {
            const Vec3d p = edge + beyond * u + aside * v;
            s.points.push_back({p.x, p.y, z});
            s.weights.push_back(1);
        }
    }
    s.trims = trims_from(0);
    return s;
}

}  // namespace

TEST_GROUP(Cells){};

// 200 000 halves are many.
TEST(Cells, AreNotReleasedWhileThreadsShareTheModel)
{
    constexpr unsigned kSeed = 4;
    std::printf("seed %u ", kSeed);
    std::mt19937 random{kSeed};
    const PartModel model{{rough_sheet(random, 60, 2.0)}};
    std::uniform_real_distribution<double> at{0, 118};
    std::vector<Vec3d> tips(6000);
    for (Vec3d& tip : tips) {
        tip = {at(random), at(random), 0.05 * at(random)};
    }
    std::vector<double> alone;
    for (const Vec3d& tip : tips) {
        model.forget_queries();
        alone.push_back(model.distance(kBall, tip, 100).distance);
    }
    const std::size_t made = model.kept_cells();
    CHECK(made > 200'000);
    model.forget_many_cells();
    LONGS_EQUAL(0, model.kept_cells());

    std::vector<int> different(3, 0);
    std::vector<std::thread> threads;
    {
        const PartModel::SharedQueries shared{model};
        for (int& count : different) {
            threads.emplace_back([&] {
                for (std::size_t k = 0; k < tips.size(); ++k) {
                    model.forget_queries();
                    model.forget_many_cells();
                    count += model.distance(kBall, tips[k], 100).distance == alone[k] ? 0 : 1;
                }
            });
        }
        for (std::thread& thread : threads) {
            thread.join();
        }
        LONGS_EQUAL(made, model.kept_cells());
    }
    for (const int count : different) {
        LONGS_EQUAL(0, count);
    }
    model.forget_many_cells();
    LONGS_EQUAL(0, model.kept_cells());
}

// Parts release cells among them, and answer as one thread that keeps all does.
TEST(Cells, AreReleasedBetweenPartsOfALoop)
{
    constexpr unsigned kSeed = 5;
    std::printf("seed %u ", kSeed);
    std::mt19937 random{kSeed};
    const PartModel model{{rough_sheet(random, 60, 2.0)}};
    std::uniform_real_distribution<double> at{0, 118};
    std::vector<Vec3d> tips(5000);
    for (Vec3d& tip : tips) {
        tip = {at(random), at(random), 0.05 * at(random)};
    }
    std::vector<double> alone;
    for (const Vec3d& tip : tips) {
        model.forget_queries();
        alone.push_back(model.distance(kBall, tip, 100).distance);
    }
    CHECK(model.kept_cells() > 220'000);
    std::vector<int> different(3, 0);
    std::vector<std::size_t> most(3, 0);
    std::vector<std::thread> threads;
    {
        const PartModel::SharedQueries shared{model};
        for (std::size_t thread = 0; thread < 3; ++thread) {
            threads.emplace_back([&, thread] {
                // A part for each query; and one that is long, for all.
                std::optional<PartModel::SharedQueries::Part> part;
                for (std::size_t k = 0; k < tips.size(); ++k) {
                    if (k == 0 || thread > 0) {
                        part.reset();
                        part.emplace(model);
                    } else {
                        part->next();
                    }
                    different[thread] +=
                        model.distance(kBall, tips[k], 100).distance == alone[k] ? 0 : 1;
                    most[thread] = std::max(most[thread], model.kept_cells());
                }
            });
        }
        for (std::thread& thread : threads) {
            thread.join();
        }
    }
    for (std::size_t thread = 0; thread < 3; ++thread) {
        LONGS_EQUAL(0, different[thread]);
        CHECK(most[thread] < 202'000);  // 200 000 are many
    }
    LONGS_EQUAL(0, model.kept_cells());
}

// The nearest point of a whole cylinder is trimmed away, and as near all along it. The trim is just
// beyond the limit: a proof halves all cells along it. It was made even where the edge of a plate is
// nearer.
TEST(Cells, AreFewAlongALongTrimWhereAnEdgeIsNearer)
{
    constexpr double kTrim = 0.437;
    const Surface wall = upright_quarter(10, 400, kTrim);
    const Vec3d on_trim = PartModel{{wall}}.evaluate(0, kTrim, 0.5).point;
    for (int k = 0; k < 10; ++k) {
        const double turned = std::atan2(on_trim.y, on_trim.x) - 0.03 - 0.01 * k;
        const Vec3d out{std::cos(turned), std::sin(turned), 0};
        const Vec3d tip = out * 8.0 - Vec3d{0, 0, 10};
        const double trim = std::hypot(tip.x - on_trim.x, tip.y - on_trim.y);
        const double least = trim - 1e-3 - kBall.radius;
        const Surface plate = plate_from(tip - out * (trim - 0.3), out * -1.0, 395);

        const PartModel alone{{wall}};
        CHECK(alone.is_distance_at_least(kBall, tip, least));
        CHECK(alone.kept_cells() > 1000);

        const PartModel beside_plate{{wall, plate}};
        CHECK_FALSE(beside_plate.is_distance_at_least(kBall, tip, least));
        CHECK(beside_plate.kept_cells() < 400);
    }
}

// Halved by length alone the strips beside the side took tens of thousands.
TEST(Cells, AreFewWhereRowsOfPointsCoincide)
{
    constexpr double kRadius = 6;
    const PartModel model{{strip_with_coincident_rows(kRadius)}};
    for (int k = 0; k < 40; ++k) {
        model.forget_cells();
        const Vec3d tip{0.05 * k, -6.0, 0.02 * k};
        const double found = model.distance(kBall, tip, 100).distance;
        // The nearest point is on the side.
        double dense = 1e9;
        for (int i = 0; i <= 20'000; ++i) {
            const Vec3d p = model.evaluate(0, 0, i / 20'000.0).point;
            dense = std::min(dense, norm(p - (tip + Vec3d{0, 0, 3})) - 3);
        }
        DOUBLES_EQUAL(dense, found, 1e-6);
        CHECK(model.kept_cells() < 1000);
    }
}
