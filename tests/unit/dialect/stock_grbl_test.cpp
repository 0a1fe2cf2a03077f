// Words that stock Grbl 1.1 accepts, against the table of G-codes in its documentation.
#include "host_tools/controller/dialect/stock_grbl.hpp"

#include <cstdio>
#include <set>
#include <string>

#include "CppUTest/TestHarness.h"

using namespace cusp::dialect;

namespace {

// "Supported G-codes in v1.1" of Grbl's documents; M7 and M56 are build options.
const std::set<std::string> kG{
    "0",  "1",    "2",    "3",    "4",    "10",   "17", "18",   "19", "20",   "21", "28", "28.1",
    "30", "30.1", "38.2", "38.3", "38.4", "38.5", "40", "43.1", "49", "53",   "54", "55", "56",
    "57", "58",   "59",   "61",   "80",   "90",   "91", "91.1", "92", "92.1", "93", "94"};
const std::set<std::string> kM{"0", "1", "2", "3", "4", "5", "8", "9", "30"};

int error_of(const std::string& line) { return stock_grbl_refusal(line).code; }

// The words that the command can't do without.
std::string with_words(const std::string& g)
{
    return g == "10" ? "G10 L2 P1 X1" : g == "4" ? "G4 P0.1" : "G" + g;
}

}  // namespace

TEST_GROUP(StockGrbl){};

TEST(StockGrbl, TakesTheCommandsOfItsTableAndNoOther)
{
    for (int tenths = 0; tenths < 1000; ++tenths) {
        std::string number = std::to_string(tenths / 10);
        if (tenths % 10 != 0) {
            number += "." + std::to_string(tenths % 10);
        }
        const int code = error_of(with_words(number));
        CHECK_EQUAL_TEXT(kG.count(number) != 0, code == 0, ("G" + number).c_str());
        CHECK_TEXT(code == 0 || code == 20 || code == 23, ("G" + number).c_str());
    }
    for (int number = 0; number < 200; ++number) {
        const std::string text = std::to_string(number);
        CHECK_EQUAL_TEXT(kM.count(text) != 0, error_of("M" + text) == 0, text.c_str());
    }
}

TEST(StockGrbl, TakesTheLettersOfItsTableAndNoOther)
{
    const std::string words = "FIJKLNPRSTXYZ";
    for (char letter = 'A'; letter <= 'Z'; ++letter) {
        if (letter == 'G' || letter == 'M') {
            continue;
        }
        const int code = error_of(std::string{letter} + "1");
        const bool known = words.find(letter) != std::string::npos;
        // P and L alone are unused words
        CHECK_EQUAL_TEXT(known ? (letter == 'P' || letter == 'L' ? 36 : 0) : 20, code,
                         std::string(1, letter).c_str());
    }
}

TEST(StockGrbl, RefusesWithItsOwnNumbers)
{
    struct Case {
        const char* line;
        int code;
        const char* word;
    };
    const Case cases[]{
        {"G64 P0.02", 20, "G64"},
        {"G6.2 P4 K0 X1", 20, "G6.2"},
        {"G5.2 X1 Y1", 20, "G5.2"},
        {"G81 X1 Y1 Z-3 R1", 20, "G81"},
        {"G43 H1", 20, "G43"},
        {"G43.1 Z1", 0, ""},
        {"G97 S1000", 20, "G97"},
        {"G98", 20, "G98"},
        {"T1 M6", 20, "M6"},
        {"T1", 0, ""},
        {"T256", 38, "T256"},
        {"M7", 20, "M7"},
        {"G59.1", 23, "G59.1"},
        {"G61.1", 20, "G61.1"},
        {"G92.2", 20, "G92.2"},
        {"G90.1", 20, "G90.1"},
        {"%", 1, "%"},
        {":1001", 1, ":"},
        {"O1001", 20, "O1001"},
        {"GX1", 2, "G"},
        {"X1E3", 20, "E3"},
        {"G0 G1 X1", 24, "G1"},
        {"G10 G0 L2 P1 X1", 24, "G0"},
        {"G17 G18", 21, "G18"},
        {"X1 X2", 25, "X2"},
        {"F-1", 4, "F-1"},
        {"X-1", 0, ""},
        {"N10000001 G0 X1", 27, ""},
        {"G10 L2 P1", 26, ""},
        {"G10 L2 X1", 28, ""},
        {"G10 L20 P7 X1", 29, ""},
        {"G10 L1 P1 Z1", 20, ""},
        {"G10 L2 P1 R10 X1", 20, ""},
        {"G2 X1 Y1 I1 P2", 36, ""},
        {"g1 x1 y 2 f100 (a comment) ; more", 0, ""},
        {"/G1 X1", 0, ""},
        {"(T1 M6)", 0, ""},
        {"", 0, ""},
        {"$H", 0, ""},
    };
    for (const Case& c : cases) {
        const StockGrblRefusal found = stock_grbl_refusal(c.line);
        CHECK_EQUAL_TEXT(c.code, found.code, c.line);
        STRCMP_EQUAL_TEXT(c.word, found.word.c_str(), c.line);
    }
}

TEST(StockGrbl, TakesLinesOf79CharactersWithoutBlanksAndComments)
{
    const std::string line = "G1 X1." + std::string(74, '0');
    CHECK_EQUAL(0, error_of(line + " (comment)"));
    CHECK_EQUAL(11, error_of(line + "0"));
}

TEST(StockGrbl, WantsAxisWordsAndCloserRadiiOfArcs)
{
    cusp::gcode::Interpreter before;
    const auto run = [&before](const char* line) {
        CHECK_TEXT(static_cast<bool>(before.execute(line, 0)), line);
        before.discard();
    };
    const auto code = [&before](const char* line) {
        return stock_grbl_refusal(line, before).code;
    };
    run("G21 G90 G1 F100");
    CHECK_EQUAL(26, code("G2 I5"));
    CHECK_EQUAL(32, code("G2 I5 Z-1"));
    CHECK_EQUAL(0, code("G18 G2 K5 Z0"));
    CHECK_EQUAL(0, code("G2 X10 I5 K0"));
    CHECK_EQUAL(0, code("G2 X10 I5 K7"));
    CHECK_EQUAL(33, code("G2 X10.02 I5"));
    CHECK_EQUAL(0, code("G2 X10.004 I5"));
    CHECK_EQUAL(20, code("G90.1 G2 X10 I5 J0"));
    CHECK_EQUAL(0, code("N10.5 G2 X10 I5"));
    CHECK_EQUAL(21, code("G0 G80 X1"));
    run("G2 X10 I5");
    CHECK_EQUAL(36, code("I5"));
    CHECK_EQUAL(0, code("X10 I5"));
    run("G20");
    CHECK_EQUAL(33, code("G2 X0.9957 I0.30"));
}
