// The lines at which a program can be resumed, and the lines that lead there.
#include <string>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/controller/stream/approach.hpp"
#include "host_tools/controller/stream/controller_facts.hpp"
#include "host_tools/controller/stream/resume_point.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::stream;

TEST_GROUP(Resume)
{
    test::TemporaryFolder folder;
    TransferRecord record;
    gcode::Parameters now;

    ResumePoint point_at(std::uint64_t executed, const std::string& text)
    {
        record.executed_line = executed;
        record.start.modal = "G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0";
        return find_resume_point(folder.with("part.ngc", text), record);
    }
    static std::string joined(const std::vector<std::string>& lines)
    {
        std::string text;
        for (const std::string& line : lines) {
            text += line + "|";
        }
        return text;
    }
    std::string approach(const ResumePoint& point, Vec3d machine)
    {
        return joined(
            make_approach(point, record.start.parameters, now, to_position(machine), {}).lines);
    }
};

TEST(Resume, BeginsAtTheLineBeforeTheOneExecuting)
{
    const ResumePoint point = point_at(4, "G21\nG0 Z5\nG1 Z-1 F100\nX10 F500\nX20\n");
    LONGS_EQUAL(3, point.line);
    CHECK(point.position == to_position({0, 0, 5}));
}

TEST(Resume, BeginsAtNoLineThatLeansOnAnArcBeforeIt)
{
    const std::string text = "G0 X0\nG1 X1 F100\nG2 X3 R1\nX5 R1\nX7 R1\nX9 R1\n";
    LONGS_EQUAL(3, point_at(6, text).line);
    LONGS_EQUAL(4, point_at(6, "G0 X0\nG1 X1 F100\nG2 X3 R1\nG2 X5 R1\nX7 R1\nX9 R1\n").line);
}

TEST(Resume, BeginsADrillingCycleFromItsFirstHole)
{
    LONGS_EQUAL(2, point_at(5, "G0 Z5\nG81 X1 Y1 Z-2 R1 F100\nX2\nX3\nX4\nG80\n").line);
}

TEST(Resume, BeginsANurbsFromItsFirstLine)
{
    const std::string text = "G1 X0 F100\nG5.2 X1 Y1 P1\nX2 Y2 P1\nX3 Y0 P1\nX4 Y1 P1\nG5.3\nX9\n";
    LONGS_EQUAL(2, point_at(5, text).line);
}

TEST(Resume, BeginsBehindAToolChange)
{
    const ResumePoint point = point_at(4, "G1 X1 F100\nT2 M6\nG0 X5\nG1 X6\n");
    LONGS_EQUAL(3, point.line);
    LONGS_EQUAL(2, point.modal.tool);
}

TEST(Resume, IsRefusedBehindATouchOff)
{
    record.start.touches_off = true;
    CHECK_THROWS(InputError, point_at(4, "G1 X1 F100\nT2 M6\nG0 X5\nG1 X6\n"));
}

TEST(Resume, KnowsTheTableOfTheController)
{
    ControllerFacts facts;
    facts.take("[T:2|0.000,0.000,-7.300|0.000]");
    facts.take("[T:17|0.000,0.000,1.000|0.000]");
    facts.take("[T:x]");
    record.start.parameters = facts.parameters();
    CHECK(!record.start.parameters.tools.has(1));
    const std::string program = folder.with("part.ngc", "G43 H2\nG1 X6 F100\nX7\n");
    record.executed_line = 3;
    record.start.modal = "G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0";
    CHECK(write_record(program, record));
    const ResumePoint point = find_resume_point(program, *read_record(program));
    LONGS_EQUAL(-7300000, point.parameters.tool_length_offset_nm);
    facts.take("$13=1");
    LONGS_EQUAL(-185420000, facts.parameters().tools.length_nm(2));
}

TEST(Resume, IsRefusedBehindAProbe)
{
    CHECK_THROWS(InputError, point_at(3, "G38.2 Z-5 F50\nG92 Z0\nG1 X1 F100\n"));
}

TEST(Resume, IsRefusedWhereTheProgramHasNoSuchLine)
{
    CHECK_THROWS(InputError, point_at(9, "G1 X1 F100\n"));
}

