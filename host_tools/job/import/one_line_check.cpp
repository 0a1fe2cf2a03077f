// Checks files, then numbers, then tools.
#include "host_tools/job/import/one_line_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/mesh_file.hpp"
#include "host_tools/job/import/one_line_keys.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/job/keys.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

// Refuses the first option that is given for other parts than these.
void refuse_use(const OneLineRequest& request, OneLineUse refused, const char* what)
{
    for (const OneLineKey& key : one_line_keys({})) {
        if (key.use == refused && is_given(request, key)) {
            throw InputError(fmt::format("{}: is for {}", option_of(key), what));
        }
    }
}

void check_range(const char* option, std::optional<double> value, double low, bool above_low)
{
    if (value && !(std::isfinite(*value) && *value <= job::kLargest &&
                   (above_low ? *value > low : *value >= low))) {
        throw InputError(fmt::format("{}: is {:g}, it must be {} {:g} and at most {:g}", option,
                                     *value, above_low ? "above" : "at least", low, job::kLargest));
    }
}

void check_parts(const OneLineRequest& request)
{
    for (const std::string& part : request.parts) {
        if (is_drawing_file(part.substr(0, layer_mark(part)))) {
            throw InputError(fmt::format(
                "{}: a drawing is a boundary, not a part: cusp plan FLOOR.json --boundary {} "
                "... with the surfaces of the floor",
                part, part));
        }
        if (!is_part_file(part)) {
            throw InputError(fmt::format("{}: parts end in {}, jobs in .toml, not in \"{}\"", part,
                                         kPartEndings, path_ending(part)));
        }
    }
    if (!request.islands.empty() && !request.boundary) {
        throw InputError("--island: needs --boundary, the loop round the pocket");
    }
}

void check_numbers(const OneLineRequest& request)
{
    check_range("--scallop", request.scallop, job::kToleranceRange.low, true);
    check_range("--tolerance", request.tolerance, job::kToleranceRange.low, false);
    check_range("--max-depth", request.max_depth, 0, true);
    check_range("--allowance", request.allowance, 0, false);
    check_range("--feed", request.feed, job::kFeedRange.low, false);
    check_range("--plunge-feed", request.plunge_feed, job::kFeedRange.low, false);
    check_range("--spindle", request.spindle, 0, false);
    check_range("--stock-top", request.stock_top, -job::kLargest, false);
    check_range("--clearance", request.clearance, 0, true);
    if (request.tolerance && request.scallop && *request.tolerance >= *request.scallop) {
        throw InputError(
            fmt::format("--tolerance: is {:g}, it must be below the --scallop of "
                        "{:g}, which includes it",
                        *request.tolerance, *request.scallop));
    }
    if (!request.roughing && (request.max_depth || request.allowance)) {
        throw InputError(fmt::format("{}: is for roughing, --no-roughing leaves that out",
                                     request.max_depth ? "--max-depth" : "--allowance"));
    }
}

void check_placing(const OneLineRequest& request)
{
    constexpr double kTurn = 360;  // degrees
    check_range("--width", request.width, job::kToleranceRange.low, false);
    if (request.width.has_value() == request.heights.empty()) {
        throw InputError(fmt::format("{}: a picture needs both --width and --heights BLACK,WHITE",
                                     request.width ? "--width" : "--heights"));
    }
    check_range("--scale", request.scale, job::kScaleRange.low, false);
    const auto check_count = [](const char* option, const char* needed,
                                const std::vector<double>& values, bool also_one) {
        if (!values.empty() && values.size() != 3 && !(also_one && values.size() == 1)) {
            throw InputError(fmt::format("{}: has {} numbers, {}", option, values.size(), needed));
        }
    };
    check_count("--rotate", "degrees about z are needed, or about x, y and z", request.rotate,
                true);
    check_count("--move", "x, y and z are needed", request.move, false);
    const auto check_size = [](const char* option, const std::vector<double>& values,
                               double limit) {
        for (const double value : values) {
            if (!(std::abs(value) <= limit)) {
                throw InputError(
                    fmt::format("{}: is {:g}, the limit is {:g}", option, value, limit));
            }
        }
    };
    check_size("--rotate", request.rotate, kTurn);
    check_size("--move", request.move, job::kLargest);
    check_size("--heights", request.heights, job::kLargest);
}

void check_strategy(const OneLineRequest& request, const job::Strategies& strategies)
{
    const job::Strategy& strategy = strategy_of(request, strategies);
    const bool pocket = strategy.traits.pocket;
    if (pocket && !request.boundary) {
        throw InputError(fmt::format("--strategy {}: needs --boundary, the loop round the pocket",
                                     strategy.name));
    }
    if (!pocket && request.boundary) {
        throw InputError(fmt::format("--boundary: is for pockets, not for {}", strategy.name));
    }
    if (strategy.traits.only_finishes && request.roughing) {
        throw InputError(
            fmt::format("--strategy {}: only finishes: add --no-roughing, or leave --strategy out",
                        strategy.name));
    }
}

}  // namespace

