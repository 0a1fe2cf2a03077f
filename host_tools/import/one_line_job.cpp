// Measures the part, chooses what was not asked for, and writes all of it as a job file.
#include "host_tools/import/one_line_job.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/import/one_line_check.hpp"
#include "host_tools/import/part_extent.hpp"
#include "host_tools/import/path_ending.hpp"
#include "host_tools/import/tool_text.hpp"
#include "host_tools/input_error/input_error.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::host {
namespace {

// What is chosen where nothing is asked for, in the unit of the job.
struct Defaults {
    const char* unit;
    double millimetres;       // of one unit
    double tolerance;         // at most
    double allowance;         // at most
    double clearance;         // over the stock
    double feed;              // a minute, at most
    double steps;             // of one unit: the stock's box is rounded outwards to them
    double least_rough;       // over the allowance, that roughing is worth
    double feed_of_diameter;  // a minute and unit of the diameter
};
constexpr Defaults kMetric{"mm", 1.0, 0.01, 0.3, 5.0, 1200.0, 1e3, 0.01, 200.0};
constexpr Defaults kInch{"inch", 25.4, 4e-4, 0.012, 0.2, 47.0, 1e4, 4e-4, 200.0};

constexpr double kSpindle = 12000;  // rpm
constexpr double kAllowanceOfDiameter = 0.05;
constexpr double kOverRounding = 0.15;  // of the step: what the measured box may be too large by

double three_digits(double value) { return std::stod(fmt::format("{:.3g}", value)); }

// A text as TOML writes it.
std::string quoted(const std::string& text)
{
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
        }
        const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7F;
        out += control ? fmt::format("\\u{:04X}", static_cast<unsigned>(c)) : std::string(1, c);
    }
    return out + '"';
}

std::string quoted_list(const std::vector<std::string>& texts)
{
    std::vector<std::string> all;
    std::transform(texts.begin(), texts.end(), std::back_inserter(all), quoted);
    return fmt::format("[{}]", fmt::join(all, ", "));
}

class OneLineBuilder {
public:
    OneLineBuilder(const OneLineRequest& request, PartFiles& parts)
        : request_{request}, parts_{parts}, defaults_{request.inch ? kInch : kMetric}
    {
        check_request(request);
        for (const std::string& text : request.tools) {
            tools_.push_back(tool_of_text(text, request.inch));
        }
        check_tools(request, tools_);
        choose_numbers();
        measure();
        check_sizes();
        choose_roughing();
    }

    OneLineJob build() const { return {toml(), said()}; }

private:
    void choose_numbers();
    void measure();
    void check_sizes() const;
    void choose_roughing();
    std::string toml() const;
    std::string operation_toml() const;
    std::vector<std::string> said() const;
    std::string said_feeds() const;
    std::string said_roughing() const;

    bool is_pocket() const { return request_.boundary.has_value(); }
    std::vector<NamedTool> roughing_tools() const
    {
        return {tools_.begin(), tools_.size() > 1 ? tools_.end() - 1 : tools_.end()};
    }
    double least_diameter(const std::vector<NamedTool>& tools) const
    {
        return std::min_element(
                   tools.begin(), tools.end(),
                   [](const NamedTool& a, const NamedTool& b) { return a.diameter < b.diameter; })
            ->diameter;
    }
    double up(double z) const
    {
        return std::ceil(z * defaults_.steps - kOverRounding) / defaults_.steps;
    }
    // "60 x 40": to the step that the stock is rounded to.
    std::string rounded(double length) const
    {
        return fmt::format("{:.6g}", std::round(length * defaults_.steps) / defaults_.steps + 0.0);
    }

    const OneLineRequest& request_;
    PartFiles& parts_;
    const Defaults& defaults_;
    std::vector<NamedTool> tools_;
    std::string strategy_;
    double tolerance_{};
    double feed_{};
    double plunge_feed_{};
    double spindle_{};
    double clearance_{};
    PartExtent box_;  // in the job's unit
    double top_{};
    double bottom_{};
    bool roughs_{};
    double max_depth_{};
    double allowance_{};
};

