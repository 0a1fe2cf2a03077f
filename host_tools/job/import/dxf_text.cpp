// The code page is read from the bytes, since groups and values of the header are ASCII in all of them.
#include "host_tools/job/import/dxf_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <iconv.h>
#include <optional>

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

constexpr std::string_view kUnknown{"\xEF\xBF\xBD"};  // U+FFFD
constexpr std::string_view kFirstInUnicode{"AC1021"};

bool starts_with(std::string_view text, std::string_view start)
{
    return text.substr(0, start.size()) == start;
}

void refuse_other_formats(std::string_view bytes, const std::string& file)
{
    const auto refuse = [&](const char* what) {
        throw InputError(fmt::format("{}: {}: save it as ASCII DXF", file, what));
    };
    if (starts_with(bytes, "AutoCAD Binary DXF")) {
        refuse("binary DXF");
    }
    if (starts_with(bytes, "\xFF\xFE") || starts_with(bytes, "\xFE\xFF")) {
        refuse("DXF in UTF-16, by its byte order mark");
    }
    // The first group code is ASCII: in UTF-16 every second byte of it is 0.
    const std::string_view head = bytes.substr(0, 4);
    if (head.size() == 4 && (head[0] == '\0') != (head[1] == '\0') &&
        (head[2] == '\0') != (head[3] == '\0')) {
        refuse("DXF in UTF-16");
    }
    if (starts_with(bytes, "AC10")) {
        refuse("a DWG drawing");
    }
    if (const std::size_t at = bytes.find('\0'); at != std::string_view::npos) {
        const auto end = bytes.begin() + static_cast<std::ptrdiff_t>(at);
        throw InputError(fmt::format("{}:{}: a NUL byte: no DXF text", file,
                                     1 + std::count(bytes.begin(), end, '\n')));
    }
}

// The value of a header variable of one group: three lines on.
std::string_view header_value(std::string_view bytes, std::string_view name)
{
    std::size_t at = bytes.find(name);
    for (int line = 0; line < 2 && at != std::string_view::npos; ++line) {
        at = bytes.find('\n', at);
        at += at == std::string_view::npos ? 0 : 1;
    }
    if (at == std::string_view::npos) {
        return {};
    }
    std::string_view value = bytes.substr(at, bytes.find_first_of("\r\n", at) - at);
    value.remove_prefix(std::min(value.find_first_not_of(" \t"), value.size()));
    return value.substr(0, value.find_last_not_of(" \t") + 1);
}

// The name that iconv has for the code page.
std::string encoding_of(std::string_view page)
{
    std::string name;
    for (const char c : page) {
        name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    }
    constexpr std::array<std::array<std::string_view, 2>, 3> kPrefixes{
        {{"ANSI_", "CP"}, {"DOS", "CP"}, {"ISO8859-", "ISO-8859-"}}};
    for (const auto& [prefix, known] : kPrefixes) {
        if (starts_with(name, prefix)) {
            return std::string{known} + name.substr(prefix.size());
        }
    }
    constexpr std::array<std::array<std::string_view, 2>, 6> kNames{{{"GB2312", "GBK"},
                                                                     {"KSC5601", "CP949"},
                                                                     {"BIG5", "CP950"},
                                                                     {"JOHAB", "JOHAB"},
                                                                     {"MACINTOSH", "MACINTOSH"},
                                                                     {"UTF-8", "UTF-8"}}};
    for (const auto& [known, encoding] : kNames) {
        if (name == known) {
            return std::string{encoding};
        }
    }
    return "CP1252";
}

class Converter {
public:
    explicit Converter(const std::string& encoding)
        : to_utf8_{iconv_open("UTF-8", encoding.c_str())}
    {
    }
    ~Converter()
    {
        if (known()) {
            iconv_close(to_utf8_);
        }
    }
    Converter(const Converter&) = delete;
    Converter& operator=(const Converter&) = delete;

    bool known() const
    {
        return to_utf8_ != reinterpret_cast<iconv_t>(-1);  // NOLINT: the value of iconv(3)
    }

    // unreadable  receives the number of bytes that became U+FFFD
    std::string convert(std::string_view bytes, std::size_t& unreadable)
    {
        std::string out;
        std::array<char, 4096> buffer{};
        std::string copy{bytes};  // iconv() takes no constant text
        char* in = copy.data();
        std::size_t left = copy.size();
        while (left > 0) {
            char* to = buffer.data();
            std::size_t room = buffer.size();
            const std::size_t before = left;
            iconv(to_utf8_, &in, &left, &to, &room);
            out.append(buffer.data(), buffer.size() - room);
            if (left == before) {  // a byte that begins no character
                out += kUnknown;
                ++unreadable;
                ++in;
                --left;
            }
        }
        return out;
    }

private:
    iconv_t to_utf8_;
};

