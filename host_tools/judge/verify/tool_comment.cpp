// Word by word.
#include "host_tools/judge/verify/tool_comment.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "firmware/base/inch.hpp"
#include "firmware/base/math.hpp"
#include "host_tools/geometry/toolpath/post.hpp"

namespace cusp::verify {

using toolpath::Tool;
using toolpath::ToolShape;

namespace {

// Without its bracket or semicolon, and without a tool's name.
std::string text_of_comment(std::string_view line)
{
    const std::size_t begin = line.find_first_of("(;");
    if (begin == std::string_view::npos) {
        return {};
    }
    std::string text{line.substr(begin + 1)};
    text.erase(std::min(text.find_first_of(":)"), text.size()));
    return text;
}

std::vector<std::string> words_of_comment(std::string_view line)
{
    std::string text = text_of_comment(line);
    for (char& c : text) {
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    std::istringstream in{text};
    std::vector<std::string> words;
    for (std::string word; in >> word;) {
        words.push_back(word);
    }
    return words;
}

std::optional<double> positive_number(const std::string& word)
{
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    const bool good = end != word.c_str() && *end == '\0' && std::isfinite(value) && value > 0;
    return good ? std::optional{value} : std::nullopt;
}

// mm: 6 of "diameter 6 mm" for the name "diameter"; of "tip diameter 1 mm" only where the word before
// is `of`.
std::optional<double> length_after(const std::vector<std::string>& words,
                                   const char* name,
                                   const char* of = nullptr)
{
    for (std::size_t i = 1; i + 2 < words.size(); ++i) {
        const bool named = words[i] == name && (words[i - 1] == "tip") == (of != nullptr);
        const auto value = named ? positive_number(words[i + 1]) : std::nullopt;
        if (value && (words[i + 2] == "mm" || words[i + 2] == "inch")) {
            return *value * (words[i + 2] == "inch" ? kMillimetresPerInch : 1.0);
        }
    }
    return std::nullopt;
}

std::optional<double> angle_after(const std::vector<std::string>& words)
{
    for (std::size_t i = 0; i + 1 < words.size(); ++i) {
        const auto value = words[i] == "angle" ? positive_number(words[i + 1]) : std::nullopt;
        if (value && *value < 180) {
            return *value * kPi / 180;
        }
    }
    return std::nullopt;
}

std::optional<ToolShape> shape_named(const std::string& word)
{
    for (const ToolShape shape : {ToolShape::kBall, ToolShape::kFlat, ToolShape::kBull,
                                  ToolShape::kVee, ToolShape::kDrill, ToolShape::kTaper}) {
        if (word == toolpath::name_of(shape)) {
            return shape;
        }
    }
    return std::nullopt;
}

}  // namespace

std::optional<Tool> tool_of_comment(std::string_view line)
{
    constexpr std::size_t kFewest = 6;  // tool 1 flat diameter 6 mm
    const std::vector<std::string> words = words_of_comment(line);
    if (words.size() < kFewest || words[0] != "tool") {
        return std::nullopt;
    }
    const auto number = positive_number(words[1]);
    const auto shape = shape_named(words[2]);
    const auto diameter = length_after(words, "diameter");
    if (!number || !shape || !diameter || *number != std::floor(*number)) {
        return std::nullopt;
    }
    Tool tool{static_cast<int>(*number), *shape, *diameter / 2, 0};
    if (*shape == ToolShape::kBall) {
        tool.corner_radius = tool.radius;
    }
    if (*shape == ToolShape::kBull) {
        const auto corner = length_after(words, "radius");
        if (!corner || *corner > tool.radius) {
            return std::nullopt;
        }
        tool.corner_radius = *corner;
    }
    if (is_conical(tool)) {
        const auto angle = angle_after(words);
        if (!angle) {
            return std::nullopt;
        }
        tool.tip_angle = *angle;
        tool.corner_radius = length_after(words, "radius").value_or(0.0);
        tool.tip_radius = length_after(words, "diameter", "tip").value_or(0.0) / 2;
        if (!(std::max(tool.corner_radius, tool.tip_radius) < tool.radius)) {
            return std::nullopt;
        }
    }
    return tool;
}

std::optional<Tool> ToolComments::tool_after(std::string_view line)
{
    constexpr std::size_t kLongest = 200;  // characters: longer ones are no comment on a tool
    const std::vector<std::string> words = words_of_comment(line);
    const bool begins = !words.empty() && words[0] == "tool";
    const bool goes_on = !begun_.empty() && !begins && !line.empty() &&
                         (line[0] == '(' || line[0] == ';') && begun_.size() < kLongest;
    begun_ = begins    ? "(" + text_of_comment(line)
             : goes_on ? begun_ + " " + text_of_comment(line)
                       : std::string{};
    const std::optional<Tool> tool = begun_.empty() ? std::nullopt : tool_of_comment(begun_);
    if (tool) {
        begun_.clear();
    }
    return tool;
}

bool is_same_cutter(const Tool& a, const Tool& b)
{
    constexpr double kSameSize = 1e-3;   // mm
    constexpr double kSameAngle = 1e-3;  // radians
    const auto is_same = [](double one, double other) {
        return std::abs(one - other) < kSameSize;
    };
    return a.shape == b.shape && is_same(a.radius, b.radius) &&
           is_same(a.corner_radius, b.corner_radius) && is_same(a.tip_radius, b.tip_radius) &&
           std::abs(a.tip_angle - b.tip_angle) < kSameAngle;
}

}  // namespace cusp::verify