void OneLineBuilder::choose_numbers()
{
    strategy_ = !request_.strategy.empty() ? request_.strategy
                : is_pocket()              ? "contour_pocket"
                                           : "adaptive_isocurve";
    tolerance_ = request_.tolerance.value_or(std::min(defaults_.tolerance, *request_.scallop / 2));
    feed_ = request_.feed.value_or(three_digits(
        std::min(defaults_.feed, defaults_.feed_of_diameter * least_diameter(tools_))));
    plunge_feed_ = request_.plunge_feed.value_or(three_digits(feed_ / 4));
    spindle_ = request_.spindle.value_or(kSpindle);
    clearance_ = request_.clearance.value_or(defaults_.clearance);
}

// Reads the parts in the form that the strategy asks for: nothing is read twice.
void OneLineBuilder::measure()
{
    const double unit = defaults_.millimetres;
    const bool meshes = !is_pocket() && std::all_of(request_.parts.begin(), request_.parts.end(),
                                                    [](const std::string& part) {
                                                        return path_ending(part) == ".stl";
                                                    });
    bool is_first = true;
    for (const std::string& part : request_.parts) {
        const PartExtent box =
            meshes ? extent_of_triangles(parts_.mesh(part, unit))
                   : extent_of_surfaces(parts_.surfaces(part, unit, tolerance_ * unit / 2));
        box_ = is_first ? box : joined(box_, box);
        is_first = false;
    }
    box_ = {box_.low * (1 / unit), box_.high * (1 / unit)};
    top_ = up(box_.high.z) + 0.0;
    bottom_ = -up(-box_.low.z) + 0.0;
    if (is_pocket()) {
        top_ = std::max(top_, 0.0);
    }
    if (request_.stock_top && !is_pocket() && *request_.stock_top < top_) {
        throw InputError(fmt::format("--stock-top: is {:g} {}, but {} rises to z = {}",
                                     *request_.stock_top, defaults_.unit, request_.parts.front(),
                                     rounded(box_.high.z)));
    }
    top_ = request_.stock_top.value_or(top_);
}

void OneLineBuilder::check_sizes() const
{
    const Vec3d size = box_.size();
    for (std::size_t i = 0; i < tools_.size(); ++i) {
        if (tools_[i].diameter > std::max(size.x, size.y)) {
            throw InputError(fmt::format(
                "--tool {}: its diameter is {:.6g} {}, the part is only {} x {}: give a smaller "
                "tool, or the part's unit by --units",
                request_.tools[i], tools_[i].diameter, defaults_.unit, rounded(size.x),
                rounded(size.y)));
        }
    }
}

void OneLineBuilder::choose_roughing()
{
    const double diameter = least_diameter(roughing_tools());
    max_depth_ = request_.max_depth.value_or(diameter / 2);
    allowance_ = request_.allowance.value_or(
        three_digits(std::min(defaults_.allowance, kAllowanceOfDiameter * diameter)));
    const double depth = top_ - bottom_;
    const double enough = tools_.size() > 1 ? 0.0 : max_depth_;
    roughs_ = request_.roughing && depth > std::max(enough, allowance_ + defaults_.least_rough);
}

std::string OneLineBuilder::operation_toml() const
{
    std::string out = fmt::format("\n[[operation]]\nstrategy = \"{}\"\nfloor = {}\n", strategy_,
                                  quoted_list(request_.parts));
    if (is_pocket()) {
        out += fmt::format("boundary = {}\n", quoted(*request_.boundary));
    }
    if (!request_.islands.empty()) {
        out += fmt::format("islands = {}\n", quoted_list(request_.islands));
    }
    if (roughs_) {
        std::vector<std::size_t> numbers;
        for (std::size_t i = 1; i <= roughing_tools().size(); ++i) {
            numbers.push_back(i);
        }
        out += is_pocket() ? "" : "roughing = true\n";
        out += fmt::format("tools = [{}]  # these rough\nmax_depth = {}\nallowance = {}\n",
                           fmt::join(numbers, ", "), max_depth_, allowance_);
    }
    out += fmt::format(
        "tool = {}  # finishes\nscallop = {}\nfloor_tolerance = {}\nplan_tolerance = {}\n"
        "output = \"{}\"\n",
        tools_.size(), *request_.scallop, tolerance_, tolerance_, request_.output);
    return out;
}

