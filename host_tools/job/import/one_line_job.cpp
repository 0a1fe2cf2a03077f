// Writes the job file, and sentences on what was chosen.
#include "host_tools/job/import/one_line_job.hpp"

#include <algorithm>

#include "host_tools/job/import/mesh_file.hpp"
#include "host_tools/job/import/one_line_check.hpp"
#include "host_tools/job/import/one_line_choice.hpp"
#include "host_tools/job/import/one_line_text.hpp"
#include "host_tools/job/import/sheet_job.hpp"
#include "host_tools/job/import/solid_job.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {
namespace {

class OneLineWriter {
public:
    // all    the tools of the call: those of `choice`, then drills
    // solid  what is cut beside the part's surfaces
    OneLineWriter(const OneLineRequest& request,
                  const OneLineChoice& choice,
                  const OneLineChoice& all,
                  const SolidCuts& solid)
        : request_{request}, choice_{choice}, all_{all}, solid_{solid}
    {
    }

    std::string toml() const;
    std::vector<std::string> said() const;

private:
    std::string operation_toml() const;
    std::string said_roughing() const;

    bool is_pocket() const { return request_.boundary.has_value(); }

    const OneLineRequest& request_;
    const OneLineChoice& choice_;
    const OneLineChoice& all_;
    const SolidCuts& solid_;
};

std::string OneLineWriter::operation_toml() const
{
    std::string out = fmt::format("\n[[operation]]\nstrategy = \"{}\"\nfloor = {}\n",
                                  choice_.strategy, quoted_list(request_.parts));
    if (is_pocket()) {
        out += fmt::format("boundary = {}\n", quoted(*request_.boundary));
    }
    if (!request_.islands.empty()) {
        out += fmt::format("islands = {}\n", quoted_list(request_.islands));
    }
    if (choice_.roughs) {
        std::vector<std::size_t> numbers;
        for (std::size_t i = 1; i <= choice_.roughing_tools().size(); ++i) {
            numbers.push_back(i);
        }
        out += is_pocket() ? "" : "roughing = true\n";
        out += fmt::format("tools = [{}]  # these rough\nmax_depth = {}\nallowance = {}\n",
                           fmt::join(numbers, ", "), choice_.max_depth, choice_.allowance);
    }
    out += fmt::format(
        "tool = {}  # finishes\nscallop = {}\nfloor_tolerance = {}\nplan_tolerance = {}\n"
        "output = \"{}\"\n",
        choice_.tools.size(), *request_.scallop, choice_.tolerance, choice_.tolerance,
        request_.output);
    return out;
}

std::string OneLineWriter::toml() const
{
    std::string out = head_toml(request_, all_);
    out += fmt::format("\n[stock]\ntop = {}\n", choice_.top);
    if (!is_pocket() && choice_.bottom < choice_.top) {
        out += fmt::format("bottom = {}\n", choice_.bottom);
    }
    return out + solid_.stock + fmt::format("clearance = {}\n", choice_.clearance) +
           placing_toml(request_) + solid_.before + operation_toml() + solid_.after;
}

std::string OneLineWriter::said_roughing() const
{
    if (!choice_.roughs) {
        return !request_.roughing         ? "roughing: none, as requested"
               : choice_.tools.size() > 1 ? "roughing: none, there is nothing above the allowance"
                                          : "roughing: none, the part is no deeper than one cut";
    }
    std::vector<std::string> names;
    for (const NamedTool& tool : choice_.roughing_tools()) {
        names.push_back(words_of(tool, request_.inch));
    }
    return fmt::format("roughing: {}, layers of at most {:.6g} {}{}, leaves {:.6g}{}",
                       fmt::join(names, ", "), choice_.max_depth, choice_.unit,
                       request_.max_depth ? "" : " (half the diameter; --max-depth)",
                       choice_.allowance, request_.allowance ? "" : " (--allowance)");
}

std::vector<std::string> OneLineWriter::said() const
{
    const Vec3d size = choice_.part.size();
    const bool names_unit = std::none_of(request_.parts.begin(), request_.parts.end(), lacks_unit);
    const std::string what = is_pocket() ? "floor" : "part";
    return {fmt::format("{}: {} x {} {} from above, {} deep; {}", what, choice_.words(size.x),
                        choice_.words(size.y), choice_.unit, choice_.words(size.z),
                        names_unit ? "the unit is the file's own"
                                   : fmt::format("the file names no unit, {} is assumed (--units)",
                                                 choice_.unit)),
            fmt::format("stock: x {} to {}, y {} to {}, top z = {}{}; cut down to z = {}",
                        choice_.words(choice_.part.low.x), choice_.words(choice_.part.high.x),
                        choice_.words(choice_.part.low.y), choice_.words(choice_.part.high.y),
                        choice_.words(choice_.top),
                        request_.stock_top ? ""
                        : is_pocket()      ? " (0 or the floor's top; --stock-top)"
                                           : " (the part's; --stock-top)",
                        choice_.words(choice_.part.low.z)),
            said_feeds(request_, all_), said_roughing(),
            fmt::format("finish: {}, {}, scallop {:.6g} {}, tolerance {:.6g}{}, {}",
                        choice_.strategy, words_of(choice_.tools.back(), request_.inch),
                        *request_.scallop, choice_.unit, choice_.tolerance,
                        request_.tolerance ? "" : " (--tolerance)", request_.output)};
}

bool is_mill(const std::string& tool)
{
    return tool.rfind("drill:", 0) != 0 && tool.rfind("vee:", 0) != 0;
}

// Its tools, the drills and vees last.
OneLineRequest with_mills_first(OneLineRequest request)
{
    std::stable_partition(request.tools.begin(), request.tools.end(), is_mill);
    return request;
}

OneLineRequest with_mills_alone(OneLineRequest request)
{
    auto& tools = request.tools;
    tools.erase(std::partition_point(tools.begin(), tools.end(), is_mill), tools.end());
    return request;
}

OneLineJob solid_job(const OneLineRequest& asked,
                     const job::Strategies& strategies,
                     PartFiles& parts)
{
    check_solid_request(asked);
    const OneLineRequest request = with_mills_first(asked);
    const OneLineChoice all = choose_rates(request);
    place_request(request, parts);
    const SolidCuts solid = solid_cuts(request, all, strategies, parts);
    if (solid.is_all) {
        return {head_toml(request, all) +
                    fmt::format("\n[stock]\n{}clearance = {}\n", solid.stock, all.clearance) +
                    placing_toml(request) + solid.before + solid.after,
                solid.said};
    }
    const OneLineRequest mills = with_mills_alone(request);
    const OneLineChoice choice = choose(mills, strategies, parts);
    const OneLineWriter writer{mills, choice, all, solid};
    OneLineJob job{writer.toml(), writer.said()};
    job.said.insert(job.said.end(), solid.said.begin(), solid.said.end());
    return job;
}

}  // namespace

OneLineJob one_line_job(const OneLineRequest& request,
                        const job::Strategies& strategies,
                        PartFiles& parts)
{
    if (is_sheet_request(request)) {
        return sheet_job(request, strategies, parts);
    }
    if (is_solid_request(request)) {
        return solid_job(request, strategies, parts);
    }
    const OneLineChoice choice = choose(request, strategies, parts);
    const SolidCuts none;
    const OneLineWriter writer{request, choice, choice, none};
    return {writer.toml(), writer.said()};
}

}  // namespace cusp::import
