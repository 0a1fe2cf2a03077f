// Line by line: a header with units and tools, then places by tools.
#include "host_tools/job/import/excellon_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "firmware/base/inch.hpp"
#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/number_text/number_text.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"
#include "host_tools/job/import/digit_format.hpp"
#include "host_tools/job/import/gerber_arc.hpp"
#include "host_tools/job/import/gerber_drawing.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

constexpr double kFarthestHole = 1e5;  // mm
constexpr double kWidestHole = 1000;   // mm
constexpr std::size_t kMostPlaces = 1000000;

bool begins_with(std::string_view text, std::string_view begin)
{
    return text.substr(0, begin.size()) == begin;
}

// The words of one line: a letter and its number each.
struct ExcellonWords {
    std::map<char, std::string> of;  // of X, Y, I, J, A: the last one
    std::vector<int> g;
    std::optional<int> m;
    std::optional<int> t;
    std::optional<std::pair<std::string, std::string>> to;  // behind G85
};

class ExcellonReader {
public:
    explicit ExcellonReader(const std::string& file) : file_{file}
    {
        const std::string text = files::text_of_file(file);
        std::string_view rest{text};
        while (!rest.empty() && !ended_) {
            ++line_;
            const std::size_t end = std::min(rest.find('\n'), rest.size());
            std::string_view now = rest.substr(0, end);
            rest.remove_prefix(std::min(end + 1, rest.size()));
            while (!now.empty() && (now.back() == '\r' || now.back() == ' ')) {
                now.remove_suffix(1);
            }
            read_line(now);
        }
        if (!begun_) {
            throw InputError(fmt::format("{}: no Excellon file: it has no header (M48)", file));
        }
        end_route();
    }

    DrawnLayers layers();

private:
    [[noreturn]] void refuse(const std::string& what) const
    {
        throw InputError(fmt::format("{} line {}: {}", file_, line_, what), {file_, line_});
    }
    void read_line(std::string_view text);
    void read_header(std::string_view text);
    void set_unit(std::string_view text);
    void define_tool(std::string_view text);
    ExcellonWords words_of(std::string_view text) const;
    void read_words(const ExcellonWords& words);
    void obey(int m);
    bool is_slot(const ExcellonWords& words);
    void add_place(const ExcellonWords& words, bool slot);
    double coordinate(const std::string& digits) const;
    Vec2d place_of(const ExcellonWords& words, Vec2d otherwise) const;
    double radius() const;
    void route(const ExcellonWords& words, int motion, Vec2d to);
    void end_route();

    const std::string& file_;
    std::uint64_t line_{};
    bool begun_{};
    bool in_header_{};
    bool ended_{};
    double unit_{1};
    bool has_zeros_{};  // LZ or TZ
    bool without_point_{};
    DigitFormat format_{3, 3, false};
    bool has_format_{};
    std::map<int, double> tools_;  // mm
    int tool_{-1};
    Vec2d point_;
    bool routing_{};
    bool down_{};
    int motion_{};
    offset::Region2d way_;
    std::vector<DrawingPath> holes_;
    std::vector<DrawingPath> slots_;
};

void ExcellonReader::read_line(std::string_view text)
{
    if (text.empty()) {
        return;
    }
    if (text.front() == ';') {
        const std::string_view mark = ";FILE_FORMAT=";
        if (begins_with(text, mark) && text.size() == mark.size() + 3 &&
            text[mark.size() + 1] == ':') {
            format_.whole = text[mark.size()] - '0';
            format_.decimals = text[mark.size() + 2] - '0';
            has_format_ = format_.whole >= 0 && format_.whole <= 9 && format_.decimals >= 1 &&
                          format_.decimals <= 9;
        }
        return;
    }
    if (text == "M48") {
        begun_ = true;
        in_header_ = true;
    } else if (text == "%" || text == "M95") {
        in_header_ = false;
    } else if (!begun_) {
        throw InputError(
            fmt::format("{} line {}: no Excellon file: \"{}\" stands before the header (M48)",
                        file_, line_, std::string{text.substr(0, 40)}),
            {file_, line_});
    } else if (in_header_) {
        read_header(text);
    } else if (begins_with(text, "METRIC") || begins_with(text, "INCH")) {
        set_unit(text);
    } else if (text.front() == 'T' && text.find('C') != std::string_view::npos) {
        define_tool(text);
    } else {
        read_words(words_of(text));
    }
}

