// Reading a program line by line.
#include "host_tools/controller/dialect/line_source.hpp"

#include "CppUTest/TestHarness.h"

#include "host_tools/base/input_error/input_error.hpp"
#include "tests/support/temporary_folder.hpp"

using cusp::dialect::LineSource;

TEST_GROUP(LineSource) { cusp::test::TemporaryFolder folder; };

TEST(LineSource, EndsLinesAtEachKindOfLineEnd)
{
    LineSource source{folder.with("a.ngc", "G0\nG1\r\nG2\rG3\n\nM2")};
    STRCMP_EQUAL("G0", source.next()->c_str());
    STRCMP_EQUAL("G1", source.next()->c_str());
    STRCMP_EQUAL("G2", source.next()->c_str());
    STRCMP_EQUAL("G3", source.next()->c_str());
    STRCMP_EQUAL("", source.next()->c_str());
    STRCMP_EQUAL("M2", source.next()->c_str());
    LONGS_EQUAL(6, source.line_number());
    CHECK_FALSE(source.next().has_value());
    DOUBLES_EQUAL(1.0, source.progress(), 0.0);
}

TEST(LineSource, RefusesAFileThatIsNotThereAndAFolder)
{
    CHECK_THROWS(cusp::InputError, LineSource{folder.file("none.ngc")});
    CHECK_THROWS(cusp::InputError, LineSource{folder.file(".")});
}

TEST(LineSource, CutsALineThatIsTooLong)
{
    LineSource source{folder.with("long.ngc", std::string(200'000, 'x') + "\nM2\n")};
    LONGS_EQUAL(65536, source.next()->size());
    STRCMP_EQUAL("M2", source.next()->c_str());
}
