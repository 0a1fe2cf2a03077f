// Limits hold for random G-code: arcs of all planes, splines, inches, numbers of few decimals.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/gcode/interpreter.hpp"
#include "tests/generators/random_moves.hpp"
#include "tests/generators/random_program.hpp"
#include "tests/judges/motion_limits.hpp"

using namespace cusp;
using cusp::test::MotionRig;

namespace {

const std::uint64_t kSeed = test::first_motion_seed(8000);

struct Moves {
    std::vector<path::Move> moves;
    std::uint64_t refused{0};
    std::uint64_t curves{0};  // pieces of splines
};

Moves moves_of(const std::vector<std::string>& lines)
{
    gcode::Interpreter interpreter;
    interpreter.set_axes(kAxisCount);
    Moves result;
    std::uint32_t number = 0;
    for (const std::string& line : lines) {
        if (!interpreter.execute(line, ++number)) {
            ++result.refused;
        }
        gcode::Action action;
        while (interpreter.next(action)) {
            if (const auto* move = std::get_if<path::Move>(&action)) {
                result.moves.push_back(*move);
                result.curves += std::holds_alternative<path::BezierPiece>(move->path) ? 1U : 0U;
            }
        }
    }
    return result;
}

Moves moves_of(std::uint64_t seed) { return moves_of(test::RandomProgram{seed}.lines()); }

// A spline of mixed weights, mostly along one axis.
std::vector<std::string> weighted_spline(std::uint64_t seed, unsigned axis)
{
    std::mt19937_64 random{seed};
    const auto between = [&random](double low, double high) {
        return std::uniform_real_distribution<double>{low, high}(random);
    };
    std::vector<std::string> lines{"G21 G90 G64 P0.002 F6000"};
    const int order = 2 + static_cast<int>(random() % 4);
    const int points = order + 4;
    Vec3d at{};
    for (int i = 0; i < points; ++i) {
        for (unsigned k = 0; i > 0 && k < 3; ++k) {
            at[k] += (k == axis ? 1 : 0.3) * between(-6, 6);
        }
        std::array<char, 120> text;
        std::snprintf(text.data(), text.size(), "X%.4f Y%.4f Z%.4f R%.3f K%d", at.x, at.y, at.z,
                      std::pow(4, between(-1, 1)), std::max(0, i - order + 1));
        lines.push_back((i == 0 ? "G6.2 P" + std::to_string(order) + " " : "") + text.data());
    }
    lines.insert(lines.end(), static_cast<std::size_t>(order),
                 "K" + std::to_string(points - order + 1));
    return lines;
}

}  // namespace

TEST_GROUP(RandomGcode){};

TEST(RandomGcode, HoldsEveryLimitAndEndsExactly)
{
    std::uint64_t curves = 0;
    std::uint64_t refused = 0;
    for (std::uint64_t seed = kSeed; seed < kSeed + test::motion_program_count(); ++seed) {
        const Moves program = moves_of(seed);
        curves += program.curves;
        refused += program.refused;
        if (program.moves.empty()) {
            continue;
        }
        const MachineLimits limits = test::random_limits(seed);
        MotionRig rig{limits};
        rig.start_at({});
        test::check_motion(rig.run(program.moves), program.moves.back().end, limits, seed);
    }
    // The programs have the intended moves.
    CHECK(curves > test::motion_program_count());
    UNSIGNED_LONGS_EQUAL(0, refused);
}

TEST(RandomGcode, HoldsEveryLimitThroughHoldsOverridesAndStarvation)
{
    for (std::uint64_t seed = kSeed; seed < kSeed + test::motion_program_count(); ++seed) {
        const Moves program = moves_of(seed);
        if (program.moves.empty()) {
            continue;
        }
        const MachineLimits limits = test::random_limits(seed);
        MotionRig rig{limits};
        rig.start_at({});
        const auto samples = rig.run_disturbed(program.moves, seed);
        test::check_motion(samples, program.moves.back().end, limits, seed);
    }
}

// The slow axis has the least acceleration, the others so much that the axis filters are short: of
// what that axis may do, places on curves, rounded, take the largest part.
TEST(RandomGcode, HoldsLowAccelerationsOnCurves)
{
    for (std::uint64_t seed = kSeed; seed < kSeed + 3 * test::motion_program_count(); ++seed) {
        const auto slow = static_cast<unsigned>(seed % 3);
        const Moves program = moves_of(weighted_spline(seed, slow));
        UNSIGNED_LONGS_EQUAL(0, program.refused);
        std::mt19937_64 random{seed};
        const auto between = [&random](double low, double high) {
            return static_cast<float>(std::uniform_real_distribution<double>{low, high}(random));
        };
        MachineLimits limits{};
        for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
            limits.velocity[axis] = between(20, 200);
            limits.acceleration[axis] = axis == slow ? between(40, 80) : between(4000, 8000);
            limits.jerk[axis] = limits.acceleration[axis] * between(50, 300);
        }
        MotionRig rig{limits};
        rig.start_at({});
        test::check_motion(rig.run(program.moves), program.moves.back().end, limits, seed);
    }
}

// The spline turns within a radius of 0.8 um, between two rows of a cell.
TEST(RandomGcode, HoldsTheJerkInATurnBetweenRows)
{
    const Moves program = moves_of(
        {"G21 G90 F4576", "G1 X-2.84 Y-1.65 Z-5.2", "G6.2 P5 X-2.84 Y-1.65 Z-5.2 R1.355 K0",
         "X-2.9 Y-1.71 Z-5.2 R0.613 K0", "X-2.93 Y-1.63 Z-5.2 R0.333 K0",
         "X-2.88 Y-1.6 Z-5.2 R1 K0", "X-2.88 Y-1.58 Z-5.2 R1 K0", "X-2.88 Y-1.56 Z-5.2 R1 K1.5507",
         "X-2.86 Y-1.61 Z-5.2 R1 K2.4074", "X-2.85 Y-1.7 Z-5.2 R3.631 K4.0489",
         "X-2.82 Y-1.73 Z-5.2 R0.398 K4.7366", "X-2.77 Y-1.76 Z-5.13 R1.858 K5.6961",
         "X-2.77 Y-1.83 Z-5.16 R1.014 K5.6961", "K6.9782", "K6.9782", "K6.9782", "K6.9782",
         "K6.9782"});
    UNSIGNED_LONGS_EQUAL(0, program.refused);
    MachineLimits limits{};
    const std::array<std::array<float, 3>, 3> of_axes{
        {{15.63F, 376.9F, 15195.0F}, {43.08F, 2737.0F, 21284.0F}, {334.8F, 5064.0F, 101283.0F}}};
    for (unsigned axis = 0; axis < kLinearAxes; ++axis) {
        limits.velocity[axis] = of_axes[axis][0];
        limits.acceleration[axis] = of_axes[axis][1];
        limits.jerk[axis] = of_axes[axis][2];
    }
    MotionRig rig{limits};
    rig.start_at({});
    test::check_motion(rig.run(program.moves), program.moves.back().end, limits, 0);
}