void ExcellonReader::read_header(std::string_view text)
{
    if (begins_with(text, "METRIC") || begins_with(text, "INCH") || text == "M71" ||
        text == "M72") {
        set_unit(text);
    } else if (text.front() == 'T' && text.size() > 1 && text[1] >= '0' && text[1] <= '9') {
        define_tool(text);
    } else if (begins_with(text, "ICI") && text.find("ON") != std::string_view::npos) {
        refuse("incremental coordinates (ICI) are not read: write absolute ones");
    } else if (text == "FMAT,1") {
        refuse("format 1 (FMAT,1) is not read: write format 2");
    }
}

void ExcellonReader::set_unit(std::string_view text)
{
    const bool inch = begins_with(text, "INCH") || text == "M72";
    unit_ = inch ? kMillimetresPerInch : 1.0;
    if (!has_format_) {
        format_.whole = inch ? 2 : 3;
        format_.decimals = inch ? 4 : 3;
    }
    if (text.find(",LZ") != std::string_view::npos || text.find(",TZ") != std::string_view::npos) {
        has_zeros_ = true;
        format_.trailing_omitted = text.find(",LZ") != std::string_view::npos;
    }
    if (const std::size_t zeros = text.find(",0"); zeros != std::string_view::npos) {
        const std::string_view digits = text.substr(zeros + 1);
        const std::size_t point = digits.find('.');
        if (point != std::string_view::npos && digits.size() <= 12 && point >= 1 &&
            digits.size() - point > 1) {
            format_.whole = static_cast<int>(point);
            format_.decimals = static_cast<int>(digits.size() - point - 1);
        }
    }
}

void ExcellonReader::define_tool(std::string_view text)
{
    const auto number = number_text::leading_number(text.substr(1));
    const std::size_t c = text.find('C');
    if (!number || !(number->value >= 0 && number->value <= 9999)) {
        refuse(fmt::format("\"{}\" is no tool", std::string{text.substr(0, 40)}));
    }
    if (c == std::string_view::npos) {
        return;
    }
    const auto diameter = number_text::leading_number(text.substr(c + 1));
    if (!diameter || !(diameter->value > 0 && diameter->value * unit_ <= kWidestHole)) {
        refuse(fmt::format("tool T{:g}: its diameter is above 0 and at most {:g} mm", number->value,
                           kWidestHole));
    }
    tools_[static_cast<int>(number->value)] = diameter->value * unit_;
}

ExcellonWords ExcellonReader::words_of(std::string_view text) const
{
    ExcellonWords words;
    bool behind_slot = false;
    const std::string_view whole = text;
    while (!text.empty()) {
        const char letter = text.front();
        text.remove_prefix(1);
        const std::size_t size = std::min(text.find_first_not_of("+-0123456789."), text.size());
        std::string digits{text.substr(0, size)};
        text.remove_prefix(size);
        const auto number = number_text::number_of(digits);
        const bool small = number && *number >= 0 && *number <= 99999;
        if (letter == 'G' && small) {
            behind_slot = behind_slot || *number == 85;
            words.g.push_back(static_cast<int>(*number));
        } else if (letter == 'M' && small) {
            words.m = static_cast<int>(*number);
        } else if (letter == 'T' && small) {
            words.t = static_cast<int>(*number);
        } else if (number && behind_slot && (letter == 'X' || letter == 'Y')) {
            words.to = words.to.value_or(std::pair<std::string, std::string>{});
            (letter == 'X' ? words.to->first : words.to->second) = std::move(digits);
        } else if (number && std::string_view{"XYIJA"}.find(letter) != std::string_view::npos) {
            words.of[letter] = std::move(digits);
        } else if (!(small && (letter == 'F' || letter == 'S' || letter == 'N' || letter == 'Z'))) {
            refuse(fmt::format("\"{}\" is not read", std::string{whole.substr(0, 40)}));
        }
    }
    return words;
}

double ExcellonReader::coordinate(const std::string& digits) const
{
    const auto value = format_.value_of(digits);
    if (!value || !(std::fabs(*value * unit_) <= kFarthestHole)) {
        refuse(fmt::format("\"{}\" is no coordinate, or beyond {:g} mm", digits.substr(0, 40),
                           kFarthestHole));
    }
    return *value * unit_;
}

Vec2d ExcellonReader::place_of(const ExcellonWords& words, Vec2d otherwise) const
{
    for (const auto& [letter, axis] : {std::pair{'X', &Vec2d::x}, {'Y', &Vec2d::y}}) {
        if (const auto found = words.of.find(letter); found != words.of.end()) {
            otherwise.*axis = coordinate(found->second);
        }
    }
    return otherwise;
}

double ExcellonReader::radius() const
{
    const auto found = tools_.find(tool_);
    if (found == tools_.end()) {
        refuse(tool_ < 0 ? std::string{"a hole before a tool is chosen"}
                         : fmt::format("tool T{} has no diameter in the header", tool_));
    }
    return found->second / 2;
}

