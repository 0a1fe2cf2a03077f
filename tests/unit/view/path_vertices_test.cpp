// The chords of each level stay as near to the set points as the level says.
#include "host_tools/judge/view/path_vertices.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/unit/view/inflated.hpp"

using namespace cusp;
using namespace cusp::view;

namespace {

struct Vertex {
    std::uint64_t tick;
    unsigned level;
    double deviation;
};

std::vector<Vertex> unpacked_vertices(const std::string& bytes)
{
    ByteReader reader{bytes};
    std::vector<Vertex> out(reader.whole(4));
    std::uint64_t tick = 0;
    for (Vertex& vertex : out) {
        tick += reader.varint();
        vertex.tick = tick;
    }
    for (Vertex& vertex : out) {
        vertex.level = static_cast<unsigned>(reader.whole(1));
    }
    for (Vertex& vertex : out) {
        vertex.deviation = static_cast<double>(reader.whole(2)) * 1e-5;
    }
    CHECK(reader.done());
    return out;
}

// A spiral at a steady speed, 1 ms a point.
std::vector<Position> spiral(int count)
{
    std::vector<Position> out;
    for (int k = 0; k < count; ++k) {
        const double angle = 0.002 * k;
        const double radius = 10 + 0.0005 * k;
        out.push_back({std::llround(1e6 * radius * std::cos(angle)),
                       std::llround(1e6 * radius * std::sin(angle)), -100 * k});
    }
    return out;
}

double to_chord(Vec3d p, Vec3d a, Vec3d b)
{
    const Vec3d chord = b - a;
    const double square = dot(chord, chord);
    const double share = square > 0 ? std::clamp(dot(p - a, chord) / square, 0.0, 1.0) : 0.0;
    return norm(p - a - share * chord);
}

}  // namespace

TEST_GROUP(PathVertices){};

TEST(PathVertices, OfEachLevelAreWithinItsTolerance)
{
    const std::vector<Position> points = spiral(30000);
    PathVertices path;
    for (const Position& point : points) {
        path.add(point, 0.0, false);
    }
    const std::vector<Vertex> vertices = unpacked_vertices(path.finish().text());
    CHECK_EQUAL(0U, vertices.front().tick);
    CHECK_EQUAL(points.size() - 1, vertices.back().tick);
    std::size_t last_count = points.size();
    for (unsigned level = 0; level < 5; ++level) {
        const double tolerance = PathVertices::kFinest * std::pow(4.0, level) * 1.0001;
        std::vector<std::uint64_t> kept;
        for (const Vertex& vertex : vertices) {
            if (vertex.level >= level) {
                kept.push_back(vertex.tick);
            }
        }
        for (std::size_t k = 1; k < kept.size(); ++k) {
            for (std::uint64_t tick = kept[k - 1]; tick <= kept[k]; ++tick) {
                CHECK(to_chord(xyz(to_millimetres(points[tick])),
                               xyz(to_millimetres(points[kept[k - 1]])),
                               xyz(to_millimetres(points[kept[k]]))) <= tolerance);
            }
        }
        CHECK(kept.size() < last_count);
        last_count = kept.size();
    }
}

TEST(PathVertices, StandWhereACornerIsAskedFor)
{
    PathVertices path;
    for (std::int64_t k = 0; k < 1000; ++k) {
        path.add({1000 * k, 0, 0}, 0.0, k == 400 || k == 401);
    }
    std::vector<std::uint64_t> ticks;
    for (const Vertex& vertex : unpacked_vertices(path.finish().text())) {
        ticks.push_back(vertex.tick);
    }
    CHECK(ticks == (std::vector<std::uint64_t>{0, 1, 400, 401, 999}) ||
          ticks == (std::vector<std::uint64_t>{0, 400, 401, 999}));
}

TEST(PathVertices, CarryTheGreatestDeviationSinceTheOneBefore)
{
    PathVertices path;
    for (std::int64_t k = 0; k < 1000; ++k) {
        path.add({1000 * k, 0, 0}, k == 777 ? 0.0123 : 0.001, k == 500);
    }
    const std::vector<Vertex> vertices = unpacked_vertices(path.finish().text());
    DOUBLES_EQUAL(0.0123, vertices.back().deviation, 1e-5);
    DOUBLES_EQUAL(0.001, vertices[vertices.size() - 2].deviation, 1e-5);
}

TEST(PathVertices, OfAMachineAtRestAreTwo)
{
    PathVertices path;
    for (int k = 0; k < 500; ++k) {
        path.add({7, 7, 7}, 0.0, false);
    }
    CHECK_EQUAL(2U, unpacked_vertices(path.finish().text()).size());
}
