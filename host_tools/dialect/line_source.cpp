// Splits a file into lines.
#include "host_tools/dialect/line_source.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "host_tools/input_error/input_error.hpp"

namespace cusp::dialect {
namespace {

constexpr std::size_t kLongestLine = 1 << 16;

}  // namespace

LineSource::LineSource(const std::string& file) : name_{file}, in_{file, std::ios::binary}
{
    std::error_code failed;
    if (std::filesystem::is_directory(file, failed)) {
        throw InputError{name_ + ": is a folder, not a file"};
    }
    if (!in_) {
        throw InputError{name_ + ": can't be read: " + std::strerror(errno)};
    }
    size_ = std::filesystem::file_size(file, failed);
    if (failed) {
        size_ = 0;
    }
}

std::optional<std::string> LineSource::next()
{
    constexpr int kEnd = std::char_traits<char>::eof();
    std::string line;
    int character = take();
    if (after_return_ && character == '\n') {
        character = take();
    }
    after_return_ = false;
    if (character == kEnd) {
        if (in_.bad()) {
            throw InputError{name_ + ": can't be read: " + std::strerror(errno)};
        }
        return std::nullopt;
    }
    while (character != kEnd && character != '\n' && character != '\r') {
        if (line.size() < kLongestLine) {
            line.push_back(static_cast<char>(character));
        }
        character = take();
    }
    after_return_ = character == '\r';
    ++line_number_;
    return line;
}

double LineSource::progress() const
{
    return size_ == 0 ? 0.0 : static_cast<double>(taken_) / static_cast<double>(size_);
}

int LineSource::take()
{
    const int character = in_.rdbuf()->sbumpc();
    if (character != std::char_traits<char>::eof()) {
        ++taken_;
    }
    return character;
}

}  // namespace cusp::dialect
