// `$ES`, `$EG`, `$EE` and `$EA`, read as senders read them.
#include <map>
#include <regex>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"

using namespace cusp;

namespace {

std::vector<std::string> lines_of(const std::string& command)
{
    ControllerBench bench;
    bench.run(5);
    (void)bench.board.byte_link.take_answers();
    std::string all = bench.exchange(command + "\n");
    for (unsigned i = 0; i < 100; ++i) {
        all += bench.exchange("");  // the link holds some lines only
    }
    std::vector<std::string> lines;
    for (std::size_t at = 0; at < all.size();) {
        const std::size_t end = all.find("\r\n", at);
        CHECK_TEXT(end != std::string::npos, all.c_str());
        lines.push_back(all.substr(at, end - at));
        at = end + 2;
    }
    CHECK(!lines.empty());
    STRCMP_EQUAL("ok", lines.back().c_str());
    lines.pop_back();
    return lines;
}

std::vector<std::string> fields_of(const std::string& line, const std::string& word)
{
    CHECK_TEXT(line.rfind("[" + word + ":", 0) == 0 && line.back() == ']', line.c_str());
    const std::string text = line.substr(word.size() + 2, line.size() - word.size() - 3);
    std::vector<std::string> fields{""};
    for (const char c : text) {
        if (c == '|') {
            fields.emplace_back();
        } else {
            fields.back() += c;
        }
    }
    return fields;
}

}  // namespace

TEST_GROUP(Enumerations){};

TEST(Enumerations, DescribeEverySettingOnceInAGroupThatThereIs)
{
    std::set<std::string> groups{"0"};
    for (const std::string& line : lines_of("$EG")) {
        const auto fields = fields_of(line, "SETTINGGROUP");
        LONGS_EQUAL(3, fields.size());
        CHECK_TEXT(groups.count(fields[1]) == 1, line.c_str());  // its parent comes first
        CHECK_TEXT(groups.insert(fields[0]).second, line.c_str());
    }
    std::set<std::string> listed;
    for (const std::string& line : lines_of("$$")) {
        listed.insert(line.substr(1, line.find('=') - 1));
    }
    std::set<std::string> described;
    std::set<std::string> names;
    for (const std::string& line : lines_of("$ES")) {
        const auto fields = fields_of(line, "SETTING");
        LONGS_EQUAL(10, fields.size());
        CHECK_TEXT(described.insert(fields[0]).second, line.c_str());
        CHECK_TEXT(groups.count(fields[1]) == 1, line.c_str());
        CHECK_TEXT(names.insert(fields[2]).second, line.c_str());
        const bool has_range = fields[4] == "5" || fields[4] == "6";
        CHECK_TEXT(has_range == !fields[6].empty() && has_range == !fields[7].empty(),
                   line.c_str());
        CHECK_TEXT(!has_range || std::stod(fields[6]) < std::stod(fields[7]), line.c_str());
        const bool chooses = fields[4] == "1" || fields[4] == "3";
        CHECK_TEXT(!chooses || fields[5].find(',') != std::string::npos, line.c_str());
    }
    CHECK(listed == described);
}

TEST(Enumerations, DescribeEveryErrorAndAlarmOnce)
{
    for (const auto& [command, word, known] :
         {std::tuple{"$EE", "ERRORCODE", std::set<int>{1, 9, 17, 20, 38, 46, 47}},
          std::tuple{"$EA", "ALARMCODE", std::set<int>{1, 9, 10, 14, 15, 17}}}) {
        std::map<int, std::string> texts;
        for (const std::string& line : lines_of(command)) {
            std::smatch match;
            const std::regex form{std::string{"^\\["} + word + R"(:(\d+)\|\|(.*)\]$)"};
            CHECK_TEXT(std::regex_match(line, match, form), line.c_str());
            CHECK_TEXT(texts.emplace(std::stoi(match[1]), match[2]).second, line.c_str());
        }
        for (const int code : known) {
            // There is no error 17 any more: every board can make the pulses of a laser.
            CHECK_EQUAL(!(code == 17 && word == std::string{"ERRORCODE"}), texts.count(code) == 1);
        }
    }
}

// $481
TEST(Enumerations, AreJoinedByReportsThatComeByThemselves)
{
    const auto reports = [](const char* setting) {
        ControllerBench bench;
        bench.run(5);
        (void)bench.exchange(setting, 20);
        const std::string said = bench.exchange("G1X10F600\n", 1000);
        unsigned count = 0;
        for (const char c : said) {
            count += c == '<' ? 1U : 0U;
        }
        return count;
    };
    CHECK_EQUAL(0U, reports("$481=0\n"));
    CHECK_EQUAL(5U, reports("$481=200\n"));
    CHECK_EQUAL(10U, reports("$481=20\n"));
}
