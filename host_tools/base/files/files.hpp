// Reads and writes whole files; every failure is an InputError.
//
//     const std::string program = files::text_of_file("part.ngc");
//     files::write_text("copy.ngc", program);
#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace cusp::files {

// The content of a file. Throws InputError with the file's name and the system's reason.
std::string text_of_file(const std::string& file);

// Without the mark with which some editors begin a text in UTF-8.
constexpr std::string_view without_byte_order_mark(std::string_view text)
{
    constexpr std::string_view kMark{"\xEF\xBB\xBF"};
    return text.substr(text.substr(0, kMark.size()) == kMark ? kMark.size() : 0);
}

// An output file written through one large buffer. Throws InputError where the file can't be made
// or written (the disk is full).
class TextFile {
public:
    explicit TextFile(const std::string& file);

    void write(std::string_view text);
    void write(char character) { write(std::string_view{&character, 1}); }
    void write_number(std::int64_t number);

    // Flushes the buffer and closes; nothing may be written afterwards.
    void close();

private:
    void flush();

    std::string name_;
    std::ofstream out_;
    std::string buffer_;
};

// A whole file at once.
void write_text(const std::string& file, std::string_view text);

struct NewFile {
    std::string name;
    std::string text;
};

// Writes all files, or leaves none of them where one can't be written. Devices stay.
void write_all(const std::vector<NewFile>& files);

}  // namespace cusp::files
