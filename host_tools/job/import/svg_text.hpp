// Numbers, lists and lengths as SVG writes them.
#pragma once

#include <optional>
#include <string_view>

#include "firmware/base/inch.hpp"

namespace cusp::import {

// Reads a text from its start: numbers that blanks, commas or nothing but their signs and points keep apart.
//
//     SvgText text{"10-.5.25,7"};   // 10, -0.5, 0.25, 7
class SvgText {
public:
    explicit SvgText(std::string_view text) : text_{text} {}

    // Skips blanks, and one comma between values.
    void skip();
    bool at_end() const { return at_ == text_.size(); }
    // The next character; 0 at the end.
    char next() const { return at_end() ? '\0' : text_[at_]; }
    char take() { return text_[at_++]; }
    std::optional<double> number();
    // "0" or "1", which nothing keeps apart from what follows.
    std::optional<bool> flag();
    // A name of letters, such as "translate"; may be empty.
    std::string_view word();
    std::size_t position() const { return at_; }
    // The next characters, for messages.
    std::string_view rest() const { return text_.substr(at_, 20); }

private:
    std::string_view text_;
    std::size_t at_{};
};

// Pixels of CSS in a millimetre.
inline constexpr double kPixelsPerMillimetre = 96 / kMillimetresPerInch;

struct SvgLength {
    double pixels;  // per cent where `relative`
    bool relative{};
    bool absolute{};  // in millimetres, inches or the like, not in pixels
};

// "12", "12px", "3.5mm", "1in", "50%". None: another unit, or no number.
std::optional<SvgLength> svg_length(std::string_view text);

}  // namespace cusp::import
