// LineSource: a text line by line, from a file that is never held as a whole, or from memory.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cusp::dialect {

// Puts the next bytes of a text into `place` and returns how many, at most `room`; 0 at its end.
using ByteReader = std::function<std::size_t(char* place, std::size_t room)>;

class LineSource {
public:
    // Throws InputError where the file can't be read, here or at a later next().
    explicit LineSource(const std::string& file);

    //   size  of the whole text, bytes; 0 where that is not known
    LineSource(std::string name, ByteReader reader, std::uint64_t size);

    // A text in memory, which outlives the source.
    static LineSource of_text(std::string name, std::string_view text);

    // The next line without its end; \n, \r\n and \r end lines. None after the last. A line longer
    // than 64 kB is cut there; readers refuse it.
    std::optional<std::string> next();

    // Number of the line that next() returned last, from 1.
    std::uint64_t line_number() const { return line_number_; }

    // Share of the text that is read, 0 to 1; meaningless where its size is not known.
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
