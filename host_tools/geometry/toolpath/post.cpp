// Texts of a post: templates and comments.
#include "host_tools/geometry/toolpath/post.hpp"

#include <algorithm>

#include "firmware/base/inch.hpp"
#include "host_tools/base/elementary/elementary.hpp"

namespace cusp::toolpath {
namespace {

// In last decimals: 1.5 in the plane of an arc, 0.5 square to it, together 1.58.
constexpr double kMostRounding = 1.6;

// Replaces characters that a controller reads as a realtime command or as the end of the comment.
char plain_character(char c)
{
    const bool printable = c >= ' ' && c <= '~';
    const bool command = c == '!' || c == '?' || c == '~' || c == '%';
    return c == '(' ? '[' : c == ')' ? ']' : printable && !command ? c : '_';
}

std::string in_form(const std::string& text, CommentForm form)
{
    return form == CommentForm::kParentheses ? "(" + text + ")" : "; " + text;
}

}  // namespace

double last_decimal_of(const Post& post, bool inch)
{
    const double unit = inch ? kMillimetresPerInch : 1.0;
    return unit * elementary::power_of_ten(-post.decimals(inch));
}

double rounding_of(const Post& post, bool inch)
{
    return kMostRounding * last_decimal_of(post, inch);
}

double added_rounding(const Post& post, bool inch)
{
    const Post cusp;
    return post.decimals(inch) < cusp.decimals(inch) ? rounding_of(post, inch) : 0.0;
}

std::string filled(std::string line, const std::vector<std::pair<std::string, std::string>>& values)
{
    for (const auto& [name, value] : values) {
        const std::string field = "{" + name + "}";
        for (std::size_t at = line.find(field); at != std::string::npos;
             at = line.find(field, at + value.size())) {
            line.replace(at, field.size(), value);
        }
    }
    return line;
}

std::string comment_lines(std::string text, CommentForm form)
{
    if (form == CommentForm::kNone) {
        return "";
    }
    std::transform(text.begin(), text.end(), text.begin(), plain_character);
    std::string lines;
    while (text.size() > kCommentWidth) {
        const std::size_t blank = text.rfind(' ', kCommentWidth);
        const bool between_words = blank != std::string::npos && blank > 0;
        const std::size_t end = between_words ? blank : kCommentWidth;
        lines += in_form(text.substr(0, end), form) + "\n";
        text.erase(0, between_words ? end + 1 : end);
    }
    return lines + in_form(text, form) + "\n";
}

std::string comment_word(std::string text, CommentForm form)
{
    if (form == CommentForm::kNone) {
        return "";
    }
    std::transform(text.begin(), text.end(), text.begin(), plain_character);
    return in_form(text.substr(0, kCommentWidth), form);
}

}  // namespace cusp::toolpath
