// Layers in every code page that drawings come in; what is no DXF text is named.
#include "host_tools/job/import/dxf_text.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "CppUTest/TestHarness.h"

#include "host_tools/job/import/dxf_curves.hpp"
#include "tests/support/drawn_dxf.hpp"
#include "tests/support/refusal.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace cusp;
using namespace cusp::import;
using namespace cusp::test;
using namespace std::string_literals;

namespace {

std::string in_page(const std::string& page,
                    const std::string& layer,
                    const char* version = "AC1015")
{
    return dxf_drawing(dxf_circle({0, 0}, 5, layer),
                       {{9, "$ACADVER"}, {1, version}, {9, "$DWGCODEPAGE"}, {3, page}});
}

std::string refused_text(const std::string& bytes)
{
    return refusal([&] { dxf_text(bytes, "d.dxf"); });
}

std::string utf16(std::string_view text, bool big)
{
    std::string out;
    for (const char c : text) {
        out += big ? std::string{'\0', c} : std::string{c, '\0'};
    }
    return out;
}

}  // namespace

TEST_GROUP(DxfText)
{
    TemporaryFolder folder;
    // True if a job in UTF-8 can name the layer.
    void finds(const std::string& bytes, const std::string& layer)
    {
        const auto found = read_dxf_paths(folder.with("d.dxf", bytes), 1, layer);
        UNSIGNED_LONGS_EQUAL(1, found.paths.size());
    }
};

TEST(DxfText, LayersOfEveryCodePageHaveTheirNamesInUnicode)
{
    // the bytes as each page has them, and in UTF-8
    const std::vector<std::array<std::string, 3>> cases{
        {"ANSI_1250", "\x8Aroub", "Šroub"},
        {"ANSI_1251", "\xCA\xEE\xED\xF2\xF3\xF0", "Контур"},
        {"ANSI_1252", "Fr\xE4sen \xD8", "Fräsen Ø"},
        {"ansi_1252", "Au\xDF\x65n", "Außen"},
        {"ANSI_1253", "\xD4\xEF\xEC\xDE", "Τομή"},
        {"ANSI_1254", "Kes\xFDm", "Kesım"},
        {"ANSI_1255", "\xE7\xE9\xFA\xE5\xEA", "חיתוך"},
        {"ANSI_1256", "\xDE\xD8\xDA", "قطع"},
        {"ANSI_1257", "Gr\xE6\xFEt", "Gręžt"},
        {"ANSI_1258", "c\xE3t", "căt"},
        {"ANSI_874", "\xB5\xD1\xB4", "ตัด"},
        {"ANSI_932", "\x8A\x4F\x8C\x60", "外形"},
        {"ANSI_936", "\xC2\xD6\xC0\xAA", "轮廓"},
        {"ANSI_949", "\xBF\xDC\xB0\xFB", "외곽"},
        {"ANSI_950", "\xBD\xFC\xB9\xF8", "輪廓"},
        {"DOS850", "Fr\x84sen", "Fräsen"},
        {"ISO8859-1", "\xE9\x62", "éb"},
        {"unheard_of", "Fr\xE4sen", "Fräsen"}};
    for (const auto& [page, bytes, name] : cases) {
        finds(in_page(page, bytes), name);
    }
}

TEST(DxfText, FilesOfAc1021OnAreUtf8WhateverTheirCodePage)
{
    finds(in_page("ANSI_1252", "Fräsen", "AC1021"), "Fräsen");
    finds(in_page("ANSI_932", "外形", "AC1032"), "外形");
    // wrongly written ones
    finds(in_page("ANSI_1252", "Fräsen"), "Fräsen");
    finds(in_page("ANSI_1252", "Fr\xE4sen", "AC1027"), "Fräsen");
    finds(dxf_drawing(dxf_circle({0, 0}, 5, "Fr\xE4sen")), "Fräsen");
}

TEST(DxfText, EscapesAreTheirCharacters)
{
    finds(in_page("ANSI_1252", "Fr\\U+00E4sen"), "Fräsen");
    finds(in_page("ANSI_1252", "\\U+5916\\U+5f62 a"), "外形 a");
    finds(in_page("ANSI_1252", "\\U+D83D\\U+DE00"), "😀");
    finds(in_page("ANSI_1252", "\\U+D83D"), "\xEF\xBF\xBD");
    // not escapes: a line's end, too few digits
    finds(in_page("ANSI_1252", "\\U+000A"), "\\U+000A");
    finds(in_page("ANSI_1252", "\\U+12"), "\\U+12");
}

TEST(DxfText, AByteOrderMarkIsSkipped)
{
    finds("\xEF\xBB\xBF" + in_page("ANSI_1252", "Fräsen", "AC1021"), "Fräsen");
    finds("\xEF\xBB\xBF" + in_page("ANSI_1252", "o"), "o");
}

TEST(DxfText, LinesMayEndAsOnOldMacs)
{
    std::string text = in_page("ANSI_1252", "o");
    std::replace(text.begin(), text.end(), '\n', '\r');
    finds(text, "o");
}

TEST(DxfText, OtherFormatsAreNamed)
{
    const std::string text = in_page("ANSI_1252", "o");
    STRCMP_CONTAINS("d.dxf: binary DXF: save it as ASCII DXF",
                    refused_text("AutoCAD Binary DXF\r\n\x1A\0\0\0SECTION\0"s).c_str());
    STRCMP_CONTAINS("UTF-16, by its byte order mark",
                    refused_text("\xFF\xFE" + utf16(text, false)).c_str());
    STRCMP_CONTAINS("UTF-16, by its byte order mark",
                    refused_text("\xFE\xFF" + utf16(text, true)).c_str());
    STRCMP_CONTAINS("DXF in UTF-16", refused_text(utf16(text, false)).c_str());
    STRCMP_CONTAINS("DXF in UTF-16", refused_text(utf16(text, true)).c_str());
    STRCMP_CONTAINS("a DWG drawing", refused_text("AC1027\0\0\0\0\0"s).c_str());
    STRCMP_CONTAINS("d.dxf:4: a NUL byte", refused_text("0\nSECTION\n2\nHE\0DER\n"s).c_str());
}
