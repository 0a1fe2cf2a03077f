// LineSource: a text file line by line, never held as a whole.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>

namespace cusp::dialect {

class LineSource {
public:
    // Throws InputError where the file can't be read.
    explicit LineSource(const std::string& file);

    // The next line without its end; \n, \r\n and \r end lines. None after the last. A line longer
    // than 64 kB is cut there; readers refuse it.
    std::optional<std::string> next();

    // Number of the line that next() returned last, from 1.
    std::uint64_t line_number() const { return line_number_; }

    // Share of the file that is read, 0 to 1; meaningless for pipes and devices.
    double progress() const;

    const std::string& name() const { return name_; }

private:
    int take();

    std::string name_;
    std::ifstream in_;
    std::uint64_t size_{0};
    std::uint64_t taken_{0};
    std::uint64_t line_number_{0};
    bool after_return_{false};
};

}  // namespace cusp::dialect