std::string OneLineBuilder::toml() const
{
    std::string out = fmt::format(
        "# What a call of cusp plan without a job file amounts to. Paths are relative to this "
        "file:\n"
        "# save it in the folder where the call was made.\nunits = \"{}\"\n",
        defaults_.unit);
    for (std::size_t i = 0; i < tools_.size(); ++i) {
        out += fmt::format("\n[[tool]]\nnumber = {}\nshape = \"{}\"\ndiameter = {}\n", i + 1,
                           tools_[i].shape, tools_[i].diameter);
        if (tools_[i].corner_radius > 0) {
            out += fmt::format("corner_radius = {}\n", tools_[i].corner_radius);
        }
    }
    out += fmt::format("\n[cutting]\nfeed = {}\nplunge_feed = {}\nspindle = {}\n", feed_,
                       plunge_feed_, spindle_);
    out += fmt::format("\n[stock]\ntop = {}\n", top_);
    if (!is_pocket() && bottom_ < top_) {
        out += fmt::format("bottom = {}\n", bottom_);
    }
    return out + fmt::format("clearance = {}\n", clearance_) + operation_toml();
}

std::string OneLineBuilder::said_feeds() const
{
    std::vector<std::string> chosen;
    const auto note = [&](const std::optional<double>& asked, const char* option) {
        if (!asked) {
            chosen.emplace_back(option);
        }
    };
    note(request_.feed, "--feed");
    note(request_.plunge_feed, "--plunge-feed");
    note(request_.spindle, "--spindle");
    std::string out = fmt::format("feed {:.6g} {}/min, plunge feed {:.6g}, spindle {:.6g} rpm",
                                  feed_, defaults_.unit, plunge_feed_, spindle_);
    if (!chosen.empty()) {
        out += fmt::format(": defaults, {} set what suits your material", fmt::join(chosen, " "));
    }
    return out;
}

std::string OneLineBuilder::said_roughing() const
{
    if (!roughs_) {
        return !request_.roughing  ? "roughing: none, as asked for"
               : tools_.size() > 1 ? "roughing: none, there is nothing above the allowance"
                                   : "roughing: none, the part is no deeper than one cut";
    }
    std::vector<std::string> names;
    for (const NamedTool& tool : roughing_tools()) {
        names.push_back(words_of(tool, request_.inch));
    }
    return fmt::format("roughing: {}, layers of at most {:.6g} {}{}, leaves {:.6g}{}",
                       fmt::join(names, ", "), max_depth_, defaults_.unit,
                       request_.max_depth ? "" : " (half the diameter; --max-depth)", allowance_,
                       request_.allowance ? "" : " (--allowance)");
}

std::vector<std::string> OneLineBuilder::said() const
{
    const Vec3d size = box_.size();
    const bool names_unit =
        std::none_of(request_.parts.begin(), request_.parts.end(), [](const std::string& part) {
            return path_ending(part) == ".json" || path_ending(part) == ".stl";
        });
    const std::string what = is_pocket() ? "floor" : "part";
    return {
        fmt::format("{}: {} x {} {} from above, {} deep; {}", what, rounded(size.x),
                    rounded(size.y), defaults_.unit, rounded(size.z),
                    names_unit ? "the unit is the file's own"
                               : fmt::format("the file names no unit, it is taken as {} (--units)",
                                             defaults_.unit)),
        fmt::format("stock: x {} to {}, y {} to {}, top z = {}{}; cut down to z = {}",
                    rounded(box_.low.x), rounded(box_.high.x), rounded(box_.low.y),
                    rounded(box_.high.y), rounded(top_),
                    request_.stock_top ? ""
                    : is_pocket()      ? " (0 or the floor's top; --stock-top)"
                                       : " (the part's; --stock-top)",
                    rounded(box_.low.z)),
        said_feeds(), said_roughing(),
        fmt::format("finish: {}, {}, scallop {:.6g} {}, tolerance {:.6g}{}, {}", strategy_,
                    words_of(tools_.back(), request_.inch), *request_.scallop, defaults_.unit,
                    tolerance_, request_.tolerance ? "" : " (--tolerance)", request_.output)};
}

}  // namespace

OneLineJob one_line_job(const OneLineRequest& request, PartFiles& parts)
{
    return OneLineBuilder{request, parts}.build();
}

}  // namespace cusp::host
