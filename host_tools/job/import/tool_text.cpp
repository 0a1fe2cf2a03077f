// Fields between colons; lengths with or without their unit.
#include "host_tools/job/import/tool_text.hpp"

#include <cmath>
#include <sstream>
#include <vector>

#include "firmware/base/inch.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/number_text/number_text.hpp"
#include "host_tools/job/job/keys.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& what)
{
    throw InputError(fmt::format("--tool {}: {}", text, what));
}

std::vector<std::string> fields_of(const std::string& text)
{
    std::vector<std::string> fields;
    std::istringstream in{text + ':'};  // an empty last field counts
    for (std::string field; std::getline(in, field, ':');) {
        fields.push_back(field);
    }
    return fields;
}

double length_of(const std::string& text, const char* what, const std::string& field, bool inch)
{
    if (field.empty()) {
        refuse(text, fmt::format("the {} is missing: ball:6, flat:8, bull:10:1.5", what));
    }
    const auto found = number_text::leading_number(field);
    if (!found || !std::isfinite(found->value)) {
        refuse(text,
               fmt::format("\"{}\" is no {}: a number is needed, such as ball:6", field, what));
    }
    const double value = found->value;
    const std::string unit = field.substr(found->size);
    if (!unit.empty() && unit != "mm" && unit != "in") {
        refuse(text, fmt::format("\"{}\" is no unit of length: mm or in", unit));
    }
    if (!(value > 0 && value <= job::kLargest)) {
        refuse(text, fmt::format("the {} is {:g}, it must be above 0 and at most {:g}", what, value,
                                 job::kLargest));
    }
    if (unit == "in" && !inch) {
        return value * kMillimetresPerInch;
    }
    return unit == "mm" && inch ? value / kMillimetresPerInch : value;
}

// degrees
double angle_of(const std::string& text, const std::string& field)
{
    constexpr double kStraight = 180;
    const auto found = number_text::leading_number(field);
    if (!found || found->size != field.size() || !(found->value > 0 && found->value < kStraight)) {
        refuse(text,
               fmt::format("\"{}\" is no angle of the tip: degrees above 0 and below 180, such "
                           "as vee:6:60",
                           field));
    }
    return found->value;
}

constexpr const char* kTaper = "taper";

bool has_tip(const std::string& shape) { return shape == "drill" || shape == "vee"; }

void check_fields(const std::string& text, const std::string& shape, std::size_t count)
{
    const bool is_vee = shape == "vee";
    if (count > (is_vee ? 4U : 3U) && has_tip(shape)) {
        refuse(text, is_vee
                         ? "a vee has a diameter, the angle of its tip, and if it is not sharp the "
                           "diameter of the flat there: vee:6:90, vee:3:30:0.1"
                         : "a drill has a diameter and the angle of its tip: drill:6:90");
    }
    if (shape == kTaper) {
        if (count != 4) {
            refuse(
                text,
                "a taper has a diameter, the angle of its flank from the axis, and the radius of "
                "the ball at its tip: taper:6:5:0.5");
        }
        return;
    }
    const bool bull = shape == "bull";
    if (count > (bull ? 3U : 2U) && !has_tip(shape)) {
        refuse(text, bull ? "a bull-nose end has a diameter and a corner radius: bull:10:1.5"
                          : fmt::format("a {} end has a diameter only: {}:6; bull:10:1.5 has "
                                        "round corners",
                                        shape, shape));
    }
}

}  // namespace

NamedTool tool_of_text(const std::string& text, bool inch)
{
    constexpr double kDrillTip = 118;  // degrees
    const std::vector<std::string> fields = fields_of(text);
    NamedTool tool;
    tool.shape = fields[0];
    const bool bull = tool.shape == "bull";
    if (tool.shape != "ball" && tool.shape != "flat" && !bull && !has_tip(tool.shape) &&
        tool.shape != kTaper) {
        refuse(text,
               fmt::format("no shape is named \"{}\": ball:DIAMETER, flat:DIAMETER or "
                           "bull:DIAMETER:CORNER_RADIUS; as a last tool "
                           "taper:DIAMETER:ANGLE:BALL_RADIUS; for drawings also drill:DIAMETER and "
                           "vee:DIAMETER:ANGLE",
                           tool.shape));
    }
    tool.diameter = length_of(text, "diameter", fields.size() > 1 ? fields[1] : "", inch);
    check_fields(text, tool.shape, fields.size());
    const std::string last = fields.size() > 2 ? fields[2] : "";
    if (has_tip(tool.shape)) {
        const bool known = tool.shape == "drill" && fields.size() == 2;
        tool.tip_angle = known ? kDrillTip : angle_of(text, last);
        if (fields.size() > 3) {
            tool.tip_diameter = length_of(text, "diameter of the tip", fields[3], inch);
            if (!(tool.tip_diameter < tool.diameter)) {
                refuse(text, fmt::format("the diameter of the tip is {:g}, the tool's only {:g}",
                                         tool.tip_diameter, tool.diameter));
            }
        }
    } else if (bull || tool.shape == kTaper) {
        const bool tapers = !bull;
        tool.taper_angle = tapers ? angle_of(text, last) : 0;
        tool.corner_radius = length_of(text, "corner radius", tapers ? fields[3] : last, inch);
        if (tool.corner_radius > tool.diameter / 2 || (tapers && !(tool.taper_angle < 90))) {
            refuse(text, tapers && !(tool.taper_angle < 90)
                             ? "the angle of a taper's flank from the axis is below 90 degrees"
                             : fmt::format("the corner radius is {:g}, the tool's radius only {:g}",
                                           tool.corner_radius, tool.diameter / 2));
        }
    }
    return tool;
}

std::string words_of(const NamedTool& tool, bool inch)
{
    const char* unit = inch ? "inch" : "mm";
    std::string words = fmt::format("{} {:.6g} {}", tool.shape, tool.diameter, unit);
    if (tool.taper_angle > 0) {
        words += fmt::format(" of {:g} degrees with a ball of {:.6g} {}", tool.taper_angle,
                             2 * tool.corner_radius, unit);
    } else if (tool.corner_radius > 0) {
        words += fmt::format(" with corners of {:.6g} {}", tool.corner_radius, unit);
    }
    if (tool.shape == "vee") {
        words += fmt::format(" of {:g} degrees", tool.tip_angle);
        words += tool.tip_diameter > 0
                     ? fmt::format(" with a tip of {:.6g} {}", tool.tip_diameter, unit)
                     : "";
    }
    return words;
}

}  // namespace cusp::import
