// A post: the G-code form of one controller: the words it knows, the form of arcs and comments, the
// lines around the program and its tool changes.
//
// The default is the post "cusp"; import/post_reader.hpp reads others. docs/posts.md explains the
// keys, which are these members.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace cusp::toolpath {

enum class ArcForm : std::uint8_t { kCentre, kRadius, kNone };
enum class CommentForm : std::uint8_t { kParentheses, kSemicolon, kNone };

// Lines are templates: {name} is replaced. A line that is {comment} alone may become several.
struct Post {
    std::string name{"cusp"};
    std::string about{"this project's firmware"};  // the controller, in a few words
    int mm_decimals{4};
    int inch_decimals{5};
    ArcForm arcs{ArcForm::kCentre};
    bool nurbs{true};
    bool drill_cycles{false};  // G81, G83 with G98, G80
    bool point{false};         // in whole numbers too: X10. instead of X10
    double
        rapid_feed{};  // mm/min: the F word of G0, for controllers that move by the last one; 0: none
    CommentForm comments{CommentForm::kParentheses};
    int line_numbers{0};             // from one N to the next; 0: none
    std::vector<std::string> begin;  // first of all
    // {units}, {offset}, {clearance}
    std::vector<std::string> modes{"G17 {units} G40 G49 {offset} G80 G90 G94", "G0 Z{clearance}"};
    std::vector<std::string> exact_path{"G61"};
    std::vector<std::string> blend{"G64 P{tolerance}"};  // empty: the controller can't
    std::vector<std::string> header;
    // {tool}, {name}, {comment}, {clearance}
    std::vector<std::string> first_tool{"{comment}", "T{tool}"};
    std::vector<std::string> next_tool{"M5", "{comment}", "T{tool}", "M0"};
    std::vector<std::string> spindle_on{"M3 S{rpm}"};
    std::vector<std::string> mist{"M7"};
    std::vector<std::string> flood{"M8"};
    std::vector<std::string> coolant_off{"M9"};
    // With spindle and coolant on. If there are any, x and y are unknown after them, z is
    // {clearance}.
    std::vector<std::string> after_tool;  // {tool}, {clearance}
    std::vector<std::string> footer;
    std::vector<std::string> end{"M5", "M30"};

    int decimals(bool inch) const { return inch ? inch_decimals : mm_decimals; }
};

// mm: the last decimal.
double last_decimal_of(const Post& post, bool inch);

// mm: bound on the error of rounding to the post's decimals. Each axis moves by half of the last
// decimal. Rounding the centre or radius of an arc adds an error that the writer measures and keeps
// below 1.5 of the last decimal.
double rounding_of(const Post& post, bool inch);

// mm: the excess over the rounding of the post "cusp", which planners allow for; never below 0.
double added_rounding(const Post& post, bool inch);

// The template with every {name} replaced by its value; a name without a value stays.
std::string filled(std::string line,
                   const std::vector<std::pair<std::string, std::string>>& values);

// Characters of a comment in one line.
inline constexpr std::size_t kCommentWidth = 72;

// The comment as one line, or as many as a controller's short lines need, each with its end; ""
// where the form has none. Characters that controllers take for commands are replaced.
std::string comment_lines(std::string text, CommentForm form);

// A comment for the end of a line, shortened where it is too long; "" where the post has none.
std::string comment_word(std::string text, CommentForm form);

}  // namespace cusp::toolpath
