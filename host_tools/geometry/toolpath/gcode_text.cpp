// Fixed point without trailing zeros.
#include "host_tools/geometry/toolpath/gcode_text.hpp"

#include <cmath>
#include <cstdlib>

#include "firmware/base/math.hpp"

#include "fmt/format.h"

namespace cusp::toolpath {
namespace {

constexpr int kKnotDigits = 9;
constexpr int kSizeDecimals = 7;  // of a tool: in inch 3 nm

std::string trimmed(std::string text)
{
    if (text.find('.') != std::string::npos) {
        text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.') {
            text.pop_back();
        }
    }
    return text == "-0" ? "0" : text;
}

}  // namespace

std::string fixed_point(double value, int decimals)
{
    return trimmed(fmt::format("{:.{}f}", value, decimals));
}

std::string nine_digits(double value)
{
    int before_point = 1;
    for (double limit = 10; std::abs(value) >= limit && before_point < kKnotDigits; limit *= 10) {
        ++before_point;
    }
    return fixed_point(value, kKnotDigits - before_point);
}

std::string feed_text(double feed, bool point)
{
    std::string text = fixed_point(feed, 3);
    if (point && text.find('.') == std::string::npos) {
        text += '.';
    }
    return text;
}

void add_scaled(std::string& text, std::int64_t value, std::int64_t scale, bool point)
{
    const std::int64_t size = std::abs(value);
    const fmt::format_int whole{size / scale};
    if (value < 0) {
        text += '-';
    }
    text.append(whole.data(), whole.size());
    if (const std::int64_t below = size % scale; below != 0) {
        // The leading one keeps the zeros of what is below one.
        const fmt::format_int digits{scale + below};
        std::size_t count = digits.size();
        while (digits.data()[count - 1] == '0') {
            --count;
        }
        text += '.';
        text.append(digits.data() + 1, count - 1);
    } else if (point) {
        text += '.';
    }
}

std::string tool_text(const Toolpath& path, double unit, const char* name)
{
    std::string text = tool_sizes(path.tool, unit, name);
    if (!path.tool_name.empty()) {
        text += ": " + path.tool_name;
    }
    return text;
}

std::string tool_sizes(const Tool& tool, double unit, const char* name)
{
    const auto size = [&](const char* of, double mm) {
        return fmt::format(" {} {} {}", of, fixed_point(mm / unit, kSizeDecimals), name);
    };
    std::string text = fmt::format("tool {} {}", tool.number, name_of(tool.shape));
    text += size("diameter", 2 * tool.radius);
    if (tool.shape == ToolShape::kBull) {
        text += size("corner radius", tool.corner_radius);
    }
    if (is_conical(tool) && tool.corner_radius > 0) {
        text += size("ball radius", tool.corner_radius);
    }
    if (is_conical(tool) && tool.tip_radius > 0) {
        text += size("tip diameter", 2 * tool.tip_radius);
    }
    if (is_conical(tool)) {
        text += " tip angle " + fixed_point(tool.tip_angle * 180 / kPi, kSizeDecimals);
    }
    return text;
}

}  // namespace cusp::toolpath
