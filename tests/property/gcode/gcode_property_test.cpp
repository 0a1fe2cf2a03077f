// Random programs keep the interpreter's promises: moves join, refused lines leave no trace, pieces
// of curves have their tables. CUSP_GCODE_PROGRAMS sets how many; the seed is fixed and printed.
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/judges/gcode_promises.hpp"

namespace {

constexpr unsigned kSeed = 20;

class RandomLines {
public:
    std::string next()
    {
        const std::vector<const char*> starts = {
            "G0",  "G1",    "G2",   "G3",    "G91",   "G90", "G20",   "G21",     "G17",
            "G18", "G19",   "G5.2", "G5.3",  "G6.2",  "G81", "G82",   "G83",     "G80",
            "G10", "G92",   "G28",  "G93",   "G94",   "G64", "G61",   "G38.3",   "G53",
            "G55", "G43.1", "G49",  "M3",    "M30",   "G99", "G4",    "G73",     "G85",
            "G86", "G89",   "G52",  "G90.1", "G91.1", "G43", "G80G0", "M3S9G86", ""};
        std::string line = starts[random_() % starts.size()];
        const unsigned words = static_cast<unsigned>(random_() % 5);
        for (unsigned i = 0; i < words; ++i) {
            const std::string letters = "XYZXYZXYZXYZFFIJKRPQLNSTAB";
            line += letters[random_() % letters.size()];
            line += number();
        }
        if (random_() % 40 == 0) {
            line.insert(random_() % (line.size() + 1), 1, static_cast<char>(random_() % 256));
        }
        return line;
    }
    // A curve, valid or with one fault.
    std::vector<std::string> curve()
    {
        const unsigned order = 2 + static_cast<unsigned>(random_() % 4);
        const unsigned points = order + static_cast<unsigned>(random_() % 6);
        std::vector<std::string> lines{"G90G94F500G6.2K0P" + std::to_string(order)};
        int knot = 0;
        for (unsigned i = 1; i < points + order; ++i) {
            knot += i == points || (i >= order && i < points && random_() % 3 != 0) ? 1 : 0;
            std::string line = "K" + std::to_string(knot);
            if (i < points) {
                line += "X" + number() + "Y" + number() + "R" + std::to_string(1 + random_() % 3);
            }
            lines.push_back(random_() % 60 == 0 ? next() : line);
        }
        return lines;
    }
    bool wants_curve() { return random_() % 6 == 0; }

private:
    std::string number()
    {
        const unsigned digits = static_cast<unsigned>(random_() % 8);
        std::uniform_int_distribution<int> values{-30000, 30000};
        char text[40];
        (void)std::snprintf(text, sizeof text, "%.*f", static_cast<int>(digits),
                            values(random_) / (random_() % 2 == 0 ? 1000.0 : 7e5));
        return text;
    }

    std::mt19937 random_{kSeed};
};

}  // namespace

TEST_GROUP(GcodeProperty){};

TEST(GcodeProperty, RandomProgramsKeepThePromises)
{
    const char* wanted = std::getenv("CUSP_GCODE_PROGRAMS");
    const long programs = wanted != nullptr ? std::strtol(wanted, nullptr, 10) : 150;
    std::printf("seed %u, %ld programs\n", kSeed, programs);
    RandomLines lines;
    for (long i = 0; i < programs; ++i) {
        cusp::GcodePromises promises;
        for (int k = 0; k < 40; ++k) {
            const std::vector<std::string> block =
                lines.wants_curve() ? lines.curve() : std::vector<std::string>{lines.next()};
            for (const std::string& line : block) {
                const char* broken = promises.run(line);
                CHECK_TEXT(broken == nullptr,
                           (line + ": " + (broken != nullptr ? broken : "")).c_str());
            }
        }
    }
}
