// TextFile: an output file written through one large buffer, whose failure is never silent.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

namespace cusp::simulate {

// Throws InputError where the file can't be made or written (the disk is full).
class TextFile {
public:
    explicit TextFile(const std::string& file);

    void write(std::string_view text);
    void write(char character) { write(std::string_view{&character, 1}); }
    void write_number(std::int64_t number);

    // Writes what is buffered; nothing may be written afterwards.
    void close();

private:
    void flush();

    std::string name_;
    std::ofstream out_;
    std::string buffer_;
};

// A whole file at once.
void write_text(const std::string& file, std::string_view text);

}  // namespace cusp::simulate
