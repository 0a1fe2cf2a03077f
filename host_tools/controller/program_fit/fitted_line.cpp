// Fixed-point numbers and the words of a move.
#include "host_tools/controller/program_fit/fitted_line.hpp"

#include <array>
#include <cmath>
#include <cstdlib>

namespace cusp::program_fit {
namespace {

// units / 10^decimals, trailing zeros left out.
void append_fixed(std::string& text, std::int64_t units, unsigned decimals)
{
    std::array<char, 32> digits{};
    std::size_t place = digits.size();
    std::int64_t rest = std::llabs(units);
    while (decimals > 0 && rest % 10 == 0) {
        rest /= 10;
        --decimals;
    }
    for (unsigned i = 0; i <= decimals || rest != 0; ++i) {
        digits[--place] = static_cast<char>('0' + rest % 10);
        rest /= 10;
        if (i + 1 == decimals) {
            digits[--place] = '.';
        }
    }
    if (units < 0) {
        digits[--place] = '-';
    }
    text.append(digits.data() + place, digits.size() - place);
}

}  // namespace

void append_length(std::string& text, std::int64_t nm, bool inches)
{
    if (!inches) {
        append_fixed(text, nm, 6);
        return;
    }
    constexpr std::int64_t kNmPerInch = 25400000;
    constexpr std::int64_t kNano = 1000000000;
    const std::int64_t whole = nm / kNmPerInch;
    // Below 2.54e16, and rounded to nearest.
    const std::int64_t part = nm % kNmPerInch * kNano;
    const std::int64_t half = part < 0 ? -kNmPerInch / 2 : kNmPerInch / 2;
    append_fixed(text, whole * kNano + (part + half) / kNmPerInch, 9);
}

std::string_view plane_word(path::Plane plane)
{
    constexpr std::array<std::string_view, 3> kWords = {"G17", "G18", "G19"};
    return kWords[static_cast<std::size_t>(plane)];
}

void append_move(std::string& text, const segmenter::FittedMove& move, const LineWords& words)
{
    if (!words.number.empty()) {
        text += 'N';
        text += words.number;
        text += ' ';
    }
    if (move.is_arc && words.names_plane) {
        text += plane_word(move.plane);
        text += ' ';
    }
    text += !move.is_arc ? "G1" : move.clockwise ? "G2" : "G3";
    // An arc names an axis of its plane even where both come back to where they were.
    bool named = false;
    for (unsigned axis = 0; axis < 3; ++axis) {
        if (words.from[axis] == words.to[axis]) {
            continue;
        }
        named = true;
        text += ' ';
        text += static_cast<char>('X' + axis);
        const std::int64_t origin = words.incremental ? words.from[axis] : words.work_offset[axis];
        append_length(text, words.to[axis] - origin, words.inches);
    }
    if (!named) {
        text += words.incremental ? " X0 Y0" : "";
    }
    if (move.is_arc) {
        constexpr std::array<std::array<char, 2>, 3> kOffsets = {
            {{'I', 'J'}, {'K', 'I'}, {'J', 'K'}}};
        const auto& letters = kOffsets[static_cast<std::size_t>(move.plane)];
        const std::array<double, 2> offsets = {move.first_offset, move.second_offset};
        for (std::size_t i = 0; i < offsets.size(); ++i) {
            text += ' ';
            text += letters[i];
            append_fixed(text, std::llround(offsets[i] / centre_step(words.inches)),
                         words.inches ? 6 : 4);
        }
    }
    if (!words.feed.empty()) {
        text += " F";
        text += words.feed;
    }
}

}  // namespace cusp::program_fit
