#include "firmware/protocol/system_command.hpp"

#include <string_view>

#include "CppUTest/TestHarness.h"

using namespace cusp::protocol;
using cusp::Error;

namespace {

bool is(std::string_view line, SystemCommandKind kind)
{
    const auto command = parse_system_command(line);
    return command && command->kind == kind;
}

bool fails(std::string_view line, Error error)
{
    const auto command = parse_system_command(line);
    return !command && command.error() == error;
}

}  // namespace

TEST_GROUP(Command){};

TEST(Command, IsKnownByItsText)
{
    CHECK(is("$", SystemCommandKind::kHelp));
    CHECK(is("$$", SystemCommandKind::kSettings));
    CHECK(is("$#", SystemCommandKind::kParameters));
    CHECK(is("$G", SystemCommandKind::kParserState));
    CHECK(is("$I", SystemCommandKind::kBuildInfo));
    CHECK(is("$N", SystemCommandKind::kStartupLines));
    CHECK(is("$C", SystemCommandKind::kCheckMode));
    CHECK(is("$X", SystemCommandKind::kUnlock));
    CHECK(is("$SLP", SystemCommandKind::kSleep));
    CHECK(is("$RST=*", SystemCommandKind::kRestoreAll));
    CHECK(is("$CRC=1", SystemCommandKind::kCheckedLinesOn));
    CHECK(is("$CRC=0", SystemCommandKind::kCheckedLinesOff));
    BYTES_EQUAL(4, parse_system_command("$HZ")->axes.bits);
    CHECK(parse_system_command("$J=G91X1F5")->text == "G91X1F5");
    CHECK(parse_system_command("$N1=G21")->text == "G21");
}

TEST(Command, ReadsSettingsByNumberAndValue)
{
    const auto command = parse_system_command("$110=635.25");
    CHECK(command->kind == SystemCommandKind::kSetSetting);
    UNSIGNED_LONGS_EQUAL(110, command->number);
    DOUBLES_EQUAL(635.25, static_cast<double>(command->value), 1e-9);
    DOUBLES_EQUAL(-2.0, static_cast<double>(parse_system_command("$0=-2")->value), 0);
    DOUBLES_EQUAL(123456789012.0,
                  static_cast<double>(parse_system_command("$0=123456789012")->value), 1e5);
}

TEST(Command, RefusesWithGrblsNumbers)
{
    CHECK(fails("$Q", Error::kBadNumberFormat));
    CHECK(fails("$100=", Error::kBadNumberFormat));
    CHECK(fails("$100=X", Error::kBadNumberFormat));
    CHECK(fails("$100", Error::kInvalidStatement));
    CHECK(fails("$100=1X", Error::kInvalidStatement));
    CHECK(fails("$1.5=1", Error::kInvalidStatement));
    CHECK(fails("$G1", Error::kInvalidStatement));
    CHECK(fails("$JX", Error::kInvalidStatement));
    CHECK(fails("$HXY", Error::kInvalidStatement));
    CHECK(fails("$RST=", Error::kInvalidStatement));
}
