// Random programs by the time law: no axis over a limit in any tick, every end exact.
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/gcode/interpreter.hpp"
#include "tests/generators/random_moves.hpp"
#include "tests/generators/random_program.hpp"
#include "tests/judges/motion_limits.hpp"
#include "tests/support/law_rig.hpp"

using namespace cusp;
using namespace cusp::test;

namespace {

// Calls `judge` with the seed, the moves and the limits of random programs.
template <class Moves, class Judge>
void for_programs(std::uint64_t usual_first, std::uint64_t usual_count, Moves moves_of, Judge judge)
{
    const std::uint64_t first = first_motion_seed(usual_first);
    const std::uint64_t count = motion_program_count(usual_count);
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        const std::vector<path::Move> moves = moves_of(seed);
        if (!moves.empty()) {
            judge(seed, moves, random_limits(seed));
        }
    }
}

std::vector<path::Move> random_moves(std::uint64_t seed) { return RandomMoves{seed}.program(); }

// Arcs of all planes, splines, inches.
std::vector<path::Move> random_gcode(std::uint64_t seed)
{
    gcode::Interpreter interpreter;
    std::vector<path::Move> moves;
    std::uint32_t number = 0;
    const std::vector<std::string> lines = RandomProgram{seed}.lines();
    for (const std::string& line : lines) {
        (void)interpreter.execute(line, ++number);
        gcode::Action action;
        while (interpreter.next(action)) {
            if (const auto* move = std::get_if<path::Move>(&action)) {
                moves.push_back(*move);
            }
        }
    }
    return moves;
}

void check_whole(std::uint64_t seed,
                 const std::vector<path::Move>& moves,
                 const MachineLimits& limits)
{
    LawRig rig{limits};
    check_motion(rig.run(moves), moves.back().end, limits, seed);
    CHECK_TEXT(rig.blocked == 0, ("seed " + std::to_string(seed) + ": blocked").c_str());
}

}  // namespace

TEST_GROUP(LawLimits){};

TEST(LawLimits, random_moves_keep_every_limit)
{
    for_programs(88000, 100, random_moves, check_whole);
}

TEST(LawLimits, random_gcode_keeps_every_limit)
{
    for_programs(8000, 40, random_gcode, check_whole);
}

// Cut off after any window the plan in force ends in a crawl, and the crawl in a stop. From there
// the path goes on.
TEST(LawLimits, a_plan_that_nothing_follows_stops_within_every_limit)
{
    std::uint32_t rests = 0;
    for_programs(89050, 100, random_moves,
                 [&rests](std::uint64_t seed, const std::vector<path::Move>& moves,
                          const MachineLimits& limits) {
                     LawRig rig{limits};
                     check_motion(rig.run_starved(moves, 3 + static_cast<std::uint32_t>(seed % 9)),
                                  moves.back().end, limits, seed);
                     CHECK(rig.blocked == 0);
                     rests += rig.rests;
                 });
    CHECK(rests > 2 * motion_program_count(100));
}
