// Letters stand a constant gap apart.
#include "host_tools/job/import/stroke_font.hpp"

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/svg_path.hpp"

#include "fmt/format.h"

namespace cusp::import {

std::vector<char32_t> characters_of(const std::string& text)
{
    constexpr char32_t kUnknown = 0xFFFD;
    std::vector<char32_t> out;
    for (std::size_t k = 0; k < text.size();) {
        const auto byte = static_cast<unsigned char>(text[k++]);
        const int more = byte < 0x80   ? 0
                         : byte < 0xC0 ? -1
                         : byte < 0xE0 ? 1
                         : byte < 0xF0 ? 2
                         : byte < 0xF8 ? 3
                                       : -1;
        char32_t value = more < 0    ? kUnknown
                         : more == 0 ? byte
                                     : byte & (0x3FU >> static_cast<unsigned>(more));
        for (int left = more; left > 0; --left) {
            const bool follows =
                k < text.size() && (static_cast<unsigned char>(text[k]) & 0xC0U) == 0x80;
            if (!follows) {
                value = kUnknown;
                break;
            }
            value = value << 6U | (static_cast<unsigned char>(text[k++]) & 0x3FU);
        }
        out.push_back(value);
    }
    return out;
}

std::string name_of_character(char32_t character)
{
    const auto code = static_cast<unsigned>(character);
    std::string utf8;
    const auto add = [&](unsigned byte) {
        utf8 += static_cast<char>(byte);
    };
    if (code < 0x80) {
        add(code);
    } else if (code < 0x800) {
        add(0xC0U | code >> 6U);
        add(0x80U | (code & 0x3FU));
    } else if (code < 0x10000) {
        add(0xE0U | code >> 12U);
        add(0x80U | (code >> 6U & 0x3FU));
        add(0x80U | (code & 0x3FU));
    } else {
        add(0xF0U | code >> 18U);
        add(0x80U | (code >> 12U & 0x3FU));
        add(0x80U | (code >> 6U & 0x3FU));
        add(0x80U | (code & 0x3FU));
    }
    return code < 0x20 ? fmt::format("U+{:04X}", code) : fmt::format("{} (U+{:04X})", utf8, code);
}

FontSize stroke_font_size() { return {6, 10}; }

FontLine stroke_line(const std::string& text, const std::string& place)
{
    constexpr double kGap = 1.4;
    FontLine line;
    for (const char32_t character : characters_of(text)) {
        const StrokeLetter* letter = find_stroke_letter(character);
        if (letter == nullptr) {
            throw InputError(fmt::format(
                "{}: the single-line font does not have {}; font names a file that has it", place,
                name_of_character(character)));
        }
        line.width += line.letters.empty() ? 0 : kGap;
        line.letters.push_back({paths_of_data(letter->strokes, place), line.width, letter->width});
        line.width += letter->width;
    }
    return line;
}

}  // namespace cusp::import