TEST(Resume, IsRefusedInAnotherProgram)
{
    record.checked_line = 1;
    record.crc = 12345;
    CHECK_THROWS(InputError, point_at(3, "G1 X1 F100\nX2\nX3\n"));
}

TEST(Resume, ApproachesFromAboveAndRebuildsTheState)
{
    now.work_offsets[1] = to_position({-100, -50, -20});
    record.start.parameters = now;
    const ResumePoint point =
        point_at(6, "G55 G20 G91 G61\nG0 Z1\nM3 S900\nM8\nG1 Z-1.5 F2 (down)\nG1 X1 F20\nX1\n");
    LONGS_EQUAL(5, point.line);
    // The tool began at work 100,50,20 mm; Z 1 inch above that.
    STRCMP_EQUAL(
        "G21|G90|G94|G17|G40|G80|G55|G92.1|G49|"
        "G0Z45.400000|G0X100.000000Y50.000000|S900.000|M3|G4P3|M8|G61|G0|G17|G94|G91|G20|",
        approach(point, {-10, -10, -10}).c_str());
}

TEST(Resume, GoesDownRapidlyToWhereTheProgramTravelsAndThenAtItsPlungeFeed)
{
    const ResumePoint point = point_at(5, "G0 Z5\nG0 X3\nG1 Z-1 F80\nX10 F500\nX20\nX30\n");
    LONGS_EQUAL(4, point.line);
    STRCMP_EQUAL(
        "G21|G90|G94|G17|G40|G80|G54|G92.1|G49|G0Z30.000000|G0X3.000000Y0.000000|"
        "G0Z5.000000|S0.000|G1Z-1.000000F80.0000|F80.0000|G1|G17|G94|G90|G21|",
        approach(point, {0, 0, 30}).c_str());
}

TEST(Resume, PutsOffsetsBackThatTheProgramHasSet)
{
    const ResumePoint point =
        point_at(5, "G0 X10 Z2\nG92 X0\nG10 L2 P2 X-7\nG43.1 Z1.5\nG1 X3 F100\n");
    LONGS_EQUAL(4, point.line);
    const std::string lines = approach(point, {0, 0, 0});
    CHECK(lines.find("G10L2P2X-7.000000Y0.000000Z0.000000|") != std::string::npos);
    CHECK(lines.find("|G92X0.000000Y0.000000Z2.000000|") != std::string::npos);
    CHECK(lines.find("G43.1") == std::string::npos);
}

TEST(Resume, TurnsTheRotaryAxisBackOverThePoint)
{
    record.start.axes = kAxisCount;
    const ResumePoint point = point_at(4, "G0 Z5 A20\nG1 Z-1 F100\nX10 A30\nX20 A45\nX30\n");
    LONGS_EQUAL(3, point.line);
    DOUBLES_EQUAL(20, to_millimetres(point.position)[kLinearAxes], 0);
    const std::string lines = approach(point, {0, 0, 0});
    CHECK_TEXT(lines.find("|G0X0.000000Y0.000000A20.000000|") != std::string::npos, lines.c_str());
}

TEST(Resume, PutsTheOffsetsOfTheRotaryAxisBack)
{
    record.start.axes = kAxisCount;
    const std::string text = "G10 L2 P1 A5\nG92 A100\nG0 Z5\nG1 X10 A110 F100\nX20\nX30\n";
    const ResumePoint point = point_at(6, text);
    const std::string lines = approach(point, {0, 0, 0});
    CHECK_TEXT(lines.find("|G10L2P1X0.000000Y0.000000Z0.000000A5.000000|") != std::string::npos &&
                   lines.find("|G92X10.000000Y0.000000Z5.000000A110.000000|") != std::string::npos,
               lines.c_str());
}

TEST(Resume, KeepsTheRotaryAxisInTheRecord)
{
    const std::string program = folder.with("turned.ngc", "G0 X1\n");
    record.start.axes = kAxisCount;
    record.start.machine = to_position(AxisVecd{1, 2, 3, 4});
    CHECK(write_record(program, record));
    const std::optional<TransferRecord> read = read_record(program);
    CHECK(read && read->start.axes == kAxisCount && read->start.machine == record.start.machine);
}
