// Whole programs by the time law: limits, ends, and times that must not rise.
//
// CUSP_LAW_PROGRAM=FILE adds a program, CUSP_LAW_FEED=MM_A_MINUTE replaces all feeds of it,
// CUSP_LAW_SAMPLES=FOLDER writes every run's set points as FOLDER/PROGRAM-MACHINE.csv, and
// CUSP_LAW_TABLE prints the times.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/gcode/interpreter.hpp"
#include "tests/judges/motion_limits.hpp"
#include "tests/support/motion_rig.hpp"

using namespace cusp;
using namespace cusp::test;

namespace {

constexpr float kTolerance = 0.01F;  // mm

struct Machine {
    const char* name;
    MachineLimits limits;
    float feed;  // mm/s, of all feed moves; 0: the program's
};

// Times those of the default machine.
MachineLimits limits_by(float velocity, float acceleration, float jerk)
{
    MachineLimits limits;
    limits.velocity = limits.velocity * velocity;
    limits.acceleration = limits.acceleration * acceleration;
    limits.jerk = limits.jerk * jerk;
    return limits;
}

const std::vector<Machine>& machines()
{
    static const std::vector<Machine> all{{"default", {}, 0},
                                          {"slow", limits_by(0.5F, 0.2F, 0.04F), 0},
                                          {"fast", limits_by(5, 5, 10), 500}};
    return all;
}

const char* option(const char* name)
{
    const char* text = std::getenv(name);
    return text != nullptr ? text : "";
}

std::vector<path::Move> read_program(std::istream& in, float feed)
{
    gcode::Interpreter interpreter;
    interpreter.set_default_tolerance(kTolerance);
    std::vector<path::Move> moves;
    std::string line;
    std::uint32_t number = 0;
    while (std::getline(in, line)) {
        while (!line.empty() && (line.back() == '\r' || line.back() == '\n')) {
            line.pop_back();
        }
        if (line != "%") {
            (void)interpreter.execute(line, ++number);
        }
        gcode::Action action;
        while (interpreter.next(action)) {
            if (const auto* move = std::get_if<path::Move>(&action)) {
                moves.push_back(*move);
                const bool is_feed = move->kind == path::MoveKind::kFeed;
                moves.back().feed = is_feed && feed > 0 ? feed : move->feed;
            }
        }
    }
    return moves;
}

void write_samples(const std::string& file, const std::vector<Position>& samples)
{
    std::FILE* out = std::fopen(file.c_str(), "w");
    CHECK(out != nullptr);
    std::fprintf(out, "t_us,x_nm,y_nm,z_nm\n");
    for (std::size_t i = 0; i < samples.size(); ++i) {
        std::fprintf(out, "%zu,%lld,%lld,%lld\n", (i + 1) * 1000,
                     static_cast<long long>(samples[i].x), static_cast<long long>(samples[i].y),
                     static_cast<long long>(samples[i].z));
    }
    std::fclose(out);
}

// From the first to the last moving tick, s.
double duration(const std::vector<Position>& samples, Position at)
{
    std::size_t first = samples.size();
    std::size_t last = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (samples[i] != at) {
            first = std::min(first, i);
            last = i;
        }
        at = samples[i];
    }
    return 1e-3 * static_cast<double>(last + 1 - first);
}

// The time of a program on a machine, s; its limits and its end are checked.
double time_of_program(std::istream& in, const std::string& program, const Machine& machine)
{
    const std::vector<path::Move> moves = read_program(in, machine.feed);
    CHECK(!moves.empty());
    MotionRig rig{machine.limits};
    const Position start = moves.front().start;
    rig.start_at(start);
    const std::vector<Position> samples = rig.run(moves);
    const LimitUse use = limit_use(samples, start, machine.limits);
    const std::string name = program + "-" + machine.name;
    for (unsigned axis = 0; axis < kAxisCount; ++axis) {
        CHECK_TEXT(use.velocity[axis] <= 1, name.c_str());
        CHECK_TEXT(use.acceleration[axis] <= 1, name.c_str());
        CHECK_TEXT(use.jerk[axis] <= 1, name.c_str());
    }
    CHECK_TEXT(samples.back() == moves.back().end, name.c_str());
    const double time = duration(samples, start);
    if (*option("CUSP_LAW_TABLE") != '\0') {
        std::printf("%-40s %8.3f s\n", name.c_str(), time);
    }
    if (*option("CUSP_LAW_SAMPLES") != '\0') {
        write_samples(option("CUSP_LAW_SAMPLES") + ("/" + name) + ".csv", samples);
    }
    return time;
}

