// The outlines of what is cut become pieces; all else is geometry/nesting.
#include "host_tools/job/import/sheet_nest.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/base/inch.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/geometry/nesting/nesting.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/job/keys.hpp"
#include "host_tools/job/job/loop_shape.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

namespace {

double millimetres(const OneLineRequest& request)
{
    return request.inch ? kMillimetresPerInch : 1.0;
}

void add_outlines(const SheetShapes& place, std::vector<nesting::Polyline>& outlines)
{
    constexpr double kChord = 1e-3;  // mm
    for (const FileLoop& loop : place.shapes.loops) {
        outlines.push_back(job::loop_polyline(loop.loop, kChord));
    }
    for (const job::OpenChain& chain : place.shapes.open) {
        outlines.push_back(job::loop_polyline(chain.pieces, kChord));
        const nurbs::Curve& last = chain.pieces.back();
        outlines.back().back() = in_plan(point_at(last, last.domain_end()));
    }
}

std::vector<nesting::Polyline> outlines_of(const SheetDrawing& drawing)
{
    std::vector<nesting::Polyline> outlines;
    for (const SheetLayer& layer : drawing.named) {
        add_outlines(layer.place, outlines);
    }
    if (drawing.sorted) {
        add_outlines(*drawing.sorted, outlines);
    }
    return outlines;
}

void check_copies(const OneLineRequest& request)
{
    if (request.sheet.empty()) {
        throw InputError(
            fmt::format("{}: needs --sheet, the size of the stock, such as --sheet 600,400",
                        request.copies.empty() ? "--gap" : "--copies"));
    }
    const auto check = [](const char* option, double value, double least, double most) {
        if (!(value >= least && value <= most)) {
            throw InputError(fmt::format("{}: is {:g}, it must be at least {:g} and at most {:g}",
                                         option, value, least, most));
        }
    };
    for (const double side : request.sheet) {
        check("--sheet", side, job::kToleranceRange.low, job::kLargest);
    }
    check("--gap", request.gap.value_or(0), 0, job::kLargest);
    for (const double count : request.copies) {
        check("--copies", count, 1, kMostPlaces);
        if (count != std::floor(count)) {
            throw InputError(fmt::format("--copies: is {:g}, a whole number is needed", count));
        }
    }
    if (request.copies.size() > 1 && request.copies.size() != request.parts.size()) {
        throw InputError(fmt::format(
            "--copies: has {} numbers, 1 for all drawings together or {}, one for each, are needed",
            request.copies.size(), request.parts.size()));
    }
}

}  // namespace

bool asks_for_sheet(const OneLineRequest& request)
{
    return !request.sheet.empty() || !request.copies.empty() || request.gap;
}

double gap_of_copies(const OneLineRequest& request, const OneLineChoice& choice)
{
    constexpr double kOfDiameter = 1.5;
    return millimetres(request) * request.gap.value_or(kOfDiameter * choice.tools.front().diameter);
}

std::vector<NestedFiles> nest_copies(const OneLineRequest& request,
                                     const OneLineChoice& choice,
                                     const std::vector<SheetDrawing>& drawings)
{
    check_copies(request);
    const bool apart = request.copies.size() > 1;
    std::vector<nesting::Piece> pieces(apart ? drawings.size() : 1);
    std::vector<NestedFiles> nested(pieces.size());
    for (std::size_t i = 0; i < drawings.size(); ++i) {
        const std::size_t piece = apart ? i : 0;
        const std::vector<nesting::Polyline> outlines = outlines_of(drawings[i]);
        std::vector<nesting::Polyline>& all = pieces[piece].polylines;
        all.insert(all.end(), outlines.begin(), outlines.end());
        const std::string file = request.parts[i].substr(0, layer_mark(request.parts[i]));
        const auto has = [&](const NestedFiles& other) {
            return std::count(other.files.begin(), other.files.end(), file) > 0;
        };
        if (apart && std::any_of(nested.begin(), nested.end(), has)) {
            throw InputError(
                fmt::format("--copies: {} is named twice: one number of copies is for all "
                            "drawings together",
                            file));
        }
        if (!has(nested[piece])) {
            nested[piece].files.push_back(file);
        }
        pieces[piece].count =
            request.copies.empty() ? 1 : static_cast<int>(request.copies[apart ? i : 0]);
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (pieces[i].polylines.empty()) {
            throw InputError(
                fmt::format("--sheet: {} has no curve that shows how much room it needs",
                            fmt::join(nested[i].files, ", ")));
        }
    }
    const double unit = millimetres(request);
    const auto places = nesting::nest(
        pieces, {unit * Vec2d{request.sheet[0], request.sheet[1]}, gap_of_copies(request, choice)});
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (static_cast<int>(places[i].size()) < pieces[i].count) {
            throw InputError(fmt::format(
                "--copies: is {}, but {} of {} fit on the sheet of {:g} x {:g} {}, {:.6g} apart "
                "(--gap)",
                pieces[i].count, places[i].size(), fmt::join(nested[i].files, ", "),
                request.sheet[0], request.sheet[1], choice.unit,
                gap_of_copies(request, choice) / unit));
        }
        for (const nesting::Place& place : places[i]) {
            nested[i].places.push_back({place.move, place.degrees});
        }
    }
    return nested;
}

std::string said_of_copies(const OneLineRequest& request,
                           const OneLineChoice& choice,
                           const std::vector<NestedFiles>& nested)
{
    std::vector<std::string> counts;
    for (const NestedFiles& each : nested) {
        counts.push_back(fmt::format("{} of {}", each.places.size(), fmt::join(each.files, ", ")));
    }
    return fmt::format("sheet: {:g} x {:g} {}, {:.6g} apart and from its edges{}: {}",
                       request.sheet[0], request.sheet[1], choice.unit,
                       gap_of_copies(request, choice) / millimetres(request),
                       request.gap ? "" : " (--gap)", fmt::join(counts, ", "));
}

}  // namespace cusp::import
