// Text of the pulse trace and of the samples.
#include "host_tools/controller/simulate/vcd_writer.hpp"

#include "CppUTest/TestHarness.h"

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/controller/simulate/samples_writer.hpp"
#include "tests/support/temporary_folder.hpp"

namespace {

using namespace cusp;

PulseFrame one_step_back_on_y()
{
    PulseFrame frame;
    frame.edges.try_push_back({1, direction_line(0), 0});
    frame.edges.try_push_back({10, step_line(1), 0});
    frame.edges.try_push_back({12, 0, step_line(1)});
    return frame;
}

}  // namespace

TEST_GROUP(VcdWriter)
{
    test::TemporaryFolder folder;
    hal::SimulatedMill mill{{}};
};

TEST(VcdWriter, WritesEachEdgeAtItsTick)
{
    simulate::VcdWriter writer{folder.file("t.vcd"), mill, 0, 0, kLinearAxes};
    writer.frame_played(3000, one_step_back_on_y());
    writer.close();
    const std::string text = folder.text_of("t.vcd");
    CHECK(text.find("$timescale 1 us $end\n") != std::string::npos);
    CHECK(text.find("$var wire 1 # step_y $end\n") != std::string::npos);
    const std::string changes = "$end\n#3001\n1\"\n#3010\n1#\n#3012\n0#\n#4000\n";
    STRCMP_EQUAL(changes.c_str(), text.substr(text.size() - changes.size()).c_str());
}

TEST(VcdWriter, ShowsSpindleAndCoolant)
{
    simulate::VcdWriter writer{folder.file("t.vcd"), mill, 0, 0, kLinearAxes};
    hal::OutputLevels levels;
    levels.spindle_on = true;
    mill.set(levels);
    writer.frame_played(0, {});
    levels.mist = true;
    mill.set(levels);
    writer.frame_played(1000, {});
    writer.close();
    const std::string text = folder.text_of("t.vcd");
    const std::string changes = "$end\n1'\n#1000\n1(\n#2000\n";
    STRCMP_EQUAL(changes.c_str(), text.substr(text.size() - changes.size()).c_str());
}

TEST(VcdWriter, RefusesAPlaceThatCantBeWritten)
{
    CHECK_THROWS(InputError,
                 (simulate::VcdWriter{folder.file("no/such/t.vcd"), mill, 0, 0, kLinearAxes}));
}

TEST(VcdWriter, WritesSamplesAsIntegers)
{
    simulate::SamplesWriter writer{folder.file("s.csv"), false, kLinearAxes};
    writer.write(1000, {-5, 0, 1234567890123}, 17, 3);
    writer.close();
    STRCMP_EQUAL("t_us,x_nm,y_nm,z_nm,line\n1000,-5,0,1234567890123,17\n",
                 folder.text_of("s.csv").c_str());
}

// A's come last, in a dump and in a row.
TEST(VcdWriter, WritesTheRotaryAxisToo)
{
    simulate::VcdWriter writer{folder.file("t.vcd"), mill, 0, 0, kAxisCount};
    PulseFrame frame;
    CHECK(frame.edges.try_push_back({7, step_line(3), 0}));
    writer.frame_played(0, frame);
    writer.close();
    const std::string text = folder.text_of("t.vcd");
    CHECK(text.find("$var wire 1 ) step_a $end\n") != std::string::npos);
    const std::string changes = "$end\n#7\n1)\n#1000\n";
    STRCMP_EQUAL(changes.c_str(), text.substr(text.size() - changes.size()).c_str());
    simulate::SamplesWriter samples{folder.file("s.csv"), false, kAxisCount};
    samples.write(1000, {-5, 0, 1, 90000000}, 17, 0);
    samples.close();
    STRCMP_EQUAL("t_us,x_nm,y_nm,z_nm,a_udeg,line\n1000,-5,0,1,90000000,17\n",
                 folder.text_of("s.csv").c_str());
}

TEST(VcdWriter, WritesThePowerOfALaserBehindTheSamples)
{
    simulate::SamplesWriter writer{folder.file("s.csv"), true, kLinearAxes};
    writer.write(1000, {-5, 0, 1}, 17, kFullDuty / 4);
    writer.close();
    STRCMP_EQUAL("t_us,x_nm,y_nm,z_nm,line,power_ppm\n1000,-5,0,1,17,250000\n",
                 folder.text_of("s.csv").c_str());
}
