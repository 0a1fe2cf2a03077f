// Fixtures: distances and paths against points sampled closely.
#include "host_tools/job/job/fixture_clearance.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "CppUTest/TestHarness.h"

#include "host_tools/geometry/toolpath/toolpath_measure.hpp"

using namespace cusp;
using namespace cusp::job;
using namespace cusp::toolpath;

namespace {

constexpr double kTop = 0;
constexpr double kClearance = 20;
constexpr double kRadius = 3;

// True if the tool's cylinder over the tip meets the grown body: looked up, not computed with.
bool inside(const Fixture& f, double radius, Vec3d p, double by)
{
    if (p.z >= f.top + f.margin - by) {
        return false;
    }
    const double x = std::clamp(p.x, f.low.x, f.high.x);
    const double y = std::clamp(p.y, f.low.y, f.high.y);
    return std::hypot(p.x - x, p.y - y) < f.radius + f.margin + radius - by;
}

bool path_hits(const Job& job, const Toolpath& path, double by)
{
    Vec3d at{path.moves.empty() ? Vec3d{} : end_of(path.moves.front())};
    for (const ToolMove& move : path.moves) {
        for (const Vec3d to : points_of(move, at, 1e-3)) {
            const int steps = 1 + static_cast<int>(norm(to - at) / 0.02);
            for (int k = 0; k <= steps; ++k) {
                const Vec3d p = at + (static_cast<double>(k) / steps) * (to - at);
                for (const Fixture& fixture : job.fixtures) {
                    if (inside(fixture, path.tool.radius, p, by)) {
                        return true;
                    }
                }
            }
            at = to;
        }
    }
    return false;
}

class RandomScene {
public:
    explicit RandomScene(unsigned seed) : random_{seed} {}

    Job job()
    {
        Job job;
        job.stock_top = kTop;
        job.clearance = kClearance;
        const int count = 1 + static_cast<int>(random_() % 3);
        for (int i = 0; i < count; ++i) {
            Fixture f;
            f.name = "clamp " + std::to_string(i);
            f.low = {between(-20, 20), between(-20, 20)};
            f.high = f.low;
            if (random_() % 2 == 0) {
                f.high = {f.low.x + between(0.1, 10), f.low.y + between(0.1, 10)};
            } else {
                f.radius = between(0.1, 5);
            }
            f.top = between(-5, 15);
            f.margin = between(0, 2);
            job.fixtures.push_back(f);
        }
        return job;
    }

    Vec3d place(double z) { return {between(-25, 25), between(-25, 25), z}; }

    // Passes of one cut each, a plunge to the first, links between them: lines and arcs.
    Toolpath path()
    {
        Toolpath path;
        path.tool = {1, ToolShape::kFlat, kRadius, 0};
        Vec3d at = place(-2);
        path.moves.push_back({MoveKind::kRapid, LineTo{{at.x, at.y, kClearance}}});
        path.moves.push_back({MoveKind::kPlunge, LineTo{at}});
        const int passes = 1 + static_cast<int>(random_() % 3);
        for (int i = 0; i < passes; ++i) {
            at = at + Vec3d{between(-2, 2), between(-2, 2), 0};
            path.moves.push_back({MoveKind::kCut, LineTo{at}});
            const int links = static_cast<int>(random_() % 3);
            for (int k = 0; k < links; ++k) {
                const Vec3d to = place(-2);
                if (random_() % 2 == 0) {
                    path.moves.push_back({MoveKind::kLink, LineTo{to}});
                } else {
                    const Vec3d middle = 0.5 * (at + to);
                    path.moves.push_back(
                        {MoveKind::kLink, ArcTo{to, middle, ArcPlane::kXY, random_() % 2 == 0}});
                }
                at = to;
            }
        }
        path.moves.push_back({MoveKind::kRapid, LineTo{{at.x, at.y, kClearance}}});
        return path;
    }

    double between(double low, double high)
    {
        return std::uniform_real_distribution<>{low, high}(random_);
    }

private:
    std::mt19937 random_;
};

std::vector<Vec3d> cuts_of(const Toolpath& path)
{
    std::vector<Vec3d> ends;
    for (const ToolMove& move : path.moves) {
        if (move.kind == MoveKind::kCut) {
            ends.push_back(end_of(move));
        }
    }
    return ends;
}

}  // namespace

TEST_GROUP(FixtureClearance){};

TEST(FixtureClearance, DistancesAreSafeAndChangeNoFasterThanTheTip)
{
    constexpr unsigned kSeed = 1;
    std::printf(" seed %u", kSeed);
    RandomScene scene{kSeed};
    for (int i = 0; i < 5000; ++i) {
        const Fixture fixture = scene.job().fixtures.front();
        const Vec3d a = scene.place(scene.between(-10, 20));
        const Vec3d b = a + Vec3d{scene.between(-1, 1), scene.between(-1, 1), scene.between(-1, 1)};
        const double at_a = distance_to(fixture, kRadius, a);
        CHECK(std::abs(at_a - distance_to(fixture, kRadius, b)) <= norm(b - a) + 1e-9);
        CHECK_EQUAL(inside(fixture, kRadius, a, 0), at_a < 0);
    }
}

// The oracle samples the path as it is afterwards. A path that is refused has a cut in a fixture.
TEST(FixtureClearance, PathsKeepOffOrAreRefused)
{
    constexpr unsigned kSeed = 2;
    std::printf(" seed %u", kSeed);
    RandomScene scene{kSeed};
    int led = 0;
    int refused = 0;
    for (int i = 0; i < 2000; ++i) {
        const Job job = scene.job();
        const Toolpath given = scene.path();
        Toolpath path = given;
        try {
            const int over = keep_off_fixtures(job, "operation 1", path);
            led += over > 0 ? 1 : 0;
            CHECK(!path_hits(job, path, 0.002));
            CHECK(cuts_of(path).size() == cuts_of(given).size());
            const auto same = [](Vec3d a, Vec3d b) {
                return norm(a - b) == 0;
            };
            const auto before = cuts_of(given);
            const auto after = cuts_of(path);
            CHECK(std::equal(before.begin(), before.end(), after.begin(), same));
            CHECK(over > 0 || !path_hits(job, given, 0.002));
        } catch (const InputError& error) {
            ++refused;
            CHECK(path_hits(job, given, 0));
            CHECK(std::string{error.what()}.find("would touch clamp") != std::string::npos);
        }
    }
    CHECK(led > 100);
    CHECK(refused > 100);
}

TEST(FixtureClearance, WithoutFixturesNothingChanges)
{
    RandomScene scene{3};
    Job job = scene.job();
    job.fixtures.clear();
    Toolpath path = scene.path();
    const std::size_t moves = path.moves.size();
    CHECK_EQUAL(0, keep_off_fixtures(job, "operation 1", path));
    CHECK_EQUAL(moves, path.moves.size());
}
