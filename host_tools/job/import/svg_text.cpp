// Numbers end where no further character can belong to them, as the grammar of SVG has it.
#include "host_tools/job/import/svg_text.hpp"

#include <cmath>
#include <cstring>

#include "host_tools/base/number_text/number_text.hpp"

namespace cusp::import {
namespace {

bool is_blank(char c) { return c != '\0' && std::strchr(" \t\r\n\f", c) != nullptr; }

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

}  // namespace

void SvgText::skip()
{
    bool comma = false;
    while (!at_end() && (is_blank(next()) || (next() == ',' && !comma))) {
        comma = comma || next() == ',';
        ++at_;
    }
}

std::optional<double> SvgText::number()
{
    skip();
    std::string_view left = text_.substr(at_);
    const std::size_t sign = !left.empty() && left.front() == '+' ? 1 : 0;
    left.remove_prefix(sign);
    const bool digits = left.find_first_of("0123456789") <= left.find_first_not_of("-.");
    const auto found = digits ? number_text::leading_number(left) : std::nullopt;
    if (!found || (sign == 1 && left.front() == '-') || !std::isfinite(found->value)) {
        return std::nullopt;
    }
    at_ += sign + found->size;
    return found->value;
}

std::optional<bool> SvgText::flag()
{
    skip();
    if (next() != '0' && next() != '1') {
        return std::nullopt;
    }
    return take() == '1';
}

std::string_view SvgText::word()
{
    const std::size_t begin = at_;
    while (!at_end() && is_letter(next())) {
        ++at_;
    }
    return text_.substr(begin, at_ - begin);
}

std::optional<SvgLength> svg_length(std::string_view text)
{
    struct Unit {
        std::string_view name;
        double pixels;
        bool absolute;
    };
    static constexpr double kInch = kMillimetresPerInch * kPixelsPerMillimetre;
    static constexpr Unit kUnits[] = {{"", 1, false},
                                      {"px", 1, false},
                                      {"mm", kPixelsPerMillimetre, true},
                                      {"cm", 10 * kPixelsPerMillimetre, true},
                                      {"Q", kPixelsPerMillimetre / 4, true},
                                      {"in", kInch, true},
                                      {"pt", kInch / 72, true},
                                      {"pc", kInch / 6, true}};
    SvgText reader{text};
    const auto value = reader.number();
    if (!value) {
        return std::nullopt;
    }
    const bool relative = reader.next() == '%';
    if (relative) {
        reader.take();
    }
    const std::string_view name = reader.word();
    reader.skip();
    if (!reader.at_end() || (relative && !name.empty())) {
        return std::nullopt;
    }
    for (const Unit& unit : kUnits) {
        if (unit.name == name) {
            return SvgLength{*value * unit.pixels, relative, unit.absolute};
        }
    }
    return std::nullopt;
}

}  // namespace cusp::import
