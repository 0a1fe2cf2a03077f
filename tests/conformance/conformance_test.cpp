// Runs every conversation of tests/conformance/scripts with the controller and compares each
// answer.
//
//   # comment
//   set <number>=<value>     a factory setting; before anything else
//   > text                   sends the text and LF; \xNN and \n, \r are bytes
//   >> text                  sends the text alone
//   wait <ticks>             lets servo ticks pass
//   finish                   lets ticks pass until nothing moves and no line waits
//   press <bits>, release    holds inputs on (bits of InputBit), or none
//   = line                   the next line of the controller; '*' matches any characters
//   silent                   the controller has sent nothing more
//   at <x> <y> <z>           machine position in mm, within 0.0005
//   state <name>             state of the next status report
#include <cmath>
#include <deque>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "CppUTest/TestHarness.h"

#include "tests/support/controller_bench.hpp"

namespace {

using cusp::ControllerBench;

std::string decoded(const std::string& text)
{
    std::string bytes;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\\' || i + 1 == text.size()) {
            bytes += text[i];
        } else if (text[i + 1] == 'x') {
            bytes += static_cast<char>(std::stoi(text.substr(i + 2, 2), nullptr, 16));
            i += 3;
        } else {
            bytes += text[i + 1] == 'n' ? '\n' : '\r';
            ++i;
        }
    }
    return bytes;
}

bool matches(const std::string& pattern, const std::string& text)
{
    const std::size_t star = pattern.find('*');
    if (star == std::string::npos) {
        return pattern == text;
    }
    if (text.compare(0, star, pattern, 0, star) != 0) {
        return false;
    }
    const std::string rest = pattern.substr(star + 1);
    for (std::size_t from = star; from <= text.size(); ++from) {
        if (matches(rest, text.substr(from))) {
            return true;
        }
    }
    return false;
}

class Conversation {
public:
    // The fault, or nothing.
    std::string run(const std::filesystem::path& file)
    {
        std::ifstream in{file};
        std::string line;
        int number = 0;
        while (std::getline(in, line)) {
            ++number;
            const std::string fault = step(line);
            if (!fault.empty()) {
                return file.filename().string() + ":" + std::to_string(number) + ": " + fault;
            }
        }
        return heard_.empty() ? "" : file.filename().string() + ": more was said: " + heard_[0];
    }

private:
    static constexpr unsigned kReadingTicks = 20;

    ControllerBench& bench()
    {
        if (!bench_) {
            bench_ = std::make_unique<ControllerBench>(geometry_, factory_);
            hear(bench_->exchange("", kReadingTicks));
        }
        return *bench_;
    }

    void hear(const std::string& answers)
    {
        std::istringstream lines{partial_ + answers};
        partial_.clear();
        std::string line;
        while (std::getline(lines, line)) {
            if (lines.eof()) {
                partial_ = line;
                return;
            }
            if (!line.empty() && line.back() == '\r') {
                line.pop_back();
            }
            heard_.push_back(line);
        }
    }

    std::string step(const std::string& line)
    {
        std::istringstream words{line};
        std::string word;
        words >> word;
        if (word.empty() || word[0] == '#') {
            return "";
        }
        if (word == ">" || word == ">>") {
            return send(line, word);
        }
        if (word == "=") {
            return expect(line.size() > 2 ? line.substr(2) : "");
        }
        if (word == "set") {
            return set(words);
        }
        if (word == "wait") {
            unsigned ticks = 0;
            words >> ticks;
            hear(bench().exchange("", ticks));
            return "";
        }
        return step_machine(word, words);
    }

    std::string step_machine(const std::string& word, std::istringstream& words)
    {
        if (word == "finish") {
            hear(bench().finish());
            return "";
        }
        if (word == "press" || word == "release") {
            unsigned bits = 0;
            words >> bits;
            bench().board.mill.force_high(static_cast<std::uint16_t>(bits));
            hear(bench().exchange("", kReadingTicks));
            return "";
        }
        if (word == "silent") {
            (void)bench();
            return heard_.empty() ? "" : "was said: " + heard_[0];
        }
        if (word == "at") {
            return at(words);
        }
        if (word == "state") {
            return state(words);
        }
        return "unknown word " + word;
    }

    std::string send(const std::string& line, const std::string& word)
    {
        ControllerBench& to = bench();
        if (!heard_.empty()) {
            return "more was said before: " + heard_[0];
        }
        const std::string text =
            line.size() > word.size() + 1 ? line.substr(word.size() + 1) : std::string{};
        hear(to.exchange(decoded(text) + (word == ">" ? "\n" : ""), kReadingTicks));
        return "";
    }

    std::string expect(const std::string& pattern)
    {
        (void)bench();
        if (heard_.empty()) {
            return "nothing was said";
        }
        const std::string said = heard_.front();
        heard_.pop_front();
        return matches(pattern, said) ? "" : "said: " + said;
    }

    std::string set(std::istringstream& words)
    {
        std::string assignment;
        words >> assignment;
        const std::size_t equals = assignment.find('=');
        const auto number = static_cast<std::uint32_t>(std::stoul(assignment.substr(0, equals)));
        return factory_.put(number, std::stof(assignment.substr(equals + 1))) ? "refused" : "";
    }

    std::string at(std::istringstream& words)
    {
        cusp::Vec3d wanted;
        words >> wanted.x >> wanted.y >> wanted.z;
        const cusp::Vec3d is = bench().position();
        constexpr double kNear = 0.0005;
        if (std::fabs(is.x - wanted.x) < kNear && std::fabs(is.y - wanted.y) < kNear &&
            std::fabs(is.z - wanted.z) < kNear) {
            return "";
        }
        return "is at " + std::to_string(is.x) + " " + std::to_string(is.y) + " " +
               std::to_string(is.z);
    }

    std::string state(std::istringstream& words)
    {
        std::string name;
        words >> name;
        if (!heard_.empty()) {
            return "more was said before: " + heard_[0];
        }
        hear(bench().exchange("?", 1));
        return expect("<" + name + "|*");
    }

    std::unique_ptr<ControllerBench> bench_;
    cusp::hal::MillGeometry geometry_;
    cusp::machine::Settings factory_;
    std::deque<std::string> heard_;
    std::string partial_;
};

}  // namespace

TEST_GROUP(Controller){};

TEST(Controller, AnswersEveryConversationAsWritten)
{
    unsigned conversations = 0;
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(CUSP_SOURCE_DIR "/tests/conformance/scripts")) {
        files.push_back(entry.path());
    }
    std::string faults;
    for (const std::filesystem::path& file : files) {
        const std::string fault = Conversation{}.run(file);
        faults += fault.empty() ? "" : fault + "\n";
        ++conversations;
    }
    CHECK(conversations > 10);
    CHECK_TEXT(faults.empty(), faults.c_str());
}
