// Reads large files once, without a copy.
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "host_tools/base/files/file_set.hpp"
#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"

namespace cusp::files {

std::string text_of_file(const std::string& file)
{
    if (const std::string* text = find_in_memory(file)) {
        return *text;
    }
    if (std::filesystem::is_directory(file)) {
        throw InputError(file + ": is a folder");
    }
    errno = 0;
    std::ifstream in(file, std::ios::binary);
    // The size of a pipe is unknown: it is read to its end.
    std::string text;
    std::error_code unknown;
    const std::uintmax_t size = std::filesystem::file_size(file, unknown);
    text.resize(unknown ? 0 : static_cast<std::size_t>(size));
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount())));
    text.append(std::istreambuf_iterator<char>{in}, {});
    if (!in && errno != 0) {
        throw InputError(file + ": can't be read: " + std::strerror(errno));
    }
    return text;
}

}  // namespace cusp::files
