// Times found part by part are those of the whole program, by one run that counts ticks.
#include "host_tools/controller/simulate/simulated_times.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "firmware/base/pulse_frame.hpp"
#include "host_tools/base/parallel/parallel.hpp"
#include "host_tools/controller/program_run/program_run.hpp"
#include "host_tools/controller/simulate/program_parts.hpp"
#include "tests/support/leaks_on_threads.hpp"
#include "tests/support/property_cases.hpp"

#include "fmt/format.h"

namespace {

using namespace cusp;
using simulate::program_parts;
using simulate::simulated_times;

constexpr double kPart = 4;  // s

// Contours of short lines and arcs between lifts, as planners write them.
class RandomContours {
public:
    explicit RandomContours(std::uint64_t seed) : random_{seed} {}

    // Two operations; begins receives their offsets.
    std::string program(std::vector<std::size_t>& begins)
    {
        std::string text = pick(2) == 0 ? "G20\n" : "G21\n";
        unit_ = text == "G20\n" ? 1 / 25.4 : 1.0;
        text += fmt::format("G90 G94 G17 G40 G49 G54\nG0 Z{:.5f}\n", 5 * unit_);
        text += pick(2) == 0 ? "G61\n" : fmt::format("G64 P{:.5f}\n", 0.01 * unit_);
        for (int operation = 0; operation < 2; ++operation) {
            begins.push_back(text.size());
            text += fmt::format("T{}\nM3 S{}\n", operation + 1, 8000 + 1000 * operation);
            for (unsigned contour = 0; contour < 3 + pick(5); ++contour) {
                text += this->contour();
            }
        }
        return text + "M5\nM30\n";
    }

private:
    unsigned pick(unsigned below) { return static_cast<unsigned>(random_() % below); }
    double real(double from, double to)
    {
        return from + (to - from) * static_cast<double>(random_() >> 11) * 0x1p-53;
    }

    std::string contour()
    {
        const double x = real(0, 60);
        const double y = real(0, 60);
        const double radius = real(2, 20);
        std::string text =
            fmt::format("G0 X{:.5f} Y{:.5f}\nG0 Z{:.5f}\nG1 Z{:.5f} F{:.3f}\n",
                        (x + radius) * unit_, y * unit_, unit_, -1 * unit_, real(100, 400) * unit_);
        text += fmt::format("F{:.3f}\n", real(300, 2000) * unit_);
        if (pick(3) == 0) {
            text += fmt::format("G3 X{:.5f} Y{:.5f} I{:.5f} J0\n", (x + radius) * unit_, y * unit_,
                                -radius * unit_);
        } else {
            const unsigned points = 20 + pick(300);
            const double wave = real(0, 0.2);
            for (unsigned k = 1; k <= points; ++k) {
                const double angle = 2 * M_PI * k / points;
                const double r = radius * (1 + wave * std::sin(5 * angle));
                text += fmt::format("G1 X{:.5f} Y{:.5f}\n", (x + r * std::cos(angle)) * unit_,
                                    (y + r * std::sin(angle)) * unit_);
            }
        }
        return text + fmt::format("G0 Z{:.5f}\n", 5 * unit_);
    }

