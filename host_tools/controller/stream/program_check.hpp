// ProgramCheck: whether a program is unchanged up to a line.
#pragma once

#include <cstdint>
#include <deque>
#include <utility>

#include "firmware/protocol/crc32.hpp"
#include "host_tools/controller/dialect/program_lines.hpp"

namespace cusp::stream {

class ProgramCheck {
public:
    void add(const dialect::ProgramLine& line)
    {
        for (const char character : line.text) {
            crc_.add(static_cast<std::uint8_t>(character));
        }
        crc_.add(static_cast<std::uint8_t>('\n'));
        line_ = line.number;
    }

    // Number of the line that was added last; 0: none.
    std::uint64_t lines() const { return line_; }
    // Checksum of the text of all lines added.
    std::uint32_t crc() const { return crc_.value(); }

private:
    protocol::Crc32 crc_;
    std::uint64_t line_{0};
};

// The checks of lines in flight, stored until they are executed; of very many only some.
class ProgramChecks {
public:
    struct Mark {
        std::uint64_t line;
        std::uint32_t crc;
    };

    void add(const dialect::ProgramLine& line)
    {
        constexpr std::size_t kMany = 4096;
        constexpr unsigned kStride = 64;
        check_.add(line);
        if (marks_.size() < kMany || ++skipped_ == kStride) {
            skipped_ = 0;
            marks_.push_back({check_.lines(), check_.crc()});
        }
    }

    // The last mark before `line`; its line is 0 if there is none yet. Marks before it are dropped.
    Mark before(std::uint64_t line)
    {
        while (!marks_.empty() && marks_.front().line < line) {
            passed_ = marks_.front();
            marks_.pop_front();
        }
        return passed_;
    }

private:
    ProgramCheck check_;
    unsigned skipped_{0};
    std::deque<Mark> marks_;
    Mark passed_{0, 0};
};

}  // namespace cusp::stream