void ExcellonReader::obey(int m)
{
    if (m == 30 || m == 0) {
        ended_ = true;
    } else if (m == 15) {
        down_ = true;
    } else if (m == 16 || m == 17) {
        end_route();
        down_ = false;
    } else if (m == 71 || m == 72) {
        set_unit(m == 72 ? "M72" : "M71");
    } else {
        refuse(fmt::format("M{:02d} is not read", m));
    }
}

// Obeys the G words.
bool ExcellonReader::is_slot(const ExcellonWords& words)
{
    bool slot = false;
    for (const int g : words.g) {
        if (g <= 3) {
            routing_ = true;
            motion_ = g;
        } else if (g == 5 || g == 81) {
            end_route();
            routing_ = false;
        } else if (g == 85) {
            slot = true;
        } else if (g == 91) {
            refuse("incremental coordinates (G91) are not read: write absolute ones");
        } else if (g != 90 && g != 40 && g != 41 && g != 42) {
            refuse(fmt::format("G{:02d} is not read", g));
        }
    }
    return slot;
}

void ExcellonReader::read_words(const ExcellonWords& words)
{
    if (words.t) {
        end_route();
        tool_ = *words.t == 0 ? tool_ : *words.t;
    }
    const bool slot = is_slot(words);
    if (words.m) {
        obey(*words.m);
    }
    if (!words.of.empty() || slot) {
        add_place(words, slot);
    }
}

void ExcellonReader::add_place(const ExcellonWords& words, bool slot)
{
    const Vec2d to = place_of(words, point_);
    for (const auto& [letter, digits] : words.of) {
        without_point_ = without_point_ || digits.find('.') == std::string::npos;
    }
    if (holes_.size() + slots_.size() + way_.contours.size() >= kMostPlaces) {
        refuse(fmt::format("more than {} holes", kMostPlaces));
    }
    if (slot) {
        const Vec2d end{
            words.to && !words.to->first.empty() ? coordinate(words.to->first) : to.x,
            words.to && !words.to->second.empty() ? coordinate(words.to->second) : to.y};
        slots_.push_back(path_along(capsule_contour(to, end, radius())));
        point_ = end;
        return;
    }
    if (routing_) {
        route(words, motion_, to);
    } else {
        holes_.push_back(path_along(circle_contour(to, radius())));
    }
    point_ = to;
}

void ExcellonReader::route(const ExcellonWords& words, int motion, Vec2d to)
{
    if (!down_ || motion == 0) {
        return;
    }
    if (motion == 1) {
        way_.contours.push_back(capsule_contour(point_, to, radius()));
        return;
    }
    const auto word = [&](char letter) {
        const auto found = words.of.find(letter);
        return found == words.of.end() ? 0.0 : coordinate(found->second);
    };
    GerberArc arc{point_, to, {word('I'), word('J')}, motion == 3};
    if (words.of.count('A') > 0) {  // its radius: at most half a turn
        const Vec2d half = 0.5 * (to - point_);
        const double rise = std::sqrt(std::max(0.0, word('A') * word('A') - dot(half, half)));
        arc.centre =
            half + offset::left_normal(offset::unit(to - point_)) * (motion == 3 ? rise : -rise);
    }
    const CircularWay way = way_of(arc);
    if (!(way.radius > offset::kSamePoint)) {
        refuse("the arc has no radius: A, or I and J");
    }
    for (offset::Contour& contour : thick_arc(way, radius()).contours) {
        way_.contours.push_back(std::move(contour));
    }
}

void ExcellonReader::end_route()
{
    for (const offset::Contour& contour : offset::united(way_, {}).contours) {
        slots_.push_back(path_along(contour));
    }
    way_ = {};
}

DrawnLayers ExcellonReader::layers()
{
    DrawnLayers drawn{
        unit_, unit_ == 1.0 ? "millimetres" : "inches", format_.last_place() * unit_, {}, {}};
    if (without_point_ && !has_zeros_) {
        drawn.notes.push_back(fmt::format(
            "{}: the header has neither LZ nor TZ: coordinates are read as {}.{} digits, leading "
            "zeros left out",
            file_, format_.whole, format_.decimals));
    }
    if (!holes_.empty()) {
        drawn.layers.push_back({"holes", false, std::move(holes_), {}});
    }
    if (!slots_.empty()) {
        drawn.layers.push_back({"slot_holes", false, std::move(slots_), {}});
    }
    if (drawn.layers.empty()) {
        throw InputError(fmt::format("{}: nothing is drilled", file_));
    }
    return drawn;
}

}  // namespace

DrawnLayers read_excellon_layers(const std::string& file) { return ExcellonReader{file}.layers(); }

}  // namespace cusp::import