double time_of_program(const std::string& file, const Machine& machine)
{
    std::ifstream in{file};
    return time_of_program(in, file.substr(file.rfind('/') + 1), machine);
}

// Lines of one length on the exact path, each turned by some degrees from the one before: all the same way, or to and fro.
std::string lines_that_turn(double length, double turn, unsigned count, int feed, bool to_and_fro)
{
    constexpr double kDegree = 0.017453292519943295;
    std::string text = "G61\nG1 F" + std::to_string(feed) + "\n";
    double x = 0;
    double y = 0;
    double heading = 0;
    for (unsigned i = 0; i < count; ++i) {
        heading += to_and_fro && i % 2 == 0 ? -turn : turn;
        x += length * std::cos(heading * kDegree);
        y += length * std::sin(heading * kDegree);
        text += "X" + std::to_string(x) + "Y" + std::to_string(y) + "\n";
    }
    return text;
}

}  // namespace

TEST_GROUP(LawPrograms){};

TEST(LawPrograms, hold_the_limits_within_their_times)
{
    struct Row {
        const char* program;
        double most[3];  // s, on each machine
    };
    constexpr Row kRows[] = {
        {"circle", {1.29, 2.74, 0.475}}, {"liss", {9.33, 17.08, 2.51}},
        {"rsq", {3.99, 8.64, 1.208}},    {"sine3dec_0p03", {1.2, 2.38, 0.447}},
        {"spiral", {9.5, 18.38, 3.0}},   {"square", {2.47, 5.35, 0.85}},
        {"surf3d", {20.2, 34.2, 6.2}},
    };
    for (const Row& row : kRows) {
        const std::string file =
            std::string{CUSP_SOURCE_DIR} + "/tests/programs/" + row.program + ".ngc";
        for (std::size_t i = 0; i < machines().size(); ++i) {
            const double time = time_of_program(file, machines()[i]);
            const std::string which = row.program + (" " + std::to_string(time));
            CHECK_TEXT(time <= row.most[i], which.c_str());
        }
    }
    if (*option("CUSP_LAW_PROGRAM") != '\0') {
        for (Machine machine : machines()) {
            const float feed = std::strtof(option("CUSP_LAW_FEED"), nullptr) / 60.0F;
            machine.feed = feed > 0 && machine.feed <= 0 ? feed : machine.feed;
            (void)time_of_program(option("CUSP_LAW_PROGRAM"), machine);
        }
    }
}

// Turns within reach of the filters count together, those farther off do not, however dense the lines are.
TEST(LawPrograms, lines_that_turn_a_little_are_passed_on_the_exact_path)
{
    struct Row {
        double length;
        double turn;
        unsigned count;
        int feed;
        bool to_and_fro;
        double most;  // s, on the default machine
    };
    constexpr Row kRows[] = {
        {0.105, 0.3, 1200, 3000, false, 6.4}, {0.785, 0.45, 800, 6000, false, 13.0},
        {0.1, 0.3, 800, 3000, true, 4.4},     {0.5, 0.3, 100, 3000, true, 1.4},
        {0.005, 0.45, 800, 3000, true, 4.2},
    };
    for (const Row& row : kRows) {
        const std::string text =
            lines_that_turn(row.length, row.turn, row.count, row.feed, row.to_and_fro);
        for (const Machine& machine : machines()) {
            std::istringstream in{text};
            const double time = time_of_program(in, std::to_string(row.length), machine);
            CHECK_TEXT(time <= row.most || &machine != &machines().front(),
                       std::to_string(time).c_str());
        }
    }
}