    std::mt19937_64 random_;
    double unit_{1};
};

// s of each operation: one run, its set points counted by line.
std::vector<double> counted_times(const std::string& program,
                                  const std::vector<std::size_t>& begins)
{
    std::vector<double> seconds(begins.size(), 0);
    program_run::RunOptions options;
    std::size_t operation = 0;
    options.set_point = [&](const program_run::SetPoint& point) {
        for (std::size_t k = 0; k < begins.size() && point.line != 0; ++k) {
            const auto end = program.begin() + static_cast<std::ptrdiff_t>(begins[k]);
            if (static_cast<std::int64_t>(point.line) > std::count(program.begin(), end, '\n')) {
                operation = k;
            }
        }
        seconds[operation] += 1.0 / kServoTicksPerSecond;
    };
    auto source = dialect::LineSource::of_text("the program", program);
    program_run::ProgramRun run{source, options};
    while (run.advance()) {
    }
    for (const program_run::RunError& error : run.result().errors) {
        FAIL(fmt::format("line {}: {}", error.line, error.text).c_str());
    }
    return seconds;
}

TEST_GROUP(SimulatedTimes){};

// s that times of parts may differ: the ticks at both ends of a part that begins with a lift;
// elsewhere several lines are one smooth piece, and the set points on it have the number of one.
double most_difference(const std::string& program)
{
    constexpr double kOfLift = 0.001;
    constexpr double kOfPiece = 0.3;
    double sum = 0;
    for (const simulate::ProgramPart& part : program_parts(program, kPart)) {
        sum += program.compare(part.begin, 4, "G0 Z") == 0 ? kOfLift : kOfPiece;
    }
    return sum;
}

std::string difference(unsigned seed, std::size_t& parts)
{
    std::vector<std::size_t> begins;
    const std::string program = RandomContours{seed}.program(begins);
    parts += program_parts(program, kPart).size();
    const std::vector<double> whole = counted_times(program, begins);
    const auto found = simulated_times(program, begins, {}, kPart);
    if (!found) {
        return fmt::format("seed {}: refused", seed);
    }
    for (std::size_t k = 0; k < begins.size(); ++k) {
        if (std::fabs((*found)[k].seconds - whole[k]) > most_difference(program)) {
            return fmt::format("seed {}: operation {} takes {} s, by parts {}", seed, k, whole[k],
                               (*found)[k].seconds);
        }
    }
    return "";
}

TEST(SimulatedTimes, OfPartsAreThoseOfTheWholeProgram)
{
    std::size_t parts = 0;
    const int cases = test::property_cases(4);
    STRCMP_EQUAL("", test::broken_cases(test::property_seed(1), cases, [&](unsigned seed) {
                         return difference(seed, parts);
                     }).c_str());
    CHECK(parts > 3 * static_cast<std::size_t>(cases));
}

TEST(SimulatedTimes, AreTheSameForAnyNumberOfThreads)
{
    std::vector<std::size_t> begins;
    const std::string program = RandomContours{11}.program(begins);
    std::vector<std::vector<double>> found;
    for (const int threads : {1, 2, 5}) {
        parallel::set_threads(threads);
        std::vector<double>& seconds = found.emplace_back();
        const auto times = simulated_times(program, begins, {}, kPart);
        for (const auto& [all, rapid] : times.value()) {
            seconds.insert(seconds.end(), {all, rapid});
        }
    }
    CHECK(found[0] == found[1]);
    CHECK(found[0] == found[2]);
}

// `before`, then 40 lifts with 1 s of cutting each.
std::string lifts_after(const std::string& before)
{
    std::string text = "G21 G90\n" + before + "F600\n";
    for (int k = 0; k < 40; ++k) {
        text += fmt::format("G0 Z1\nG1 X{}\nG0 Z5\n", k % 2 == 0 ? 10 : 0);
    }
    return text;
}

TEST(SimulatedTimes, PartsBeginOnlyWhereAFewWordsRestoreTheState)
{
    CHECK(program_parts(lifts_after(""), kPart).size() > 5);
    CHECK(program_parts(lifts_after("G55\nG19 G64 P0.02\nM4 S500\nM7\n"), kPart).size() > 5);
    for (const char* const before :
         {"G91\n", "G92 X1\n", "G43.1 Z2\n", "G10 L2 P1 X1\n", "G38.3 Z-1 F10\n", "$X\n"}) {
        LONGS_EQUAL_TEXT(1, program_parts(lifts_after(before), kPart).size(), before);
    }
    LONGS_EQUAL(1, program_parts("", kPart).size());
    LONGS_EQUAL(1, program_parts("G0 X1\nnonsense\n" + lifts_after(""), kPart).size());
}

TEST(SimulatedTimes, TheHeadOfAPartRestoresTheState)
{
    const auto parts = program_parts(lifts_after("G55\nG19 G64 P0.02\nM4 S500\nM7\n"), kPart);
    STRCMP_EQUAL(
        "G21 G90 G94 G55 G64 P0.0199999996\nG0 X0.000000 Y0.000000 Z1.000000\nT0 S500\nM4\n"
        "M7\nG1 F600\nG19 G21\n",
        parts.at(1).head.c_str());
    LONGS_EQUAL(7, parts.at(1).head_lines);
    LONGS_EQUAL(0, parts.at(1).line_of(7));
    LONGS_EQUAL(parts.at(1).first_line, parts.at(1).line_of(8));
}

// Each line of such a program has its own motion word, so the line alone says what it is.
TEST(SimulatedTimes, RapidMovesAreThoseOfTheLinesThatSayG0)
{
    const std::string program =
        lifts_after("") + "G0 Z5\nX3 (G1 no move)\nG17 G0 Y20\nG1 Y10\nG4 P0.1\n";
    double rapid = 0;
    program_run::RunOptions options;
    std::vector<bool> is_rapid{false};
    std::istringstream lines{program};
    for (std::string line; std::getline(lines, line);) {
        is_rapid.push_back(line.find("G0") != std::string::npos || line[0] == 'X');
    }
    std::uint32_t at = 0;
    options.set_point = [&](const program_run::SetPoint& point) {
        at = point.line != 0 ? point.line : at;
        rapid += is_rapid[at] ? 1.0 / kServoTicksPerSecond : 0.0;
    };
    auto source = dialect::LineSource::of_text("the program", program);
    program_run::ProgramRun run{source, options};
    while (run.advance()) {
    }
    CHECK(run.result().good());
    const auto found = simulated_times(program, {0}, {});
    DOUBLES_EQUAL(rapid, found.value()[0].rapid_s, 1e-9);
    CHECK(rapid > 1 && rapid < found.value()[0].seconds - 10);
}

TEST(SimulatedTimes, ARefusedProgramHasNone)
{
    CHECK_FALSE(simulated_times(lifts_after("") + "G0 X\n", {0}, {}, kPart).has_value());
}

TEST(SimulatedTimes, ProgressEndsWithAll)
{
    double last = 0;
    const auto take = [&last](double share) {
        CHECK(share >= last - 1e-9);
        last = share;
    };
    CHECK(simulated_times(lifts_after(""), {0}, take, kPart).has_value());
    DOUBLES_EQUAL(1, last, 1e-3);
}

}  // namespace
