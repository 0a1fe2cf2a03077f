// Reads lines from files.
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <system_error>

#include "host_tools/base/files/file_set.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/controller/dialect/line_source.hpp"

namespace cusp::dialect {
namespace {

ByteReader reader_of(const std::string& file)
{
    std::error_code failed;
    if (std::filesystem::is_directory(file, failed)) {
        throw InputError{file + ": is a folder, not a file"};
    }
    const auto in = std::make_shared<std::ifstream>(file, std::ios::binary);
    if (!*in) {
        throw InputError{file + ": can't be read: " + std::strerror(errno)};
    }
    return [file, in](char* place, std::size_t room) {
        in->read(place, static_cast<std::streamsize>(room));
        if (in->bad()) {
            throw InputError{file + ": can't be read: " + std::strerror(errno)};
        }
        return static_cast<std::size_t>(in->gcount());
    };
}

std::uint64_t size_of(const std::string& file)
{
    std::error_code failed;
    const std::uintmax_t size = std::filesystem::file_size(file, failed);
    return failed ? 0 : size;
}

LineSource opened(const std::string& file)
{
    if (const std::string* text = files::find_in_memory(file)) {
        return LineSource::of_text(file, *text);
    }
    return {file, reader_of(file), size_of(file)};
}

}  // namespace

LineSource::LineSource(const std::string& file) : LineSource{opened(file)} {}

}  // namespace cusp::dialect