bool is_ascii(std::string_view text)
{
    return std::all_of(text.begin(), text.end(),
                       [](char c) { return static_cast<unsigned char>(c) < 0x80; });
}

// Every byte of a single-byte code page is a character, so that text which is valid UTF-8 is UTF-8: some
// programs write it under any version. Pairs of bytes of the East Asian pages may look like it.
bool is_east_asian(std::string_view encoding)
{
    constexpr std::array<std::string_view, 7> kPages{"CP932", "CP936",  "GBK",  "CP949",
                                                     "CP950", "CP1361", "JOHAB"};
    return std::find(kPages.begin(), kPages.end(), encoding) != kPages.end();
}

std::string in_utf8(std::string_view bytes)
{
    if (is_ascii(bytes)) {
        return std::string{bytes};
    }
    const std::string_view version = header_value(bytes, "$ACADVER");
    const std::string encoding = encoding_of(header_value(bytes, "$DWGCODEPAGE"));
    const bool unicode = starts_with(version, "AC") && version >= kFirstInUnicode;
    if (unicode || !is_east_asian(encoding)) {
        std::size_t unreadable = 0;
        std::string text = Converter{"UTF-8"}.convert(bytes, unreadable);
        if (unreadable == 0) {
            return text;
        }
    }
    Converter from_page{encoding};
    std::size_t unreadable = 0;
    return from_page.known() ? from_page.convert(bytes, unreadable)
                             : Converter{"CP1252"}.convert(bytes, unreadable);
}

void append_utf8(std::string& out, std::uint32_t code)
{
    const auto add = [&](std::uint32_t byte) {
        out += static_cast<char>(byte);
    };
    if (code < 0x80) {
        add(code);
    } else if (code < 0x800) {
        add(0xC0 | code >> 6U);
        add(0x80 | (code & 0x3FU));
    } else if (code < 0x10000) {
        add(0xE0 | code >> 12U);
        add(0x80 | (code >> 6U & 0x3FU));
        add(0x80 | (code & 0x3FU));
    } else {
        add(0xF0 | code >> 18U);
        add(0x80 | (code >> 12U & 0x3FU));
        add(0x80 | (code >> 6U & 0x3FU));
        add(0x80 | (code & 0x3FU));
    }
}

constexpr std::size_t kEscape = 7;  // \U+XXXX

std::optional<std::uint32_t> escaped_at(std::string_view text, std::size_t at)
{
    if (text.size() < at + kEscape || (text[at + 1] != 'U' && text[at + 1] != 'u') ||
        text[at + 2] != '+') {
        return std::nullopt;
    }
    std::uint32_t code = 0;
    const char* begin = text.data() + at + 3;
    const auto [stop, error] = std::from_chars(begin, begin + 4, code, 16);
    constexpr std::uint32_t kFirstPrinted = 0x20;  // a line's end would make a group of it
    if (error != std::errc{} || stop != begin + 4 || code < kFirstPrinted) {
        return std::nullopt;
    }
    return code;
}

std::string unescaped(std::string text)
{
    std::size_t at = text.find('\\');
    if (at == std::string::npos) {
        return text;
    }
    std::string out = text.substr(0, at);
    while (at < text.size()) {
        const auto first = text[at] == '\\' ? escaped_at(text, at) : std::nullopt;
        if (!first) {
            out += text[at++];
            continue;
        }
        at += kEscape;
        std::uint32_t code = *first;
        const bool high = code >= 0xD800 && code < 0xDC00;
        const auto low =
            high && at < text.size() && text[at] == '\\' ? escaped_at(text, at) : std::nullopt;
        if (low && *low >= 0xDC00 && *low < 0xE000) {
            code = 0x10000 + ((code - 0xD800) << 10U) + (*low - 0xDC00);
            at += kEscape;
        }
        if (code >= 0xD800 && code < 0xE000) {  // half of a pair
            out += kUnknown;
        } else {
            append_utf8(out, code);
        }
    }
    return out;
}

}  // namespace

std::string dxf_text(std::string_view bytes, const std::string& file)
{
    bytes = files::without_byte_order_mark(bytes);
    refuse_other_formats(bytes, file);
    std::string text = unescaped(in_utf8(bytes));
    if (text.find('\n') == std::string::npos) {  // lines as old Macs end them
        std::replace(text.begin(), text.end(), '\r', '\n');
    }
    return text;
}

}  // namespace cusp::import
