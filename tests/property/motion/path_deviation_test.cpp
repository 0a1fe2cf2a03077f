// The tool stays within the tolerance of the path, and comes within it of every corner.
#include <cstdlib>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/generators/random_moves.hpp"
#include "tests/judges/motion_limits.hpp"

using namespace cusp;
using cusp::test::MotionRig;
using cusp::test::RandomMoves;

namespace {

const std::uint64_t kSeed = test::first_motion_seed(41250);
// G61 promises 0.001 mm; rounding of set points is a nanometre.
constexpr double kExact = 0.001;
constexpr double kRounding = 3e-6;

struct Box {
    AxisVecd low, high;
};

// A move as chords, none farther from it than 2e-5 mm.
struct Chords {
    std::vector<AxisVecd> points;
    Box box;
};

double distance_to_segment(AxisVecd p, AxisVecd a, AxisVecd b)
{
    const AxisVecd along = b - a;
    const double square = dot(along, along);
    const double t = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0.0;
    return norm(p - a - along * t);
}

Chords chords_of(const path::Move& move)
{
    Chords chords;
    const AxisVecd start = to_millimetres(move.start);
    if (const auto* arc = std::get_if<path::Arc>(&move.path)) {
        const double step = std::sqrt(8 * 2e-5 / arc->radius);
        const int count = 1 + static_cast<int>(arc->sweep / step);
        for (int i = 0; i <= count; ++i) {
            const double t = static_cast<double>(i) / count;
            const double angle = t * arc->sweep;
            chords.points.push_back(start + arc->centre + arc->u * (arc->radius * std::cos(angle)) +
                                    arc->v * (arc->radius * std::sin(angle)) + arc->axial * t);
        }
    } else {
        chords.points = {start, to_millimetres(move.end)};
    }
    chords.box = {start, start};
    for (const AxisVecd& point : chords.points) {
        for (unsigned i = 0; i < kAxisCount; ++i) {
            chords.box.low[i] = std::min(chords.box.low[i], point[i]);
            chords.box.high[i] = std::max(chords.box.high[i], point[i]);
        }
    }
    return chords;
}

double distance_to_box(AxisVecd p, const Box& box)
{
    AxisVecd outside{};
    for (unsigned i = 0; i < kAxisCount; ++i) {
        outside[i] = std::max({box.low[i] - p[i], 0.0, p[i] - box.high[i]});
    }
    return norm(outside);
}

double distance_to_path(AxisVecd p, const std::vector<Chords>& path, double enough)
{
    double least = 1e9;
    for (const Chords& move : path) {
        if (distance_to_box(p, move.box) > least) {
            continue;
        }
        for (std::size_t i = 1; i < move.points.size(); ++i) {
            least = std::min(least, distance_to_segment(p, move.points[i - 1], move.points[i]));
            if (least < enough) {
                return least;
            }
        }
    }
    return least;
}

double distance_to_samples(AxisVecd p, const std::vector<Position>& samples)
{
    double least = 1e9;
    AxisVecd before = to_millimetres(samples.front());
    for (const Position& sample : samples) {
        const AxisVecd here = to_millimetres(sample);
        least = std::min(least, distance_to_segment(p, before, here));
        before = here;
    }
    return least;
}

using Moves = std::vector<path::Move>;
using Samples = std::vector<Position>;

Samples plain(const Moves& moves)
{
    MachineLimits limits{};
    limits.set_rotary(true);
    MotionRig rig{limits};
    rig.start_at({});
    return rig.run(moves);
}

void check_program(std::uint64_t seed,
                   double tolerance,
                   const std::function<Samples(const Moves&)>& run)
{
    auto moves = RandomMoves{seed}.program();
    if (moves.empty()) {
        return;
    }
    std::vector<Chords> path;
    for (path::Move& move : moves) {
        move.tolerance = static_cast<float>(tolerance);
        path.push_back(chords_of(move));
    }
    const Samples samples = run(moves);
    const double allowed = (tolerance > 0 ? tolerance : kExact) + kRounding;
    const std::string which = "seed " + std::to_string(seed);
    for (std::size_t i = 0; i < samples.size(); i += 3) {
        const AxisVecd here = to_millimetres(samples[i]);
        CHECK_TEXT(distance_to_path(here, path, 0.5 * allowed) <= allowed,
                   (which + ": off the path").c_str());
    }
    // Samples are points of a curve, which bulges out between them by at most a t^2/8 = 0.3 um.
    for (const path::Move& move : moves) {
        const double off = distance_to_samples(to_millimetres(move.end), samples);
        CHECK_TEXT(off <= allowed + 3e-4, (which + ": " + std::to_string(off) +
                                           " mm from the end of move " + std::to_string(move.line))
                                              .c_str());
    }
}

}  // namespace

TEST_GROUP(PathDeviation){};

TEST(PathDeviation, StaysWithinTheTolerance)
{
    for (std::uint64_t i = 0; i < test::motion_program_count(25); ++i) {
        check_program(kSeed + i, 0.002 * static_cast<double>(1 + i % 25), plain);
    }
}

TEST(PathDeviation, StaysWithinTheToleranceOnRandomMachines)
{
    for (std::uint64_t i = 0; i < test::motion_program_count(25); ++i) {
        const auto other = [i](const Moves& moves) {
            MotionRig rig{test::random_limits(kSeed + i)};
            rig.start_at({});
            return rig.run(moves);
        };
        check_program(kSeed + i, 0.002 * static_cast<double>(1 + i % 25), other);
    }
}

TEST(PathDeviation, StaysWithinTheToleranceBehindAnInputShaper)
{
    for (std::uint64_t i = 0; i < test::motion_program_count(25); ++i) {
        const auto shaped = [i](const Moves& moves) {
            MotionRig rig;
            rig.planner->set_shaper(test::random_shaper(kSeed + i));
            rig.start_at({});
            return rig.run(moves);
        };
        check_program(kSeed + i, i % 3 == 0 ? 0.0 : 0.002 * static_cast<double>(1 + i % 25),
                      shaped);
    }
}

TEST(PathDeviation, StaysOnTheExactPath)
{
    for (std::uint64_t i = 0; i < test::motion_program_count(25); ++i) {
        check_program(kSeed + i, 0.0, plain);
    }
}
