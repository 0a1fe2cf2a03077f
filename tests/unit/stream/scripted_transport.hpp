// ScriptedTransport: a controller given by a function, for tests of the streamer.
#pragma once

#include <deque>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "host_tools/controller/stream/transport.hpp"

namespace cusp::test {

// Minimal Grbl: answers ok to each line, reports as scripted.
class ScriptedTransport : public stream::Transport {
public:
    // The answer to a line.
    std::function<std::string(const std::string&)> answer = [](const std::string&) {
        return std::string{"ok\r\n"};
    };
    std::function<std::string(char)> realtime = [](char) {
        return std::string{};
    };
    std::string state{"Idle"};
    // The text that comes in place of a status report.
    std::function<std::string(const std::string&)> report = [](const std::string& whole) {
        return whole;
    };
    // A byte is answered at the earliest this many reads later.
    int delay{0};
    bool gone{false};
    // Bytes that write() accepts at once.
    std::size_t mouthful{1000};

    std::vector<std::string> lines;
    std::string realtime_bytes;
    std::size_t most_unanswered{0};

    std::size_t write(std::string_view bytes) override
    {
        if (gone) {
            throw stream::LinkLost{"unplugged"};
        }
        bytes = bytes.substr(0, mouthful);
        for (const char byte : bytes) {
            take(byte);
        }
        most_unanswered = std::max(most_unanswered, unanswered_);
        return bytes.size();
    }

    std::string read(std::chrono::milliseconds) override
    {
        if (gone) {
            throw stream::LinkLost{"unplugged"};
        }
        std::string said;
        said.swap(spoken_);
        if (++reads_ > delay && !waiting_.empty()) {
            reads_ = 0;
            const std::string line = waiting_.front();
            waiting_.pop_front();
            unanswered_ -= line.size() + 1;
            lines.push_back(line);
            said += answer(line);
        }
        return said;
    }

    void say(const std::string& text) { spoken_ += text; }

private:
    void take(char byte)
    {
        if (byte == '?') {
            spoken_ += report("<" + state + "|MPos:1.000,2.000,3.000|FS:0,0>") + "\r\n";
        } else if (byte == '!' || byte == '~' || byte == '\x18' || (byte & 0x80) != 0) {
            realtime_bytes.push_back(byte);
            if (byte == '\x18') {
                waiting_.clear();
                unanswered_ = 0;
                state = "Idle";
                spoken_ += "\r\nGrbl 1.1h ['$' for help]\r\n";
            } else if (byte == '!') {
                state = "Hold:0";
            }
            spoken_ += realtime(byte);
        } else {
            ++unanswered_;
            if (byte == '\n') {
                waiting_.push_back(line_);
                line_.clear();
            } else {
                line_.push_back(byte);
            }
        }
    }

    std::string line_;
    std::string spoken_;
    std::deque<std::string> waiting_;
    std::size_t unanswered_{0};
    int reads_{0};
};

}  // namespace cusp::test
