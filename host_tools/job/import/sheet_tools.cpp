// The order of the tools in the call is the order of their use.
#include "host_tools/job/import/sheet_tools.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/number_text/number_text.hpp"

#include "fmt/format.h"

namespace cusp::import {

using toolpath::ToolShape;

std::vector<std::size_t> SheetTools::places_of(ToolShape shape) const
{
    std::vector<std::size_t> places;
    for (std::size_t k = 0; k < tools_.size(); ++k) {
        if (tools_[k].shape == toolpath::name_of(shape)) {
            places.push_back(k);
        }
    }
    return places;
}

std::vector<std::size_t> SheetTools::mills() const
{
    std::vector<std::size_t> places;
    for (std::size_t k = 0; k < tools_.size(); ++k) {
        if (tools_[k].tip_angle == 0) {
            places.push_back(k);
        }
    }
    if (isolating_ && places.size() > 1) {
        places.erase(std::remove(places.begin(), places.end(), *isolating_), places.end());
    }
    return places;
}

bool SheetTools::is_vee(std::size_t place) const
{
    return tools_[place].shape == toolpath::name_of(ToolShape::kVee);
}

std::size_t SheetTools::isolating_place(double depth) const
{
    std::vector<std::size_t> places = mills();
    const auto vees = places_of(ToolShape::kVee);
    places.insert(places.end(), vees.begin(), vees.end());
    if (places.empty()) {
        throw InputError(
            "--tool: there is copper to cut around, for which a mill or a vee is needed: add one, "
            "such as --tool flat:0.2 or vee:3:30:0.1");
    }
    const auto width = [&](std::size_t place) {
        const NamedTool& tool = tools_[place];
        return is_vee(place)
                   ? std::min(tool.diameter,
                              tool.tip_diameter +
                                  2 * depth * elementary::tan(tool.tip_angle / 2 * kPi / 180))
                   : tool.diameter;
    };
    return *std::min_element(places.begin(), places.end(),
                             [&](std::size_t a, std::size_t b) { return width(a) < width(b); });
}

std::size_t SheetTools::first_mill_place() const
{
    const auto places = mills();
    if (places.empty()) {
        throw InputError(
            "--tool: there are loops to cut along, for which a mill is needed: add one, "
            "such as --tool flat:3");
    }
    return places.front();
}

std::size_t SheetTools::last_mill_place() const
{
    first_mill_place();
    return mills().back();
}

std::vector<std::size_t> SheetTools::roughing_mills() const
{
    std::vector<std::size_t> numbers;
    for (const std::size_t place : mills()) {
        numbers.push_back(place + 1);
    }
    numbers.pop_back();
    return numbers;
}

std::size_t SheetTools::engraver_place() const
{
    const auto vees = places_of(ToolShape::kVee);
    return vees.empty() ? last_mill_place() : vees.front();
}

std::size_t SheetTools::vee_place(const LayerUse& use) const
{
    const auto vees = places_of(ToolShape::kVee);
    if (vees.empty()) {
        throw InputError(fmt::format("--layer {}={}: needs a vee: add one, such as --tool vee:6:60",
                                     use.layer, use.word));
    }
    return vees.front();
}

std::optional<std::size_t> SheetTools::drill_for(double diameter, double same, bool every) const
{
    const auto drills = places_of(ToolShape::kDrill);
    const auto fits = [&](std::size_t k) {
        return std::abs(tools_[k].diameter - diameter) <= same;
    };
    for (const auto& places : {drills, mills()}) {
        const auto found = std::find_if(places.begin(), places.end(), fits);
        if (found != places.end()) {
            return *found;
        }
    }
    std::optional<std::size_t> best;
    for (const std::size_t k :
         every ? (drills.empty() ? mills() : drills) : std::vector<std::size_t>{}) {
        if (tools_[k].diameter <= diameter + same &&
            (!best || tools_[k].diameter > tools_[*best].diameter)) {
            best = k;
        }
    }
    return best;
}

double SheetTools::tip_of(std::size_t place) const
{
    constexpr double kHundredth = 100;  // rounded up, so that the hole is through
    const NamedTool& tool = tools_[place];
    if (tool.shape != toolpath::name_of(ToolShape::kDrill)) {
        return 0;
    }
    const double tip = tool.diameter / 2 / elementary::tan(tool.tip_angle / 2 * kPi / 180);
    return std::ceil(tip * kHundredth) / kHundredth;
}

double SheetTools::step_of(std::size_t place) const
{
    return request_.max_depth.value_or(three_digits(tools_[place].diameter / 2));
}

SheetTabs tabs_of_text(const std::string& text, double depth, double diameter)
{
    constexpr double kMost = 1000;
    constexpr std::size_t kFields = 3;
    const auto refuse = [&](const char* what) {
        throw InputError(
            fmt::format("--tabs {}: {}: COUNT or COUNT:WIDTH:HEIGHT, such as 4 or "
                        "4:6:1.5",
                        text, what));
    };
    std::vector<double> values;
    std::istringstream in{text + ':'};
    for (std::string field; std::getline(in, field, ':');) {
        const auto found = number_text::leading_number(field);
        if (!found || found->size != field.size() || !(found->value > 0) ||
            !std::isfinite(found->value)) {
            refuse("numbers above 0 are needed");
        }
        values.push_back(found->value);
    }
    if (values.size() != 1 && values.size() != kFields) {
        refuse("one number or three are needed");
    }
    if (values[0] != std::floor(values[0]) || values[0] > kMost) {
        refuse("the count is a whole number of at most 1000");
    }
    const auto count = static_cast<std::size_t>(values[0]);
    if (values.size() == 1) {
        return {count, diameter, three_digits(depth / 4)};
    }
    if (values[2] >= depth) {
        refuse("tabs are lower than the cut is deep");
    }
    return {count, values[1], values[2]};
}

}  // namespace cusp::import
