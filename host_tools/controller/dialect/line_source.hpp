// LineSource: a text line by line, from a file that is read in blocks, or from memory.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cusp::dialect {

// Writes the next bytes of a text to `place` and returns their number, at most `room`; 0: the end.
using ByteReader = std::function<std::size_t(char* place, std::size_t room)>;

class LineSource {
public:
    // Throws InputError where the file can't be read, here or at a later next().
    explicit LineSource(const std::string& file);

    //   size  of the whole text, bytes; 0: unknown
    LineSource(std::string name, ByteReader reader, std::uint64_t size);

    // A text in memory, which must outlive the source.
    static LineSource of_text(std::string name, std::string_view text);

    // The next line without its end; \n, \r\n and \r end lines. No value after the last. A line
    // longer than 64 kB is truncated; readers refuse it.
    std::optional<std::string> next();

    // Number of the last line that next() returned, from 1.
    std::uint64_t line_number() const { return line_number_; }

    // Fraction of the text that is read, 0 to 1; undefined where its size is unknown.
    double progress() const;

    const std::string& name() const { return name_; }

private:
    int take();

    std::string name_;
    ByteReader reader_;
    std::uint64_t size_;
    std::vector<char> block_;
    std::size_t next_{0};  // in block_
    std::size_t end_{0};   // of what is read in block_
    std::uint64_t taken_{0};
    std::uint64_t line_number_{0};
    bool after_return_{false};
};

}  // namespace cusp::dialect
