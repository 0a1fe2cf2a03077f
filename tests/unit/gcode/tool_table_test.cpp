// Lengths of tools: entered by G10, used by G43 H; and the words allowed on a line with M6.
#include <optional>
#include <random>
#include <string>

#include "tests/unit/gcode/gcode_runner.hpp"

using namespace cusp;
using namespace cusp::gcode;

TEST_GROUP(ToolTable)
{
    Runner runner;
    void run(std::string_view line) { LONGS_EQUAL_TEXT(0, runner.run(line), line.data()); }
    void refuse(int error, std::string_view line)
    {
        LONGS_EQUAL_TEXT(error, runner.run(line), line.data());
    }
    std::int64_t offset() const { return runner.interpreter.parameters().tool_length_offset_nm; }
    const gcode::ToolTable& table() const { return runner.interpreter.parameters().tools; }
};

TEST(ToolTable, TakesLengthsInTheUnitsOfTheLine)
{
    run("G10 L1 P2 Z-7.3");
    run("G20 G10 L1 P16 Z1.5");
    LONGS_EQUAL(-7300000, table().length_nm(2));
    LONGS_EQUAL(38100000, table().length_nm(16));
    CHECK_FALSE(table().has(1));
    LONGS_EQUAL(0, offset());
    const auto& changed = std::get<ParametersChanged>(runner.actions.back());
    CHECK(changed.keep);
    LONGS_EQUAL(16, changed.tool);
}

TEST(ToolTable, G43TakesTheLengthOfItsToolAndG49NoneAgain)
{
    run("G10 L1 P2 Z-7.3");
    run("G43 H2");
    LONGS_EQUAL(-7300000, offset());
    run("G0 Z10");
    check_position(0, 0, 2.7, runner.interpreter.position());
    run("G43 H0");
    LONGS_EQUAL(0, offset());
    run("G43 H2 Z10");
    check_position(0, 0, 2.7, runner.interpreter.position());
    run("G49");
    LONGS_EQUAL(0, offset());
    // The length that holds is the one of the G43: a new entry waits for the next.
    run("G43 H2");
    run("G10 L1 P2 Z1");
    LONGS_EQUAL(-7300000, offset());
}

TEST(ToolTable, AnEmptyTableIsAControllerWithoutOne)
{
    for (const char* line : {"G43 H0", "G43 H1", "G43 H16", "G43 H17", "G43 H255"}) {
        run(line);
        LONGS_EQUAL(0, offset());
    }
}

TEST(ToolTable, AToolThatWasNotEnteredIsRefusedOnceOneWas)
{
    run("G10 L1 P2 Z3");
    run("G43 H2");
    refuse(38, "G43 H1");
    refuse(38, "G43 H17 Z5");
    refuse(38, "G43 H256");
    refuse(38, "G43 H1.5");
    LONGS_EQUAL(3000000, offset());
    check_position(0, 0, 0, runner.interpreter.position());
}

// As LinuxCNC and grblHAL take it; without G41 and G42 nothing asks for a radius.
TEST(ToolTable, TakesTheRadiusAndLeavesTheLengthAlone)
{
    run("G10 L1 P2 Z-7.3 R3.175");
    run("G10 L1 P2 R1");
    LONGS_EQUAL(-7300000, table().length_nm(2));
    run("G10 L1 P3 R1");
    CHECK_FALSE(table().has(3));
    run("G10 L11 P4 Z1 R-2");
    CHECK(table().has(4));
    refuse(38, "G10 L1 P17 R1");
}

TEST(ToolTable, RefusesBadEntries)
{
    refuse(26, "G10 L1 P1");
    refuse(28, "G10 L1 Z1");
    refuse(38, "G10 L1 P0 Z1");
    refuse(38, "G10 L1 P17 Z1");
    refuse(38, "G10 L10 P300 Z1");
    refuse(23, "G10 L11 P1.5 Z1");
    refuse(37, "G10 L1 P1 X1");
    refuse(37, "G10 L1 P1 X1 Z1");
    refuse(20, "G10 L20 P1 Z1 R3");
    refuse(20, "G10 L20 P1 R0");
    refuse(38, "G10 L1 P1 Z2001");
    refuse(24, "G10 L1 P1 Z1 G0");
    CHECK(table().empty());
    CHECK(runner.actions.empty());
}

// As LinuxCNC has it: with the new length the tool would be at the Z of the line.
TEST(ToolTable, L10AndL11MeasureFromTheMachinesPosition)
{
    run("G10 L2 P1 Z-20");
    run("G10 L2 P9 Z-50");
    run("G53 G0 Z-12");
    run("G92 Z3");
    run("G43.1 Z4");
    run("G10 L10 P3 Z2");
    run("G10 L11 P4 Z2");
    run("G43 H3");
    const Position with_g92 =
        work_offset(runner.interpreter.modal(), runner.interpreter.parameters());
    LONGS_EQUAL(2000000, runner.interpreter.position().z - with_g92.z);
    run("G92.1");
    run("G59.3 G43 H4");
    const Position at_setter =
        work_offset(runner.interpreter.modal(), runner.interpreter.parameters());
    LONGS_EQUAL(2000000, runner.interpreter.position().z - at_setter.z);
}

