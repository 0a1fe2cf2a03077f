// Layers are told apart by options, then by names; nesting spans the layers that are left.
#include "host_tools/job/import/sheet_drawing.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/drawing.hpp"
#include "host_tools/job/import/loop_nesting.hpp"
#include "host_tools/job/import/nearest_name.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/job/loop_shape.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {
namespace {

// An outline drawn with gaps would be engraved in place of cut out.
void check_nearly_closed(const SheetShapes& place)
{
    constexpr double kTried = 1.0;      // mm
    constexpr double kOfLength = 0.02;  // gaps up to this part of a loop
    std::vector<DrawingPath> paths;
    for (const job::OpenChain& chain : place.shapes.open) {
        paths.push_back({chain.pieces, false});
    }
    const job::LoopNesting closed = nest_loops(paths, kTried);
    for (const job::ClosedLoop& loop : closed.loops) {
        if (closed.widest_gap <= kOfLength * loop.length) {
            throw InputError(
                fmt::format("{}: the loop at x {:.6g} y {:.6g} mm has gaps of up to {:.3g} mm: "
                            "--join-gaps {:.3g} "
                            "closes them; --layer NAME=engrave takes its layer for open lines",
                            place.words, loop.outline.front().x, loop.outline.front().y,
                            closed.widest_gap, 1.01 * closed.widest_gap));
        }
    }
}

class DrawingSorter {
public:
    DrawingSorter(const OneLineRequest& request,
                  const job::Strategies& strategies,
                  double unit,
                  PartFiles& parts)
        : request_{request}, strategies_{strategies}, unit_{unit}, parts_{parts}
    {
        for (const std::string& text : request.layers) {
            uses_.push_back(layer_use_of_text(text, strategies));
        }
    }

    std::vector<SheetDrawing> drawings()
    {
        std::vector<SheetDrawing> all;
        for (const std::string& part : request_.parts) {
            all.push_back(drawing_of(part));
        }
        for (const LayerUse& use : uses_) {
            if (found_.count(use.layer) > 0) {
                continue;
            }
            if (use.region == job::Region::kHoles && all.size() == 1) {  // it may hold points alone
                const std::string name =
                    request_.parts.front().substr(0, layer_mark(request_.parts.front())) + "#" +
                    use.layer;
                all.front().named.push_back({use, {name, {}, name, {}, false}});
            } else {
                throw InputError(fmt::format(
                    "--layer {}: no drawing has a layer of that name with curves; there are "
                    "\"{}\"",
                    use.layer,
                    fmt::join(nearest_names(use.layer, {seen_.begin(), seen_.end()}, 5),
                              "\", \"")));
            }
        }
        find_swapped(all);
        return all;
    }

private:
    SheetDrawing drawing_of(const std::string& part);
    std::optional<LayerUse> use_of(const std::string& layer);
    SheetShapes shapes_of(const std::string& boundary, const std::vector<std::string>& layers);
    void find_swapped(std::vector<SheetDrawing>& all) const;

    const OneLineRequest& request_;
    const job::Strategies& strategies_;
    double unit_;
    PartFiles& parts_;
    std::vector<LayerUse> uses_;
    std::set<std::string> found_;  // layers that an option names
    std::set<std::string> seen_;
};

std::optional<LayerUse> DrawingSorter::use_of(const std::string& layer)
{
    seen_.insert(layer);
    const auto asked = std::find_if(uses_.begin(), uses_.end(),
                                    [&](const LayerUse& use) { return use.layer == layer; });
    if (asked == uses_.end()) {
        return layer_use_of_name(layer, strategies_);
    }
    found_.insert(layer);
    return *asked;
}

SheetShapes DrawingSorter::shapes_of(const std::string& boundary,
                                     const std::vector<std::string>& layers)
{
    constexpr double kPlanTolerance = 0.02;  // mm, that of operations by default
    std::optional<double> join;
    if (request_.join_gaps) {
        join = *request_.join_gaps * unit_;
    }
    SheetShapes out;
    out.boundary = boundary;
    out.layers = layers;
    out.words = boundary;
    if (!layers.empty()) {
        out.words += fmt::format(" {}", fmt::join(layers, ", "));
    }
    out.shapes = parts_.shapes(boundary, layers, unit_, {kPlanTolerance, join});
    return out;
}

SheetDrawing DrawingSorter::drawing_of(const std::string& part)
{
    const std::size_t mark = layer_mark(part);
    const std::string file = part.substr(0, mark);
    SheetDrawing out;
    std::vector<std::string> rest;
    bool apart = mark != std::string::npos;
    bool drawn = false;
    for (const DrawnLayer& layer : read_drawn_layers(file, unit_).layers) {
        if (mark != std::string::npos && part.substr(mark + 1) != layer.name) {
            continue;
        }
        drawn = true;
        const auto use = use_of(layer.name);
        if (layer.hidden && (!use || use->by_name) && mark == std::string::npos) {
            continue;
        }
        apart = apart || use;
        if (!use) {
            rest.push_back(layer.name);
        } else if (use->region) {
            out.named.push_back({*use, shapes_of(file + "#" + layer.name, {})});
        }
    }
    if (mark != std::string::npos && !drawn) {
        shapes_of(part, {});  // refuses a layer that there is not
    }
    if (!rest.empty()) {
        out.sorted = mark != std::string::npos ? shapes_of(part, {})
                     : !apart                  ? shapes_of(file, {})
                     : rest.size() == 1        ? shapes_of(file + "#" + rest.front(), {})
                                               : shapes_of(file, rest);
        check_nearly_closed(*out.sorted);
    }
    return out;
}

// Nesting across drawings: an outline in the outline of another drawing is a hole.
void DrawingSorter::find_swapped(std::vector<SheetDrawing>& all) const
{
    constexpr double kChord = 1e-3;  // mm
    if (all.size() == 1) {
        return;
    }
    std::vector<std::pair<const SheetDrawing*, std::vector<Vec2d>>> outlines;
    for (const SheetDrawing& drawing : all) {
        for (const FileLoop& loop :
             drawing.sorted ? drawing.sorted->shapes.loops : std::vector<FileLoop>{}) {
            outlines.emplace_back(&drawing, job::loop_polyline(loop.loop, kChord));
        }
    }
    const auto around = [&](Vec2d at, const SheetDrawing& own) {
        return std::count_if(outlines.begin(), outlines.end(), [&](const auto& outline) {
            return outline.first != &own && job::encloses(outline.second, at);
        });
    };
    for (SheetDrawing& drawing : all) {
        if (!drawing.sorted) {
            continue;
        }
        std::optional<bool> swapped;
        for (const FileLoop& loop : drawing.sorted->shapes.loops) {
            if (loop.depth > 0) {
                continue;
            }
            const Vec2d at = in_plan(loop.loop.front().points.front());
            const bool inside = around(at, drawing) % 2 == 1;
            if (swapped.value_or(inside) != inside) {
                throw InputError(fmt::format(
                    "{}: the loop at x {:.6g} y {:.6g} mm lies {} an outline of another drawing, "
                    "others do not: --layer NAME=inside or NAME=outside says what they are",
                    drawing.sorted->words, at.x, at.y, inside ? "in" : "beside"));
            }
            swapped = inside;
        }
        drawing.sorted->swapped = swapped.value_or(false);
    }
}

}  // namespace

std::vector<SheetDrawing> sheet_drawings(const OneLineRequest& request,
                                         const job::Strategies& strategies,
                                         double millimetres,
                                         PartFiles& parts)
{
    return DrawingSorter{request, strategies, millimetres, parts}.drawings();
}

}  // namespace cusp::import
