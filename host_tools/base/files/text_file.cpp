// The buffer of an output file.
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"

namespace cusp::files {
namespace {

constexpr std::size_t kBufferSize = 1 << 16;

}  // namespace

TextFile::TextFile(const std::string& file) : name_{file}, out_{file, std::ios::binary}
{
    if (!out_) {
        throw InputError{name_ + ": can't be written: " + std::strerror(errno)};
    }
    buffer_.reserve(kBufferSize);
}

void TextFile::write(std::string_view text)
{
    if (buffer_.size() + text.size() > kBufferSize) {
        flush();
    }
    buffer_ += text;
}

void TextFile::write_number(std::int64_t number)
{
    std::array<char, 24> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
    write(std::string_view{digits.data(), static_cast<std::size_t>(end - digits.data())});
}

void TextFile::close()
{
    flush();
    out_.close();
    if (!out_) {
        throw InputError{name_ + ": can't be written: " + std::strerror(errno)};
    }
}

void TextFile::flush()
{
    out_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
    buffer_.clear();
    if (!out_) {
        throw InputError{name_ + ": can't be written: " + std::strerror(errno)};
    }
}

void write_text(const std::string& file, std::string_view text)
{
    TextFile out{file};
    out.write(text);
    out.close();
}

void write_all(const std::vector<NewFile>& files)
{
    for (const NewFile& file : files) {
        try {
            write_text(file.name, file.text);
        } catch (const InputError&) {
            for (const NewFile* written = files.data(); written <= &file; ++written) {
                if (std::filesystem::is_regular_file(written->name)) {
                    std::filesystem::remove(written->name);
                }
            }
            throw;
        }
    }
}

}  // namespace cusp::files
