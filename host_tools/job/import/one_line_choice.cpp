// Chooses numbers, measures the part, then decides on roughing.
#include "host_tools/job/import/one_line_choice.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/inch.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/mesh_file.hpp"
#include "host_tools/job/import/one_line_check.hpp"
#include "host_tools/job/import/one_line_rates.hpp"
#include "host_tools/job/import/placing.hpp"
#include "host_tools/job/import/sheet_job.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

// Defaults, in the unit of the job.
struct Defaults {
    const char* unit;
    double millimetres;       // of one unit
    double tolerance;         // at most
    double allowance;         // at most
    double clearance;         // over the stock
    double feed;              // a minute, at most
    double steps;             // per unit: the stock's box is rounded outwards to these steps
    double least_rough;       // stock above the allowance below which roughing is left out
    double feed_of_diameter;  // a minute and unit of the diameter
};
constexpr Defaults kMetric{"mm", 1.0, 0.01, 0.3, 5.0, 1200.0, 1e3, 0.01, 200.0};
constexpr Defaults kInch{"inch", kMillimetresPerInch, 4e-4, 0.012, 0.2, 47.0, 1e4, 4e-4, 200.0};

constexpr double kSpindle = 12000;  // rpm
constexpr double kAllowanceOfDiameter = 0.05;
constexpr double kOverRounding = 0.15;  // of a step: excess of the measured box that is ignored

double least_diameter(const std::vector<NamedTool>& tools)
{
    return std::min_element(
               tools.begin(), tools.end(),
               [](const NamedTool& a, const NamedTool& b) { return a.diameter < b.diameter; })
        ->diameter;
}

class OneLineChooser {
public:
    OneLineChooser(const OneLineRequest& request,
                   const job::Strategies& strategies,
                   PartFiles& parts)
        : request_{request}, parts_{parts}, defaults_{request.inch ? kInch : kMetric}
    {
        choice_ = choose_rates(request);
        choice_.strategy = strategy_of(request, strategies).name;
        check_tools(request, choice_.tools);
        choice_.tolerance =
            request_.tolerance.value_or(std::min(defaults_.tolerance, *request_.scallop / 2));
        place_request(request_, parts_);
        measure();
        check_shapes(request_, choice_.tools,
                     {rounded(choice_.part.size().x), rounded(choice_.part.size().y)});
        choose_roughing();
    }

    OneLineChoice choice() const { return choice_; }

private:
    void measure();
    void choose_roughing();

    bool is_pocket() const { return request_.boundary.has_value(); }
    double rounded(double length) const
    {
        return std::round(length * defaults_.steps) / defaults_.steps;
    }
    double up(double z) const
    {
        return std::ceil(z * defaults_.steps - kOverRounding) / defaults_.steps;
    }

    const OneLineRequest& request_;
    PartFiles& parts_;
    const Defaults& defaults_;
    OneLineChoice choice_{};
};

// Reads the parts in the form that the strategy needs, so that no file is read twice.
void OneLineChooser::measure()
{
    const double unit = defaults_.millimetres;
    const bool meshes =
        !is_pocket() && std::all_of(request_.parts.begin(), request_.parts.end(), is_mesh_file);
    bool is_first = true;
    for (const std::string& part : request_.parts) {
        const PartExtent box =
            meshes ? extent_of_triangles(parts_.mesh(part, unit))
                   : extent_of_surfaces(parts_.surfaces(part, unit, choice_.tolerance * unit / 2));
        choice_.part = is_first ? box : joined(choice_.part, box);
        is_first = false;
    }
    choice_.part = {choice_.part.low * (1 / unit), choice_.part.high * (1 / unit)};
    choice_.top = up(choice_.part.high.z) + 0.0;
    choice_.bottom = -up(-choice_.part.low.z) + 0.0;
    if (is_pocket()) {
        choice_.top = std::max(choice_.top, 0.0);
    }
    if (request_.stock_top && !is_pocket() && *request_.stock_top < choice_.top) {
        throw InputError(fmt::format("--stock-top: is {:g} {}, but {} rises to z = {}",
                                     *request_.stock_top, defaults_.unit, request_.parts.front(),
                                     choice_.words(choice_.part.high.z)));
    }
    choice_.top = request_.stock_top.value_or(choice_.top);
}

