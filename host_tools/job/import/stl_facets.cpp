// Binary STL: a header of 80 bytes, a count, 50 bytes for each facet. ASCII STL: words.
#include "host_tools/job/import/stl_facets.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string_view>

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/number_text/number_text.hpp"

#include "fmt/format.h"

namespace cusp::import {
using number_text::number_of;

namespace {

constexpr std::size_t kHead = 84;
constexpr std::size_t kFacet = 50;
constexpr std::size_t kNormal = 12;

// Little endian.
std::uint32_t word_at(const std::string& bytes, std::size_t at)
{
    std::uint32_t word = 0;
    for (std::size_t i = 4; i-- > 0;) {
        word = word << 8U | static_cast<unsigned char>(bytes[at + i]);
    }
    return word;
}

double float_at(const std::string& bytes, std::size_t at)
{
    const std::uint32_t word = word_at(bytes, at);
    float value = 0;
    std::memcpy(&value, &word, sizeof value);
    return static_cast<double>(value);
}

Facets read_binary(const std::string& bytes, double unit, const std::string& file)
{
    const std::size_t count = word_at(bytes, kHead - 4);
    if (bytes.size() < kHead + count * kFacet) {
        throw InputError(fmt::format("{}: truncated: {} facets need {} bytes; the file has {}",
                                     file, count, kHead + count * kFacet, bytes.size()));
    }
    Facets facets;
    facets.triangles.reserve(count);
    for (std::size_t k = 0; k < count; ++k) {
        std::array<Vec3d, 3> corners;
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t at = kHead + k * kFacet + kNormal + 12 * c;
            corners[c] =
                unit * Vec3d{float_at(bytes, at), float_at(bytes, at + 4), float_at(bytes, at + 8)};
            check_corner(corners[c], [&] { return fmt::format("{}: facet {}", file, k + 1); });
        }
        add_facet(corners, facets);
    }
    return facets;
}

// The words of an ASCII file with their line numbers.
class Words {
public:
    Words(std::string_view text, std::string file) : rest_{text}, file_{std::move(file)} {}

    // The next word in lower case; "" at the end.
    std::string next()
    {
        while (!rest_.empty() && std::isspace(static_cast<unsigned char>(rest_.front())) != 0) {
            line_ += rest_.front() == '\n' ? 1 : 0;
            rest_.remove_prefix(1);
        }
        std::string word;
        while (!rest_.empty() && std::isspace(static_cast<unsigned char>(rest_.front())) == 0) {
            word += static_cast<char>(std::tolower(static_cast<unsigned char>(rest_.front())));
            rest_.remove_prefix(1);
        }
        return word;
    }
    void skip_line() { rest_.remove_prefix(std::min(rest_.find_first_of("\r\n"), rest_.size())); }
    void expect(const char* wanted)
    {
        const std::string word = next();
        if (word != wanted) {
            refuse(word, fmt::format("\"{}\" is needed", wanted));
        }
    }
    double number()
    {
        const std::string word = next();
        const auto value = number_of(word);
        if (!value) {
            refuse(word, "a number is needed");
        }
        return *value;
    }
    [[noreturn]] void refuse(const std::string& word, const std::string& needed) const
    {
        throw InputError(word.empty() ? fmt::format("{}:{}: truncated: {}", file_, line_, needed)
                                      : fmt::format("{}:{}: \"{}\" found, {}", file_, line_,
                                                    word.substr(0, 40), needed));
    }
    std::string place() const { return fmt::format("{}:{}", file_, line_); }

private:
    std::string_view rest_;
    std::string file_;
    int line_{1};
};

std::array<Vec3d, 3> read_facet(Words& words, double unit)
{
    words.expect("normal");
    for (int i = 0; i < 3; ++i) {
        words.next();  // the corners define the normal; some programs write "nan" here
    }
    words.expect("outer");
    words.expect("loop");
    std::array<Vec3d, 3> corners;
    for (Vec3d& corner : corners) {
        words.expect("vertex");
        for (unsigned axis = 0; axis < 3; ++axis) {
            corner[axis] = unit * words.number();
        }
        check_corner(corner, [&] { return words.place(); });
    }
    words.expect("endloop");
    words.expect("endfacet");
    return corners;
}

Facets read_ascii(const std::string& text, double unit, const std::string& file)
{
    Words words{files::without_byte_order_mark(text), file};
    Facets facets;
    words.expect("solid");
    words.skip_line();  // the name of the solid is free text
    bool open = true;
    for (std::string word = words.next();; word = words.next()) {
        if (word == "facet" && open) {
            add_facet(read_facet(words, unit), facets);
        } else if (word == "endsolid" && open) {
            words.skip_line();
            open = false;
        } else if (word == "solid" && !open) {
            words.skip_line();
            open = true;
        } else if (word.empty() && !open) {
            return facets;
        } else {
            words.refuse(word,
                         open ? "\"facet\" or \"endsolid\" is needed" : "\"solid\" is needed");
        }
    }
}

// True if the next word is one of these, in any case.
bool next_is(std::string_view text, std::initializer_list<std::string_view> words)
{
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
    return std::any_of(words.begin(), words.end(), [&](std::string_view word) {
        const std::string_view start = text.substr(0, word.size());
        return std::equal(start.begin(), start.end(), word.begin(), word.end(), [](char a, char b) {
            return std::tolower(static_cast<unsigned char>(a)) == b;
        });
    });
}

// A binary header may also start with "solid", so the size is tested first, and then what follows the
// first line.
bool is_ascii(const std::string& bytes)
{
    if (bytes.size() >= kHead && bytes.size() == kHead + word_at(bytes, kHead - 4) * kFacet) {
        return false;
    }
    const std::string_view text = files::without_byte_order_mark(bytes);
    if (!next_is(text, {"solid"})) {
        return false;
    }
    const std::string_view rest = text.substr(std::min(text.find_first_of("\r\n"), text.size()));
    return text.find('\0') == std::string_view::npos || next_is(rest, {"facet", "endsolid"});
}

// A binary file with this would have half a thousand million facets.
bool is_other_text(const std::string& bytes)
{
    return std::all_of(bytes.begin(), bytes.begin() + kHead, [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return std::isprint(byte) != 0 || std::isspace(byte) != 0;
    });
}

}  // namespace

Facets read_stl(const std::string& file, double millimetres)
{
    const std::string bytes = files::text_of_file(file);
    const bool ascii = is_ascii(bytes);
    if (!ascii && (bytes.size() < kHead || is_other_text(bytes))) {
        throw InputError(fmt::format(
            "{}: no STL: neither \"solid\" nor the {} bytes that a binary one has at least", file,
            kHead));
    }
    return ascii ? read_ascii(bytes, millimetres, file) : read_binary(bytes, millimetres, file);
}

}  // namespace cusp::import
