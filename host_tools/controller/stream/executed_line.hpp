// ExecutedLine: the line that the tool has certainly reached, from reports and answers.
//
// The Ln field of a report is the line that the path has reached; the tool follows within half a
// second, the longest filters included. Thus the newest line counts that was reported at least half
// a second before the controller's last output. A controller whose reports have no Ln has executed
// as many lines as it has answered beyond the blocks of its planner, since each motion takes at
// least one block.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>

namespace cusp::stream {

class ExecutedLine {
public:
    using Clock = std::chrono::steady_clock;

    // Line at which the program starts or resumes.
    void begin_at(std::uint64_t line) { line_ = begin_ = line; }

    // A report with a line number.
    void reported(std::uint64_t line, Clock::time_point now)
    {
        constexpr std::chrono::milliseconds kLag{500};
        if (!names_lines_) {
            names_lines_ = true;
            line_ = begin_;
        }
        while (!reports_.empty() && now - reports_.front().at >= kLag) {
            line_ = reports_.front().line;
            reports_.pop_front();
        }
        // Lines never decrease: a report that did was damaged, or the one before it was.
        while (!reports_.empty() && reports_.back().line > line) {
            reports_.pop_back();
        }
        if (reports_.empty() || reports_.back().line != line) {
            reports_.push_back({line, now});
        }
    }
    // A report in motion without a line number.
    void reported_none() { ++unnamed_; }
    // Free planner blocks, if a report contains them.
    void blocks_free(std::size_t blocks) { blocks_ = blocks > blocks_ ? blocks : blocks_; }

    void answered(std::uint64_t line)
    {
        constexpr unsigned kSurely = 5;
        if (names_lines_) {
            answered_.clear();
            return;
        }
        answered_.push_back(line);
        while (answered_.size() > blocks_ + 1) {
            line_ = unnamed_ >= kSurely ? answered_.front() : line_;
            answered_.pop_front();
        }
    }

    std::uint64_t line() const { return line_; }

private:
    struct Report {
        std::uint64_t line;
        Clock::time_point at;
    };
    std::uint64_t line_{0};
    std::uint64_t begin_{0};
    bool names_lines_{false};
    unsigned unnamed_{0};
    std::size_t blocks_{16};  // as a stock Grbl has
    std::deque<Report> reports_;
    std::deque<std::uint64_t> answered_;
};

}  // namespace cusp::stream
