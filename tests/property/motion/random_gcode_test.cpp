// Limits hold for random G-code: arcs of all planes, splines, inches, numbers of few decimals.
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/gcode/interpreter.hpp"
#include "tests/support/motion_limits.hpp"
#include "tests/support/random_moves.hpp"
#include "tests/support/random_program.hpp"

using namespace cusp;
using cusp::test::MotionRig;

namespace {

const std::uint64_t kSeed = test::first_motion_seed(8000);

struct Moves {
    std::vector<path::Move> moves;
    std::uint64_t refused{0};
    std::uint64_t curves{0};  // pieces of splines
};

Moves moves_of(std::uint64_t seed)
{
    gcode::Interpreter interpreter;
    Moves result;
    std::uint32_t number = 0;
    const test::RandomProgram program{seed};
    for (const std::string& line : program.lines()) {
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
