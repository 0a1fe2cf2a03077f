#include "host_tools/base/files/file_set.hpp"

#include "CppUTest/TestHarness.h"

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/controller/dialect/line_source.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;

namespace {
const files::FileSet kSet{{"part.ngc", "G0 X1\nM2\n"}, {"parts/a.txt", "a"}};
}

TEST_GROUP(FileSet) { test::TemporaryFolder folder; };

TEST(FileSet, ReadersFindTheFilesOfTheSetByAnySpellingOfTheirPaths)
{
    const files::InMemory in_memory{kSet};
    CHECK(files::text_of_file("part.ngc") == kSet.at("part.ngc"));
    CHECK(files::text_of_file("./parts/../parts/a.txt") == "a");
    dialect::LineSource lines{"part.ngc"};
    CHECK(lines.next() == "G0 X1");
    CHECK(lines.progress() > 0);
    CHECK(lines.next() == "M2");
    CHECK_FALSE(lines.next().has_value());
}

TEST(FileSet, NothingOfTheDiskIsRead)
{
    folder.with("secret.txt", "secret");
    const std::string secret = folder.file("secret.txt");
    CHECK(files::text_of_file(secret) == "secret");
    const files::InMemory in_memory{kSet};
    CHECK_THROWS(InputError, files::text_of_file(secret));
    CHECK_THROWS(InputError, dialect::LineSource{secret});
    CHECK_THROWS(InputError, files::text_of_file("posts/../" + secret));
    CHECK_THROWS(InputError, files::text_in_memory("absent.txt"));
    CHECK_FALSE(files::is_file(secret));
    CHECK(files::is_file("part.ngc"));
}

TEST(FileSet, ACopyOnTheDiskHasTheBytesAndIsRemoved)
{
    const files::InMemory in_memory{kSet};
    std::string copy;
    try {
        files::with_file_on_disk("parts/a.txt", [&](const std::string& path) {
            copy = path;
            CHECK(files::text_of_file(path) == "a");
            throw InputError{path + ": is wrong"};
        });
        FAIL("the error is lost");
    } catch (const InputError& error) {
        STRCMP_EQUAL("parts/a.txt: is wrong", error.what());
    }
    CHECK_FALSE(std::filesystem::exists(copy));
    CHECK(files::text_of_file("parts/a.txt") == "a");
}