bool is_part_file(const std::string& file)
{
    return is_cad_file(file) || is_mesh_file(file) || path_ending(file) == ".json";
}

const job::Strategy& strategy_of(const OneLineRequest& request, const job::Strategies& strategies)
{
    const auto suits = [&](const job::Strategy* strategy) {
        return strategy->traits.one_line && strategy->traits.pocket == request.boundary.has_value();
    };
    const job::Strategy* const strategy =
        request.strategy.empty() ? *std::find_if(strategies.begin(), strategies.end(), suits)
                                 : find_strategy(strategies, request.strategy);
    if (strategy == nullptr || !strategy->traits.one_line) {
        throw InputError(
            fmt::format("--strategy {}: there is none of that name for parts", request.strategy));
    }
    return *strategy;
}

void check_solid_request(const OneLineRequest& request)
{
    check_parts(request);
    refuse_use(request, OneLineUse::kDrawings,
               "drawings, such as cusp plan plate.dxf --tool flat:3 --depth 6");
    if (request.tools.empty()) {
        throw InputError(
            "--tool: is missing: the tools in the order of their use, such as --tool ball:6 or "
            "--tool flat:8 ball:6");
    }
    check_numbers(request);
    check_placing(request);
}

void check_request(const OneLineRequest& request, const job::Strategies& strategies)
{
    check_solid_request(request);
    if (!request.scallop) {
        throw InputError(
            "--scallop: is missing: the height of the scallops that may remain, such as --scallop "
            "0.02 (mm)");
    }
    check_strategy(request, strategies);
}

void check_sheet_request(const OneLineRequest& request)
{
    const char* const what = "surfaces; a drawing is cut to --depth, and --layer says how";
    refuse_use(request, OneLineUse::kSurfaces, what);
    if (!request.roughing) {
        throw InputError(fmt::format("--no-roughing: is for {}", what));
    }
    if (request.tools.empty()) {
        throw InputError(
            "--tool: is missing: the tools in the order of their use, such as --tool flat:3 or "
            "--tool flat:6 flat:3 drill:5 vee:6:60");
    }
    if (!request.depth) {
        throw InputError(
            "--depth: is missing: how deep outlines are cut below the stock's top, such as --depth "
            "6 (mm)");
    }
    constexpr std::array<const char*, 4> kSides{"", "outside", "inside", "on"};
    if (std::find(kSides.begin(), kSides.end(), request.side) == kSides.end()) {
        throw InputError(
            fmt::format("--side: is \"{}\", it must be outside, inside or on", request.side));
    }
    check_range("--depth", request.depth, 0, true);
    check_range("--join-gaps", request.join_gaps, 0, false);
    check_numbers(request);
    check_placing(request);
}

void check_shapes(const OneLineRequest& request,
                  const std::vector<NamedTool>& tools,
                  const Vec2d& part)
{
    for (std::size_t i = 0; i < tools.size(); ++i) {
        if (tools[i].diameter > std::max(part.x, part.y)) {
            throw InputError(fmt::format(
                "--tool {}: its diameter is {:.6g} {}, the part is only {:.6g} x {:.6g}: give a "
                "smaller tool, or the part's unit by --units",
                request.tools[i], tools[i].diameter, request.inch ? "inch" : "mm", part.x, part.y));
        }
    }
}

void check_tools(const OneLineRequest& request, const std::vector<NamedTool>& tools)
{
    for (std::size_t i = 0; i < tools.size(); ++i) {
        if (tools[i].shape == name_of(toolpath::ToolShape::kVee)) {
            throw InputError(fmt::format(
                "--tool {}: is for drawings, and for edges of one part that a flat end cuts too",
                request.tools[i]));
        }
        if (tools[i].shape == name_of(toolpath::ToolShape::kDrill)) {
            throw InputError(fmt::format(
                "--tool {}: drills holes of one STEP, IGES or BREP part without --boundary",
                request.tools[i]));
        }
    }
    if (!request.roughing && tools.size() > 1) {
        throw InputError(
            fmt::format("--tool {}: only roughs, and --no-roughing leaves that out: "
                        "give one tool, which finishes",
                        request.tools.front()));
    }
    if (request.boundary && tools.size() > 2) {
        throw InputError(
            fmt::format("--tool {}: in a pocket one tool roughs and one finishes: "
                        "give two at most",
                        request.tools[1]));
    }
    // The tools that rough: all but the last one, or that alone.
    const std::size_t rough = tools.size() > 1 ? tools.size() - 1 : request.roughing ? 1 : 0;
    for (std::size_t i = 0; i < rough; ++i) {
        if (tools[i].taper_angle > 0) {
            throw InputError(fmt::format(
                "--tool {}: a taper only finishes: give a flat end, a bull or a ball before it, or "
                "--no-roughing",
                request.tools[i]));
        }
    }
    if (request.boundary && tools.back().taper_angle > 0) {
        throw InputError(fmt::format(
            "--tool {}: a taper finishes whole parts; inside a --boundary a ball, flat or "
            "bull does",
            request.tools.back()));
    }
}

}  // namespace cusp::import
