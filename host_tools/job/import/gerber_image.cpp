// A machine of few registers: the point, the way of interpolation, the last operation.
#include "host_tools/job/import/gerber_image.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "firmware/base/inch.hpp"
#include "firmware/base/math.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/number_text/number_text.hpp"
#include "host_tools/job/import/digit_format.hpp"
#include "host_tools/job/import/gerber_arc.hpp"
#include "host_tools/job/import/gerber_text.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

constexpr double kFarthest = 1e5;  // mm
constexpr double kMostCopies = 10000;
constexpr double kLargestCode = 2147483647;

std::string shown(std::string_view text) { return std::string{text.substr(0, 40)}; }

class GerberReader {
public:
    explicit GerberReader(const std::string& file) : file_{file} {}

    GerberImage image(const std::string& text)
    {
        for (const GerberCommand& command : gerber_commands(file_, text)) {
            place_ = fmt::format("{} line {}", file_, command.line);
            if (ended_) {
                break;
            }
            if (command.extended) {
                extended(command);
            } else {
                word(command.words.front());
            }
        }
        if (!format_) {
            throw InputError(
                fmt::format("{}: no Gerber file: it has no %FS, the format of its numbers", file_));
        }
        plotter_.end_file();
        return {std::move(plotter_.objects()), std::move(plotter_.lines()), function_, unit_,
                format_->last_place() * unit_};
    }

private:
    [[noreturn]] void refuse(const std::string& what) const
    {
        throw InputError(place_ + ": " + what);
    }

    void extended(const GerberCommand& command);
    void refuse_deprecated(std::string_view text) const;
    void set_unit(std::string_view text);
    int aperture_code(std::string_view text) const;
    void set_state(std::string_view text);
    void set_repeat(std::string_view text);
    double number_after(std::string_view text, char mark, double otherwise) const;
    void word(std::string_view text);
    void prepare(int code);
    void set_coordinate(char axis, std::string_view digits);
    void operate(int code);
    std::optional<CircularWay> way_to(Vec2d to) const;

    const std::string& file_;
    std::string place_;
    GerberPlotter plotter_{place_};
    ApertureMacros macros_;
    std::string function_;
    double unit_{1};
    std::optional<DigitFormat> format_;
    Vec2d point_;
    Vec2d to_;
    Vec2d centre_;  // I and J
    int motion_{1};
    bool quarters_{};  // G74
    int operation_{};  // of words that have none of their own
    bool ended_{};
};

void GerberReader::extended(const GerberCommand& command)
{
    const std::string_view text{command.words.front()};
    const std::string_view code = text.substr(0, 2);
    const std::string_view rest = text.substr(code.size());
    if (code == "FS") {
        format_ = DigitFormat::of_gerber(rest);
        if (!format_) {
            refuse(fmt::format("%{}*%: a format such as %FSLAX46Y46*% is needed, absolute",
                               shown(text)));
        }
    } else if (code == "MO") {
        set_unit(rest);
    } else if (code == "AM") {
        macros_[std::string{rest}] = {command.words.begin() + 1, command.words.end()};
    } else if (code == "AD") {
        const std::size_t digits = std::min(rest.find_first_not_of("0123456789", 1), rest.size());
        plotter_.define(aperture_code(rest),
                        aperture_of(rest.substr(digits), unit_, macros_, place_));
    } else if (code == "AB") {
        if (rest.empty()) {
            plotter_.end_block();
        } else {
            plotter_.begin_block(aperture_code(rest));
        }
    } else if (code == "LP" || code == "LM" || code == "LR" || code == "LS") {
        set_state(text);
    } else if (code == "SR") {
        set_repeat(rest);
    } else if (code == "TF") {
        const std::string_view function = ".FileFunction,";
        if (rest.substr(0, function.size()) == function) {
            const std::string_view name = rest.substr(function.size());
            function_ = std::string{name.substr(0, name.find(','))};
        }
    } else if (code != "TA" && code != "TO" && code != "TD" && code != "IN" && code != "LN") {
        refuse_deprecated(text);
    }
}

// Commands that were taken out of the format are let pass if they change nothing.
void GerberReader::refuse_deprecated(std::string_view text) const
{
    const std::string_view code = text.substr(0, 2);
    const bool neutral = text == "IPPOS" || text == "ASAXBY" || text == "IR0" ||
                         ((code == "MI" || code == "OF") &&
                          text.find_first_of("123456789") == std::string_view::npos) ||
                         text == "SFA1.0B1.0" || text == "SFA1B1";
    if (!neutral) {
        refuse(fmt::format("%{}*% is not read: deprecated, or no command of Gerber", shown(text)));
    }
}

void GerberReader::set_unit(std::string_view text)
{
    if (text != "MM" && text != "IN") {
        refuse(fmt::format("%MO{}*%: the unit is MM or IN", shown(text)));
    }
    unit_ = text == "IN" ? kMillimetresPerInch : 1.0;
}

int GerberReader::aperture_code(std::string_view text) const
{
    const auto code = number_text::leading_number(text.substr(text.empty() ? 0 : 1));
    if (text.empty() || text.front() != 'D' || !code ||
        !(code->value >= 10 && code->value <= kLargestCode)) {
        refuse(fmt::format("\"{}\": an aperture is D and a number from 10", shown(text)));
    }
    return static_cast<int>(code->value);
}