TEST(ToolTable, ARuleRefusesM6WholeWhereTheMachineIsNotHomed)
{
    runner.interpreter.set_tool_change_rule(ToolChangeRule::kNotHomed);
    refuse(46, "T3 M6 S500 M3 G0 X5");
    CHECK(runner.actions.empty());
    LONGS_EQUAL(0, runner.interpreter.modal().tool);
    check_position(0, 0, 0, runner.interpreter.position());
    run("T3 G0 X5");
}

TEST(ToolTable, ATouchOffNeedsATableEntryAndALineWithoutLengths)
{
    runner.interpreter.set_tool_change_rule(ToolChangeRule::kTouchOff);
    refuse(38, "M6");
    refuse(38, "T17 M6");
    for (const char* line : {"T1 M6 G0 X1", "T1 M6 G43 H1", "T1 M6 G49", "T1 M6 G10 L1 P1 Z1",
                             "T1 M6 G28", "T1 M6 G92.1", "T1 M6 G28.1"}) {
        refuse(24, line);
    }
    CHECK(runner.actions.empty());
    run("T1 M6 M3 S1000 M8 G54 G90 M0");
    LONGS_EQUAL(4, runner.actions.size());
}

TEST(ToolTable, ATouchedOffToolKeepsTheProgramsPosition)
{
    runner.interpreter.set_tool_change_rule(ToolChangeRule::kTouchOff);
    run("G0 X1 Y2 Z3.0000004");
    run("G43.1 Z1");
    run("T5 M6");
    runner.interpreter.take_tool_length(-2500000);
    check_position(1, 2, -0.5, runner.interpreter.position());
    LONGS_EQUAL(-2500000, offset());
    LONGS_EQUAL(-2500000, table().length_nm(5));
    run("G43 H5");
    LONGS_EQUAL(-2500000, offset());
    runner.interpreter.reset();
    LONGS_EQUAL(0, offset());
}

// The oracle: a map for the table, plain sums for the offset.
TEST(ToolTable, FollowsRandomLines)
{
    for (unsigned seed = 1; seed <= 200; ++seed) {
        std::mt19937 random{seed};
        const std::string where = "seed " + std::to_string(seed);
        Runner one;
        std::array<std::optional<std::int64_t>, 17> lengths{};
        std::int64_t offset = 0;
        std::int64_t machine_z = 0;
        bool any = false;
        for (unsigned i = 0; i < 60; ++i) {
            const auto tool = static_cast<unsigned>(random() % 19);
            const int z = static_cast<int>(random() % 4000) - 2000;  // hundredths of a millimetre
            const std::int64_t z_nm = std::int64_t{z} * 10000;
            const std::string number = std::to_string(tool);
            char text[32];
            (void)std::snprintf(text, sizeof text, "Z%.2f", z * 0.01);
            switch (random() % 5) {
                case 0: {
                    const bool good = tool >= 1 && tool <= 16;
                    LONGS_EQUAL_TEXT(good ? 0 : 38, one.run("G10 L1 P" + number + text),
                                     where.c_str());
                    if (good) {
                        lengths[tool] = z_nm;
                        any = true;
                    }
                    break;
                }
                case 1: {
                    const bool good = !any || tool == 0 || (tool <= 16 && lengths[tool]);
                    LONGS_EQUAL_TEXT(good ? 0 : 38, one.run("G43 H" + number), where.c_str());
                    if (good) {
                        offset = any && tool != 0 ? *lengths[tool] : 0;
                    }
                    break;
                }
                case 2: {
                    const bool good = tool >= 1 && tool <= 16;
                    LONGS_EQUAL_TEXT(good ? 0 : 38, one.run("G10 L10 P" + number + text),
                                     where.c_str());
                    if (good) {
                        lengths[tool] = machine_z - z_nm;
                        any = true;
                    }
                    break;
                }
                case 3:
                    LONGS_EQUAL_TEXT(0, one.run("G49"), where.c_str());
                    offset = 0;
                    break;
                default:
                    LONGS_EQUAL_TEXT(0, one.run(std::string{"G0 "} + text), where.c_str());
                    machine_z = z_nm + offset;
                    break;
            }
            const Parameters& parameters = one.interpreter.parameters();
            LONGS_EQUAL_TEXT(offset, parameters.tool_length_offset_nm, where.c_str());
            LONGS_EQUAL_TEXT(machine_z, one.interpreter.position().z, where.c_str());
            for (unsigned t = 1; t <= 16; ++t) {
                CHECK_EQUAL_TEXT(lengths[t].has_value(), parameters.tools.has(t), where.c_str());
                LONGS_EQUAL_TEXT(lengths[t].value_or(0), parameters.tools.length_nm(t),
                                 where.c_str());
            }
        }
    }
}
