// Letters of a font file, by HarfBuzz: which glyphs a text needs, where each goes, and their outlines.
#pragma once

#include <memory>
#include <string>

#include "host_tools/job/import/font_line.hpp"

namespace cusp::import {

// Kerning, ligatures and marks are those of the font. A text that runs from right to left is set so.
//
// Errors: InputError: the file can't be read, or is no font with outlines; a build of cusp without HarfBuzz.
class OutlineFont {
public:
    explicit OutlineFont(const std::string& file);
    ~OutlineFont();
    OutlineFont(const OutlineFont&) = delete;
    OutlineFont& operator=(const OutlineFont&) = delete;

    FontSize size() const;
    // Errors: InputError with the character that the font does not have.
    FontLine line(const std::string& text, const std::string& place) const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace cusp::import
