// The cuts of the drawings, under the tools and the stock.
#include "host_tools/job/import/sheet_job.hpp"

#include <algorithm>

#include "firmware/base/inch.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/one_line_check.hpp"
#include "host_tools/job/import/one_line_text.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/import/sheet_cuts.hpp"
#include "host_tools/job/import/sheet_drawing.hpp"
#include "host_tools/job/import/sheet_nest.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

namespace {

std::vector<NestedFiles> copy_drawings(const OneLineRequest& request,
                                       const OneLineChoice& choice,
                                       const job::Strategies& strategies,
                                       PartFiles& parts)
{
    if (!asks_for_sheet(request)) {
        return {};
    }
    const double unit = request.inch ? kMillimetresPerInch : 1.0;
    const std::vector<NestedFiles> copied =
        nest_copies(request, choice, sheet_drawings(request, strategies, unit, parts));
    for (const NestedFiles& each : copied) {
        for (const std::string& file : each.files) {
            parts.copy(file, moves_of(each.places));
        }
    }
    parts.finish_placing();
    return copied;
}

// Keys of [stock].
std::string sheet_toml(const OneLineRequest& request)
{
    return request.sheet.empty()
               ? ""
               : fmt::format("x = [0, {}]\ny = [0, {}]\n", request.sheet[0], request.sheet[1]);
}

}  // namespace

bool is_drawing_name(const std::string& name)
{
    return is_drawing_file(name.substr(0, layer_mark(name)));
}

bool is_sheet_request(const OneLineRequest& request)
{
    return !request.parts.empty() &&
           std::all_of(request.parts.begin(), request.parts.end(), is_drawing_name);
}

OneLineJob sheet_job(const OneLineRequest& request,
                     const job::Strategies& strategies,
                     PartFiles& parts)
{
    check_sheet_request(request);
    const OneLineChoice choice = choose_rates(request);
    place_request(request, parts);
    const std::vector<NestedFiles> copied = copy_drawings(request, choice, strategies, parts);
    const double top = request.stock_top.value_or(0.0);
    OneLineJob job;
    job.toml = head_toml(request, choice) +
               fmt::format("\n[stock]\ntop = {}\nbottom = {}\nclearance = {}\n", top,
                           top - *request.depth, choice.clearance) +
               sheet_toml(request) + placing_toml(request, copied);
    job.said.push_back(fmt::format("stock: top z = {:.6g} {}{}, {:.6g} thick (--depth)", top,
                                   choice.unit, request.stock_top ? "" : " (--stock-top)",
                                   *request.depth));
    if (!copied.empty()) {
        job.said.push_back(said_of_copies(request, choice, copied));
    }
    job.said.push_back(said_feeds(request, choice));
    bool cuts_something = false;
    for (const SheetCut& cut : sheet_cuts(request, choice, strategies, parts)) {
        job.toml += cut.toml;
        job.said.push_back(cut.said);
        cuts_something = cuts_something || !cut.toml.empty();
    }
    if (!cuts_something) {
        throw InputError(
            fmt::format("{}: nothing to cut: all layers are left out: --layer "
                        "NAME=OPERATION takes one",
                        fmt::join(request.parts, ", ")));
    }
    return job;
}

}  // namespace cusp::import
