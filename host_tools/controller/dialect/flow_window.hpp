// FlowWindow: the part of the controller's receive buffer that unanswered lines occupy.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

namespace cusp::dialect {

// Grbl answers each line once, in order, when it removes the line from its buffer. Counting the
// characters of unanswered lines keeps the buffer full without overflow.
class FlowWindow {
public:
    // Bytes of the receive buffer of a stock Grbl.
    static constexpr std::size_t kGrblBuffer = 128;

    explicit FlowWindow(std::size_t capacity = kGrblBuffer) : capacity_{capacity} {}

    void set_capacity(std::size_t capacity) { capacity_ = capacity; }
    std::size_t capacity() const { return capacity_; }

    // True if a line of `size` bytes, line end included, may be sent. A line longer than the buffer
    // may be sent alone.
    bool fits(std::size_t size) const { return lines_.empty() || used_ + size <= capacity_; }

    //   number  of the line in the program; 0: a command of the sender
    void sent(std::uint64_t number, std::size_t size)
    {
        lines_.push_back({number, size});
        used_ += size;
    }

    // Takes an answer. Returns the number of its line; no value where no answer was due.
    std::optional<std::uint64_t> answered()
    {
        if (lines_.empty()) {
            return std::nullopt;
        }
        const Line line = lines_.front();
        lines_.pop_front();
        used_ -= line.size;
        return line.number;
    }

    bool empty() const { return lines_.empty(); }
    std::size_t used() const { return used_; }
    std::size_t lines() const { return lines_.size(); }
    void clear()
    {
        lines_.clear();
        used_ = 0;
    }

private:
    struct Line {
        std::uint64_t number;
        std::size_t size;
    };
    std::size_t capacity_;
    std::size_t used_{0};
    std::deque<Line> lines_;
};

}  // namespace cusp::dialect
