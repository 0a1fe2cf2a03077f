// Reads a line word by word, in Grbl's order.
#include "host_tools/controller/dialect/stock_grbl.hpp"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <variant>

#include "firmware/gcode/command.hpp"

namespace cusp::dialect {
namespace {

namespace error {
constexpr int kExpectedLetter = 1;
constexpr int kBadNumber = 2;
constexpr int kNegative = 4;
constexpr int kOverflow = 11;
constexpr int kUnsupportedInGrbl = 20;
constexpr int kTwoOfAGroup = 21;
constexpr int kNotInteger = 23;
constexpr int kAxisConflict = 24;
constexpr int kRepeated = 25;
constexpr int kNoAxisWords = 26;
constexpr int kLineNumber = 27;
constexpr int kMissing = 28;
constexpr int kNoSuchSystem = 29;
constexpr int kNoAxisInPlane = 32;
constexpr int kBadArc = 33;
constexpr int kUnused = 36;
constexpr int kTooLarge = 38;
}  // namespace error

constexpr std::size_t kLongestStored = 79;  // without blanks and comments
constexpr double kMostNumbered = 1e7;
constexpr double kMostTool = 255;
constexpr double kMostSystem = 6;

// The line as Grbl stores it: capitals, without blanks, comments and block deletes.
std::string stored(std::string_view line)
{
    std::string text;
    bool in_comment = false;
    for (char c : line) {
        if (in_comment) {
            in_comment = c != ')';
        } else if (c == '(') {
            in_comment = true;
        } else if (c == ';') {
            break;
        } else if (c > ' ' && c != '/') {
            text += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
        }
    }
    return text;
}

struct Word {
    std::string text;
    char letter;
    double value;
    int whole;
    int hundredths;  // of the value's fraction
};

enum class AxisUse : std::uint8_t { kNone, kNonModal, kMotion, kToolLength };

class GrblLine {
public:
    StockGrblRefusal read(const std::string& text)
    {
        if (text.empty() || text[0] == '$') {
            return {};
        }
        if (text.size() > kLongestStored) {
            return {error::kOverflow, ""};
        }
        for (std::size_t place = 0; place < text.size();) {
            Word word{};
            int code = take(text, place, word);
            if (code == 0) {
                code = word.letter == 'G'   ? command(word, group_of_g(word))
                       : word.letter == 'M' ? command(word, group_of_m(word))
                                            : value(word);
            }
            if (code != 0) {
                return {code, word.text};
            }
        }
        return whole_line();
    }

private:
    static int take(const std::string& text, std::size_t& place, Word& word)
    {
        word.letter = text[place];
        const std::size_t begin = place++;
        if (word.letter < 'A' || word.letter > 'Z') {
            word.text = text.substr(begin, 1);
            return error::kExpectedLetter;
        }
        std::size_t digits = 0;
        bool point = false;
        const std::size_t sign = place < text.size() && (text[place] == '-' || text[place] == '+');
        std::size_t end = place + sign;
        for (; end < text.size(); ++end) {
            const bool digit = text[end] >= '0' && text[end] <= '9';
            if (!digit && (text[end] != '.' || point)) {
                break;
            }
            point = point || text[end] == '.';
            digits += digit ? 1 : 0;
        }
        word.text = text.substr(begin, end - begin);
        if (digits == 0) {
            return error::kBadNumber;
        }
        word.value = std::strtod(text.substr(place, end - place).c_str(), nullptr);
        word.whole = std::abs(word.value) < 1e8 ? static_cast<int>(word.value) : -1;
        constexpr double kHundredths = 100;
        word.hundredths =
            static_cast<int>(std::lround(kHundredths * (word.value - std::trunc(word.value))));
        place = end;
        return 0;
    }

    // A group of commands of which a line may have one, 'x' for none, or an error.
    struct Group {
        char name;
        int error;
    };

    Group with_axes(char name, AxisUse use)
    {
        if (axis_use_ != AxisUse::kNone) {
            return {name, error::kAxisConflict};
        }
        axis_use_ = use;
        return {name, 0};
    }

    // A command that is distinguished from others of its number by its decimals.
    static Group with_part(Group group, Word& word, const std::set<int>& parts)
    {
        if (group.error == 0 && parts.count(word.hundredths) == 0) {
            group.error = error::kUnsupportedInGrbl;
        }
        word.hundredths = 0;
        return group;
    }

    Group group_of_g(Word& word)
    {
        const int part = word.hundredths;
        switch (word.whole) {
            case 10:
                writes_data_ = true;
                return part == 0 ? with_axes('0', AxisUse::kNonModal) : Group{'0', 0};
            case 28:
            case 30:
            case 92:
                return with_part(part == 0 ? with_axes('0', AxisUse::kNonModal) : Group{'0', 0},
                                 word, {0, 10});
            case 0:
            case 1:
            case 2:
            case 3:
                return with_axes('1', AxisUse::kMotion);
            case 38:
                return with_part(with_axes('1', AxisUse::kMotion), word, {20, 30, 40, 50});
            case 43:
                return with_part(with_axes('8', AxisUse::kToolLength), word, {10});
            case 49:
                return with_part(with_axes('8', AxisUse::kToolLength), word, {0});
            case 61:
                return with_part({'D', 0}, word, {0});
            case 90:
                return part == 0 ? Group{'3', 0} : Group{'4', error::kUnsupportedInGrbl};
            case 91:
                return part == 0 ? Group{'3', 0} : with_part({'4', 0}, word, {10});
            default:
                dwells_ = dwells_ || word.whole == 4;
                return {plain_group(word.whole),
                        plain_group(word.whole) == 'x' ? error::kUnsupportedInGrbl : 0};
        }
    }