void OneLineChooser::choose_roughing()
{
    const double diameter = least_diameter(choice_.roughing_tools());
    choice_.max_depth = request_.max_depth.value_or(diameter / 2);
    choice_.allowance = request_.allowance.value_or(
        three_digits(std::min(defaults_.allowance, kAllowanceOfDiameter * diameter)));
    const double depth = choice_.top - choice_.bottom;
    const double sufficient = choice_.tools.size() > 1 ? 0.0 : choice_.max_depth;
    choice_.roughs = request_.roughing &&
                     depth > std::max(sufficient, choice_.allowance + defaults_.least_rough);
}

}  // namespace

std::string OneLineChoice::words(double length) const
{
    return fmt::format("{:.6g}", std::round(length * steps) / steps + 0.0);
}

std::vector<NamedTool> OneLineChoice::roughing_tools() const
{
    return {tools.begin(), tools.size() > 1 ? tools.end() - 1 : tools.end()};
}

double three_digits(double value) { return std::stod(fmt::format("{:.3g}", value)); }

OneLineChoice choose_rates(const OneLineRequest& request)
{
    const Defaults& defaults = request.inch ? kInch : kMetric;
    OneLineChoice choice{};
    choice.unit = defaults.unit;
    choice.steps = defaults.steps;
    for (const std::string& text : request.tools) {
        choice.tools.push_back(tool_of_text(text, request.inch));
    }
    for (const NamedTool& tool : choice.tools) {
        const double feed = request.feed.value_or(
            three_digits(std::min(defaults.feed, defaults.feed_of_diameter * tool.diameter)));
        choice.feeds.push_back(feed);
        choice.plunge_feeds.push_back(request.plunge_feed.value_or(three_digits(feed / 4)));
        choice.spindles.push_back(request.spindle.value_or(kSpindle));
    }
    choice.clearance = request.clearance.value_or(defaults.clearance);
    put_rates(request, choice);
    return choice;
}

void place_request(const OneLineRequest& request, PartFiles& parts)
{
    const double unit = request.inch ? kMillimetresPerInch : 1.0;
    if (parts.is_placed()) {
        return;
    }
    if (!request.width && request.heights.empty() && !request.scale && request.up.empty() &&
        request.rotate.empty() && request.origin.empty() && request.move.empty()) {
        return;
    }
    Placing placing;
    if (request.width && request.heights.size() == 2) {
        placing.relief = {unit * *request.width, unit * request.heights[0],
                          unit * request.heights[1]};
    }
    placing.scale = request.scale.value_or(placing.scale);
    placing.up = request.up.empty() ? placing.up : request.up;
    placing.origin = request.origin;
    const std::vector<double>& turn = request.rotate;
    if (turn.size() == 1) {
        placing.rotate = {0, 0, turn[0]};
    } else if (turn.size() == 3) {
        placing.rotate = {turn[0], turn[1], turn[2]};
    }
    if (request.move.size() == 3) {
        placing.move = unit * Vec3d{request.move[0], request.move[1], request.move[2]};
    }
    PlacedFiles files{request.parts, request.islands};
    if (is_sheet_request(request)) {
        files = {{}, request.parts};
    }
    if (request.boundary) {
        files.drawings.push_back(*request.boundary);
    }
    place_parts({placing}, files, unit, parts);
}

OneLineChoice choose(const OneLineRequest& request,
                     const job::Strategies& strategies,
                     PartFiles& parts)
{
    check_request(request, strategies);
    return OneLineChooser{request, strategies, parts}.choice();
}

}  // namespace cusp::import
