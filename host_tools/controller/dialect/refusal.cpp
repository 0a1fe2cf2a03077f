// Finds the refused word by interpreting prefixes of the line with the controller's interpreter.
#include "host_tools/controller/dialect/refusal.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <vector>

#include "firmware/gcode/command.hpp"
#include "firmware/gcode/interpreter.hpp"
#include "host_tools/controller/dialect/answer.hpp"
#include "host_tools/controller/dialect/program_lines.hpp"

namespace cusp::dialect {
namespace {

using gcode::Command;
using gcode::Interpreter;
using gcode::ModalState;

constexpr int kUnsupported = 20;
constexpr int kInvalidTarget = 33;
constexpr int kUnusedWords = 36;

// Offsets of the words of a line, and its end. A word starts with a letter outside comments;
// characters that belong to no word count as words.
std::vector<std::size_t> word_places(std::string_view line)
{
    std::vector<std::size_t> places;
    bool in_number = false;
    std::size_t place = line.size() - without_byte_order_mark(line).size();
    for (; place < line.size() && line[place] != ';'; ++place) {
        const char c = line[place];
        if (c == '(') {
            place = std::min(line.find(')', place), line.size() - 1);
            continue;
        }
        const bool number = (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+';
        const bool blank = c == ' ' || c == '\t' || c == '\r' || c == '/';
        if (!blank && !(number && in_number)) {
            places.push_back(place);
            in_number = true;
        }
    }
    places.push_back(place);
    return places;
}

// The text for a message: shortened, without control characters.
std::string shown(std::string_view text)
{
    constexpr std::size_t kMostShown = 100;
    std::string result{text.substr(0, kMostShown)};
    const auto is_control = [](char c) {
        return static_cast<unsigned char>(c) < ' ' || c == '\x7f';
    };
    std::replace_if(result.begin(), result.end(), is_control, '?');
    return text.size() > kMostShown ? result + "..." : result;
}

std::string_view trimmed(std::string_view text)
{
    const std::size_t end = text.find_last_not_of(" \t\r/");
    return text.substr(0, end == std::string_view::npos ? 0 : end + 1);
}

// A word's text without the comments that follow it.
std::string_view without_comments(std::string_view word)
{
    word = trimmed(word);
    while (!word.empty() && word.back() == ')' && word.find('(') != std::string_view::npos) {
        word = trimmed(word.substr(0, word.rfind('(')));
    }
    return word;
}

char capital(char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); }

// Bytes [begin, end) of a line.
struct WordPlace {
    std::size_t begin;
    std::size_t end;
};

WordPlace word_at(std::string_view line, const std::vector<std::size_t>& places, std::size_t word)
{
    const std::size_t begin = places[word];
    const std::string_view text = line.substr(begin, places[word + 1] - begin);
    return {begin, begin + without_comments(text).size()};
}

// The error of a line in a controller that has a feed; 0: none.
int error_of(std::string_view line)
{
    Interpreter interpreter;
    static_cast<void>(interpreter.execute("G1 F100", 0));
    interpreter.discard();
    const Status status = interpreter.execute(line, 0);
    return status ? 0 : static_cast<int>(status.error());
}

// True if a word with this letter can itself be unused: G10 accepts L1, 2, 10, 11 and 20, and no R.
bool may_be_unused(int code, char letter)
{
    return code == kUnsupported ? letter == 'L' || letter == 'R' : letter != 'G' && letter != 'M';
}

// The word without which the line is right, or else the error is another one; empty where there is none.
WordPlace word_to_blame(int code, std::string_view line, const std::vector<std::size_t>& places)
{
    if (error_of(line) != code) {
        return {};
    }
    WordPlace found{};
    for (std::size_t word = places.size() - 1; word-- > 0;) {
        std::string without{line.substr(0, places[word])};
        without += line.substr(places[word + 1]);
        if (!may_be_unused(code, capital(line[places[word]]))) {
            continue;
        }
        const int left = error_of(without);
        // Without the R of G10 L2 words may be missing, but not because of it.
        const bool turns = code == kUnsupported && capital(line[places[word]]) == 'R';
        if (left != code) {
            found = word_at(line, places, word);
        }
        if (left == 0 || (left != code && turns)) {
            return found;
        }
    }
    return found;
}

// The word of a rotary axis that moves it, as far as the line alone says: the first that is not 0.
WordPlace rotary_word(std::string_view line, const std::vector<std::size_t>& places)
{
    WordPlace found{};
    for (std::size_t word = 0; word + 1 < places.size(); ++word) {
        const char letter = capital(line[places[word]]);
        if (letter != 'A' && letter != 'B' && letter != 'C') {
            continue;
        }
        const WordPlace place = word_at(line, places, word);
        const std::string_view number = line.substr(place.begin + 1, place.end - place.begin - 1);
        if (number.find_first_of("123456789") != std::string_view::npos) {
            return place;
        }
        if (found.end == 0) {
            found = place;
        }
    }
    return found;
}

// A word up to the end of the parameter or expression that is its number, as in X#1 or X[#1 + 2].
WordPlace with_expression(std::string_view line, WordPlace place)
{
    std::size_t end = line.find_first_not_of(" \t", place.end);
    if (end == std::string_view::npos || (line[end] != '#' && line[end] != '[')) {
        return place;
    }
    int depth = 0;
    for (; end < line.size(); ++end) {
        const char c = line[end];
        const bool letter = std::isalpha(static_cast<unsigned char>(c)) != 0;
        if (depth == 0 && (letter || c == ';' || c == '(')) {
            break;
        }
        depth += c == '[' || c == '<' ? 1 : c == ']' || c == '>' ? -1 : 0;
    }
    return {place.begin, place.begin + trimmed(line.substr(place.begin, end - place.begin)).size()};
}

struct Meaning {
    std::string_view word;  // a letter, or a letter and its number
    std::string_view text;
};

// Words of other dialects that occur in programs. A word precedes its letter alone.
constexpr std::array kMeanings{
    Meaning{"G5", "cubic splines: NURBS are G5.2 and G6.2"},
    Meaning{"G5.1", "quadratic splines: NURBS are G5.2 and G6.2"},
    Meaning{"G7", "diameters are a lathe's"},
    Meaning{"G8", "radii are a lathe's"},
    Meaning{"G12", "circular pockets are Fanuc's and Mach3's"},
    Meaning{"G13", "circular pockets are Fanuc's and Mach3's"},
    Meaning{"G29", "levelling is a 3-D printer's"},
    Meaning{"G33", "threading needs a spindle with an encoder"},
    Meaning{"G41", "cutter compensation: let the CAM system offset the path"},
    Meaning{"G42", "cutter compensation: let the CAM system offset the path"},
    Meaning{"G50", "scaling is not supported"},
    Meaning{"G51", "scaling is not supported"},
    Meaning{"G65", "macros are Fanuc's: let the CAM system write the moves"},
    Meaning{"G66", "macros are Fanuc's: let the CAM system write the moves"},
    Meaning{"G68", "rotation: let the CAM system turn the path"},
    Meaning{"G69", "rotation: let the CAM system turn the path"},
    Meaning{"G70", "inches are G20 here"},
    Meaning{"G71", "millimetres are G21 here"},
    Meaning{"G74", "tapping needs a spindle with an encoder"},
    Meaning{"G76", "threading needs a spindle with an encoder"},
    Meaning{"G84", "tapping needs a spindle with an encoder"},
    Meaning{"G87", "back boring: the boring cycles are G85, G86 and G89"},
    Meaning{"G88", "boring by hand: the boring cycles are G85, G86 and G89"},
    Meaning{"G92.3", "an offset that G92.2 has removed is not stored; write G92 again"},
    Meaning{"G95", "feed per revolution needs a spindle with an encoder; G94 is feed per minute"},
    Meaning{"G96", "constant surface speed is a lathe's; G97 is revolutions per minute"},
    Meaning{"M19", "orienting needs a spindle with an encoder"},
    Meaning{"M48", "overrides are always on"},
    Meaning{"M49", "overrides are always on"},
    Meaning{"M60", "there is no pallet to change; M0 stops"},
    Meaning{"M97", "subprograms: let the CAM system write the moves out"},
    Meaning{"M98", "subprograms: let the CAM system write the moves out"},
    Meaning{"M99", "subprograms: let the CAM system write the moves out"},
    Meaning{"M104", "heating is a 3-D printer's"},
    Meaning{"M106", "fans are a 3-D printer's; M8 is coolant"},
    Meaning{"M107", "fans are a 3-D printer's; M9 ends coolant"},
    Meaning{"M109", "heating is a 3-D printer's"},
    Meaning{"A", "there is no rotary axis: only words that turn none are ignored"},
    Meaning{"B", "there is no rotary axis: only words that turn none are ignored"},
    Meaning{"C", "there is no rotary axis: only words that turn none are ignored"},
    Meaning{"D", "cutter compensation: let the CAM system offset the path"},
    Meaning{"E", "E drives the extruder of a 3-D printer"},
    Meaning{"O",
            "O-words are LinuxCNC's subprograms and loops: let the CAM system write the moves out"},
    Meaning{"R", "coordinate systems are not turned: of G10 L2 there is R0"},
    Meaning{"U", "there is no second axis along x: the axes are X, Y and Z"},
    Meaning{"V", "there is no second axis along y: the axes are X, Y and Z"},
    Meaning{"W", "there is no second axis along z: the axes are X, Y and Z"},
    Meaning{"#", "parameters are LinuxCNC's and Fanuc's: let the CAM system write the numbers"},
    Meaning{"[", "expressions are LinuxCNC's and Fanuc's: let the CAM system write the numbers"},
};

// Normal form: `g041` becomes `G41`.
std::string plain_word(std::string_view word)
{
    std::string plain;
    for (const char c : word) {
        if (c != ' ' && c != '\t' && !(c == '0' && plain.size() == 1)) {
            plain += capital(c);
        }
    }
    return plain;
}

std::string meaning_of(std::string_view word)
{
    if (word.empty()) {
        return "";
    }
    const std::string plain = plain_word(word);
    // A parameter or an expression counts wherever it is.
    const std::size_t expression = plain.find_first_of("#[");
    const std::size_t first = expression == std::string::npos ? 0 : expression;
    for (const Meaning& meaning : kMeanings) {
        if (plain == meaning.word ||
            (meaning.word.size() == 1 && plain[first] == meaning.word[0])) {
            return ": " + std::string{meaning.text};
        }
    }
    return "";
}

// A message for an order of G5.2 or G6.2 out of range, for which there is no error code.
std::string order_of_nurbs(std::string_view line)
{
    constexpr double kLeastOrder = 2;
    constexpr double kMostOrder = 5;
    Command command;
    if (!gcode::read_command(line, ModalState{}, command)) {
        return "";
    }
    const bool uniform = command.modal.motion == gcode::Motion::kUniformNurbs;
    const bool knotted = command.modal.motion == gcode::Motion::kNurbs;
    const char letter = uniform ? 'L' : 'P';
    if (!(uniform || knotted) || !command.has(letter)) {
        return "";
    }
    const double order = gcode::to_double(command.value(letter));
    if (order >= kLeastOrder && order <= kMostOrder && order == std::floor(order)) {
        return "";
    }
    return std::string{": "} + letter + " is the order of the NURBS, degree + 1: 2 to 5";
}

WordPlace refused_word(int code, std::string_view line)
{
    const std::vector<std::size_t> places = word_places(line);
    std::size_t program_number = places.size();
    for (std::size_t word = 0; word + 1 < places.size(); ++word) {
        Command command;
        const Status status =
            gcode::read_command(line.substr(0, places[word + 1]), ModalState{}, command);
        if (!status) {
            // An O word followed by another word is not a program number.
            const std::size_t wrong = std::min(program_number, word);
            return static_cast<int>(status.error()) == code
                       ? with_expression(line, word_at(line, places, wrong))
                       : WordPlace{};
        }
        if (capital(line[places[word]]) == 'O') {
            program_number = word;
        }
    }
    const bool by_value = code == kUnsupported || code == kUnusedWords;
    const WordPlace blamed = by_value ? word_to_blame(code, line, places) : WordPlace{};
    return blamed.end == 0 && code == kUnsupported ? rotary_word(line, places) : blamed;
}

}  // namespace

std::string refusal_text(int code, std::string_view word, std::string_view line)
{
    std::string text{error_text(code)};
    text += ": " + (word.empty() ? "" : shown(word) + " in ");
    return text + '"' + shown(trimmed(line)) + '"';
}

Refusal refusal(int code, std::string_view line)
{
    if (line.empty()) {
        return {0, 0, std::string{error_text(code)}};
    }
    const WordPlace place = refused_word(code, line);
    const std::string_view word = line.substr(place.begin, place.end - place.begin);
    std::string text = refusal_text(code, word, line);
    text += meaning_of(word) + (code == kInvalidTarget ? order_of_nurbs(line) : "");
    return {place.begin, place.end, text};
}

}  // namespace cusp::dialect