void GerberReader::set_state(std::string_view text)
{
    const std::string_view value = text.substr(2);
    PlotState& state = plotter_.state();
    const auto number = number_text::number_of(value);
    if (text == "LPD" || text == "LPC") {
        state.dark = text == "LPD";
    } else if (text[1] == 'M' && (value == "N" || value == "X" || value == "Y" || value == "XY")) {
        state.mirror_x = value.find('X') != std::string_view::npos;
        state.mirror_y = value.find('Y') != std::string_view::npos;
    } else if (text[1] == 'R' && number) {
        state.turn = *number * kPi / 180;
    } else if (text[1] == 'S' && number && *number > 0 && *number < 1e6) {
        state.scale = *number;
    } else {
        refuse(fmt::format("%{}*% is no polarity, mirroring, turn or scale", shown(text)));
    }
}

double GerberReader::number_after(std::string_view text, char mark, double otherwise) const
{
    const std::size_t at = text.find(mark);
    if (at == std::string_view::npos) {
        return otherwise;
    }
    const auto number = number_text::leading_number(text.substr(at + 1));
    if (!number) {
        refuse(fmt::format("%SR{}*%: {} has no number", shown(text), mark));
    }
    return number->value;
}

void GerberReader::set_repeat(std::string_view text)
{
    if (text.empty()) {
        plotter_.end_repeat();
        return;
    }
    const double across = number_after(text, 'X', 1);
    const double up = number_after(text, 'Y', 1);
    if (!(across >= 1 && up >= 1 && across * up <= kMostCopies)) {
        refuse(fmt::format("%SR{}*%: 1 to {:g} copies", shown(text), kMostCopies));
    }
    plotter_.begin_repeat(static_cast<int>(across), static_cast<int>(up),
                          Vec2d{number_after(text, 'I', 0), number_after(text, 'J', 0)} * unit_);
}

void GerberReader::word(std::string_view text)
{
    if (text.substr(0, 3) == "G04" || text.substr(0, 3) == "G4 ") {
        return;
    }
    int code = 0;  // of a D
    bool moves = false;
    centre_ = {};
    while (!text.empty()) {
        const char letter = text.front();
        text.remove_prefix(1);
        if (letter == ' ' || letter == '\t') {
            continue;
        }
        const std::size_t size = std::min(text.find_first_not_of("+-0123456789."), text.size());
        const std::string_view digits = text.substr(0, size);
        text.remove_prefix(size);
        if (letter == 'X' || letter == 'Y' || letter == 'I' || letter == 'J') {
            set_coordinate(letter, digits);
            moves = true;
            continue;
        }
        const auto number = number_text::number_of(digits);
        const int value =
            number && *number >= 0 && *number <= kLargestCode ? static_cast<int>(*number) : -1;
        if (letter == 'G' && value >= 0) {
            prepare(value);
        } else if (letter == 'D' && value >= 0) {
            code = value;
        } else if (letter == 'M' && value >= 0) {
            ended_ = value == 0 || value == 2 || value == 30;
        } else if (letter != 'N' || value < 0) {
            refuse(fmt::format("\"{}{}\" is no word of Gerber", letter, shown(digits)));
        }
    }
    if (code >= 10) {
        plotter_.select(code);
    } else if (code > 0 || moves) {
        operation_ = code > 0 ? code : operation_;
        operate(operation_);
    }
}

void GerberReader::prepare(int code)
{
    switch (code) {
        case 1:
        case 2:
        case 3:
            motion_ = code;
            return;
        case 36:
            plotter_.begin_region();
            return;
        case 37:
            plotter_.end_region();
            return;
        case 70:
            set_unit("IN");
            return;
        case 71:
            set_unit("MM");
            return;
        case 74:
        case 75:
            quarters_ = code == 74;
            return;
        case 54:
        case 55:
        case 90:
            return;
        default:
            refuse(fmt::format("G{:02d} is not read", code));
    }
}

void GerberReader::set_coordinate(char axis, std::string_view digits)
{
    if (!format_) {
        refuse("no Gerber file: a coordinate stands before %FS, the format of its numbers");
    }
    const auto number = format_->value_of(digits);
    if (!number) {
        refuse(fmt::format("\"{}{}\" is no coordinate", axis, shown(digits)));
    }
    const double value = *number * unit_;
    if (!(std::fabs(value) <= kFarthest)) {
        refuse(fmt::format("{} is {:g} mm: at most {:g}", axis, value, kFarthest));
    }
    double& where = axis == 'X' ? to_.x : axis == 'Y' ? to_.y : axis == 'I' ? centre_.x : centre_.y;
    where = value;
}

void GerberReader::operate(int code)
{
    const bool in_region = plotter_.in_region();
    if (code == 1) {
        const std::optional<CircularWay> way = way_to(to_);
        if (in_region) {
            plotter_.add_edge(point_, to_, way);
        } else {
            plotter_.stroke(point_, to_, way);
        }
    } else if (code == 2) {
        plotter_.end_contour();
    } else if (code == 3 && !in_region) {
        plotter_.flash(to_);
    } else {
        refuse(code == 0   ? std::string{"coordinates without D01, D02 or D03"}
               : code == 3 ? std::string{"a flash within a region"}
                           : fmt::format("D{:02d} is no operation", code));
    }
    point_ = to_;
}

// Nothing for a line.
std::optional<CircularWay> GerberReader::way_to(Vec2d to) const
{
    if (motion_ == 1) {
        return std::nullopt;
    }
    const GerberArc arc{point_, to, centre_, motion_ == 3};
    if (quarters_) {
        return quarter_way(arc);
    }
    const CircularWay way = way_of(arc);
    if (!(way.radius > offset::kSamePoint)) {
        refuse("the arc has no radius: I and J are its centre, from its start");
    }
    return way;
}

}  // namespace

GerberImage gerber_image(const std::string& file, const std::string& text)
{
    return GerberReader{file}.image(text);
}

}  // namespace cusp::import
