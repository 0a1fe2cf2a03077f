// Settings files: what is read, and how invalid ones are refused.
#include "host_tools/controller/simulate/settings_file.hpp"

#include "CppUTest/TestHarness.h"

#include "firmware/base/panel.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/controller/simulate/fault_command.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;

TEST_GROUP(SettingsFile)
{
    test::TemporaryFolder folder;

    std::string refusal(const std::string& text) const
    {
        return test::refusal([&] { simulate::read_settings_file(folder.with("mill.txt", text)); });
    }
};

TEST(SettingsFile, IsReadAsItIsWritten)
{
    machine::Settings settings;
    CHECK_FALSE(settings.put(110, 4321.5F).has_value());
    const std::string file = folder.with("mill.txt", simulate::settings_text(settings));
    const machine::Settings read = simulate::read_settings_file(file);
    STRCMP_EQUAL(simulate::settings_text(settings).c_str(), simulate::settings_text(read).c_str());
    LONGS_EQUAL(1, simulate::settings_commands(read).size());
    STRCMP_EQUAL("$110=4321.500", simulate::settings_commands(read)[0].c_str());
}

TEST(SettingsFile, MayCarryComments)
{
    const machine::Settings read = simulate::read_settings_file(
        folder.with("mill.txt", "; my mill\n\n$100=250.000 (x, step/mm)\r\n$0 = 3 # us\n"));
    DOUBLES_EQUAL(250.0, static_cast<double>(read.value(machine::Setting::kStepsPerMillimetre)), 0);
    LONGS_EQUAL(3, read.whole(machine::Setting::kStepPulse));
}

TEST(SettingsFile, TakesSoftLimitsBeforeHoming)
{
    STRCMP_EQUAL("", refusal("$20=1\n$22=1\n").c_str());
}

TEST(SettingsFile, IsRefusedWithItsLine)
{
    CHECK(refusal("$100=800\nnonsense\n").find("mill.txt:2: 'nonsense'") != std::string::npos);
    CHECK(refusal("$999=1\n").find("mill.txt:1: there is no setting $999") != std::string::npos);
    CHECK(refusal("$110=-5\n").find(":1: $110=-5 is out of range") != std::string::npos);
    CHECK(refusal("$110=\n").find(":1: $110: '' is no number") != std::string::npos);
    CHECK(refusal("$110=nan\n").find("is no number") != std::string::npos);
    CHECK(refusal("$20=1\n").find("needs homing") != std::string::npos);
}

TEST(SettingsFile, IsRefusedWhereStepsComeTooClose)
{
    const std::string text = refusal("$100=800\n$0=20\n$110=6000\n");
    CHECK(text.find("mill.txt:3: $110 and $100 ask for a step every 12.500 us") !=
          std::string::npos);
    CHECK(text.find("40.000 us") != std::string::npos);
}

TEST_GROUP(FaultCommand){};

TEST(FaultCommand, KnowsItsWords)
{
    CHECK(simulate::parse_fault_command("power on")->kind == simulate::FaultKind::kPowerOn);
    CHECK(simulate::parse_fault_command("power off\r")->kind == simulate::FaultKind::kPowerOff);
    LONGS_EQUAL(kLimitY, simulate::parse_fault_command("high y")->inputs);
    DOUBLES_EQUAL(-3.5, simulate::parse_fault_command("plate -3.5")->value, 0.0);
    DOUBLES_EQUAL(0.005, simulate::parse_fault_command("line noise=0.005 loss=0")->faults.noise,
                  0.0);
    CHECK(simulate::parse_fault_command("unplug")->kind == simulate::FaultKind::kUnplug);
}

TEST(FaultCommand, RefusesAnythingElse)
{
    for (const char* line : {"", "power", "power up", "high q", "cut", "cut -1", "line noise=2",
                             "line what=0.1", "unplug now", "plate x", "explode"}) {
        CHECK_FALSE(simulate::parse_fault_command(line).has_value());
    }
}