    // Group of a command without axis words and decimals; 'x': none.
    static char plain_group(int g)
    {
        return g == 4 || g == 53    ? '0'
               : g == 80            ? '1'
               : g >= 17 && g <= 19 ? '2'
               : g == 93 || g == 94 ? '5'
               : g == 20 || g == 21 ? '6'
               : g == 40            ? '7'
               : g >= 54 && g <= 59 ? 'C'
                                    : 'x';
    }

    static Group group_of_m(const Word& word)
    {
        if (word.hundredths != 0) {
            return {'x', error::kNotInteger};
        }
        switch (word.whole) {
            case 0:
            case 1:
            case 2:
            case 30:
                return {'s', 0};
            case 3:
            case 4:
            case 5:
                return {'t', 0};
            case 8:
            case 9:
                return {'u', 0};
            default:
                return {'x', error::kUnsupportedInGrbl};
        }
    }

    int command(const Word& word, Group group)
    {
        if (group.error != 0 || word.value < 0) {
            return group.error != 0 ? group.error : error::kUnsupportedInGrbl;
        }
        if (word.hundredths != 0) {
            return error::kNotInteger;
        }
        return groups_.insert(group.name).second ? 0 : error::kTwoOfAGroup;
    }

    int value(const Word& word)
    {
        if (std::string_view{"FIJKLNPRSTXYZ"}.find(word.letter) == std::string_view::npos) {
            return error::kUnsupportedInGrbl;
        }
        if (word.letter == 'T' && word.value > kMostTool) {
            return error::kTooLarge;
        }
        if (!letters_.insert(word.letter).second) {
            return error::kRepeated;
        }
        if (std::string_view{"FNPTS"}.find(word.letter) != std::string_view::npos &&
            word.value < 0) {
            return error::kNegative;
        }
        (word.letter == 'L'   ? l_
         : word.letter == 'P' ? p_
         : word.letter == 'N' ? n_
                              : other_) = word.value;
        return 0;
    }

    bool has(char letter) const { return letters_.count(letter) != 0; }

    StockGrblRefusal whole_line() const
    {
        if (std::floor(n_) > kMostNumbered) {
            return {error::kLineNumber, ""};
        }
        if (writes_data_) {
            if (!has('X') && !has('Y') && !has('Z')) {
                return {error::kNoAxisWords, ""};
            }
            if (!has('P') || !has('L')) {
                return {error::kMissing, ""};
            }
            if (p_ > kMostSystem) {
                return {error::kNoSuchSystem, ""};
            }
            const int l = static_cast<int>(l_);
            if ((l != 20 && l != 2) || (l == 2 && has('R'))) {
                return {error::kUnsupportedInGrbl, ""};
            }
            return {};
        }
        // P is of dwells alone: arcs have no turns
        return {(has('P') && !dwells_) || has('L') ? error::kUnused : 0, ""};
    }

    std::set<char> groups_;
    std::set<char> letters_;
    AxisUse axis_use_{AxisUse::kNone};
    bool writes_data_{false};  // G10
    bool dwells_{false};
    double l_{};
    double p_{};
    double n_{};
    double other_{};
};

gcode::LetterSet axes_of(path::Plane plane)
{
    using gcode::letter;
    switch (plane) {
        case path::Plane::kZX:
            return letter('Z') | letter('X');
        case path::Plane::kYZ:
            return letter('Y') | letter('Z');
        case path::Plane::kXY:
            break;
    }
    return letter('X') | letter('Y');
}

// Grbl's check of an arc by its centre, in mm whatever the program's unit.
bool radii_agree(const path::Arc& arc)
{
    constexpr double kFree = 0.005;
    constexpr double kMost = 0.5;
    constexpr double kShare = 0.001;
    const double difference = std::fabs(arc.radius_change);
    return difference <= kFree || (difference <= kMost && difference <= kShare * arc.radius);
}

int error_of_arc(std::string_view line, const gcode::Interpreter& before)
{
    gcode::Command command;
    const bool read = static_cast<bool>(gcode::read_command(line, before.modal(), command));
    const bool other =
        command.axis_use != gcode::AxisUse::kNone && command.axis_use != gcode::AxisUse::kMotion;
    if (!read || other || !gcode::is_arc(command.modal.motion)) {
        return 0;
    }
    if (command.axes() == 0) {
        constexpr gcode::LetterSet kCentre =
            gcode::letter('I') | gcode::letter('J') | gcode::letter('K') | gcode::letter('R');
        return command.names(gcode::Group::kMotion) ? error::kNoAxisWords
               : (command.words & kCentre) != 0     ? error::kUnused
                                                    : 0;
    }
    if ((command.axes() & axes_of(command.modal.plane)) == 0) {
        return error::kNoAxisInPlane;
    }
    gcode::Interpreter copy = before;
    gcode::Action action;
    bool agree = true;
    if (copy.execute(line, 0)) {
        while (copy.next(action)) {
            const auto* move = std::get_if<path::Move>(&action);
            const auto* arc = move != nullptr ? std::get_if<path::Arc>(&move->path) : nullptr;
            agree = agree && (arc == nullptr || command.has('R') || radii_agree(*arc));
        }
    }
    return agree ? 0 : error::kBadArc;
}

}  // namespace

StockGrblRefusal stock_grbl_refusal(std::string_view line) { return GrblLine{}.read(stored(line)); }

StockGrblRefusal stock_grbl_refusal(std::string_view line, const gcode::Interpreter& before)
{
    const StockGrblRefusal of_words = stock_grbl_refusal(line);
    return of_words.code != 0 ? of_words : StockGrblRefusal{error_of_arc(line, before), ""};
}

}  // namespace cusp::dialect
