// Loops of a drawing with their nesting; a JSON file holds one loop.
#include "host_tools/job/import/file_loops.hpp"

#include <algorithm>
#include <utility>

#include "host_tools/base/input_error/counted.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/drawing.hpp"
#include "host_tools/job/import/geometry_json.hpp"
#include "host_tools/job/import/loop_nesting.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/job/loop_shape.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

using job::closed_loop;
using job::ClosedLoop;
using job::lies_outside;
using job::loop_polyline;
using job::LoopNesting;
using job::OpenChain;
using job::Operation;

namespace {

[[noreturn]] void refuse_open(const std::string& name, const LoopNesting& nesting, double join)
{
    const OpenChain& chain = nesting.open.front();
    const auto others = nesting.open.size() - 1;
    std::string text = fmt::format(
        "{}: the loop is open: {} from x {:.6g} y {:.6g} to x {:.6g} y {:.6g} mm; the gap "
        "from x {:.6g} y {:.6g} to the nearest end, x {:.6g} y {:.6g}, is {:.6g} mm, the limit is "
        "{:g} mm: join_gaps of the operation closes wider ones",
        name, counted(chain.curves, "curve"), chain.begin.x, chain.begin.y, chain.end.x,
        chain.end.y, chain.gap_from.x, chain.gap_from.y, chain.gap_to.x, chain.gap_to.y, chain.gap,
        join);
    if (nesting.junction) {
        text += fmt::format(
            "; {} ends meet at x {:.6g} y {:.6g} mm, where more than one way "
            "continues: closed polylines stay apart there",
            nesting.junction_ends, nesting.junction->x, nesting.junction->y);
    }
    if (others > 0) {
        text += fmt::format("; {}: cusp info lists all", counted(others, "more open chain"));
    }
    throw InputError(text);
}

void describe_loops(const std::string& name,
                    const LoopNesting& nesting,
                    double join,
                    std::vector<std::string>& notes)
{
    if (nesting.repeated > 0) {
        notes.push_back(repeats_text(name, nesting.repeated));
    }
    if (nesting.bridged > 0) {
        notes.push_back(fmt::format(
            "{}: {} {:.3g} mm {} joined; the limit is {:g} mm (join_gaps)", name,
            nesting.bridged == 1 ? "a gap of" : fmt::format("{} gaps of up to", nesting.bridged),
            nesting.widest_gap, nesting.bridged == 1 ? "is" : "are", join));
    }
}

// The paths of several layers, in the order of their names.
DrawnPaths paths_of_layers(const std::string& file,
                           const std::vector<std::string>& layers,
                           double millimetres,
                           std::vector<std::string>& notes)
{
    DrawnLayers drawing = read_drawn_layers(file, millimetres);
    notes.insert(notes.end(), drawing.notes.begin(), drawing.notes.end());
    DrawnPaths out{{}, drawing.resolution};
    for (const std::string& wanted : layers) {
        const auto found = std::find_if(drawing.layers.begin(), drawing.layers.end(),
                                        [&](const DrawnLayer& one) { return one.name == wanted; });
        if (found == drawing.layers.end()) {
            std::vector<std::string> names;
            for (const DrawnLayer& one : drawing.layers) {
                names.push_back(one.name);
            }
            throw InputError(
                fmt::format("{}: no curve on the layer \"{}\"; layers with curves: "
                            "\"{}\"",
                            file, wanted, fmt::join(names, "\", \"")));
        }
        if (!found->problem.empty()) {
            throw InputError(found->problem);
        }
        out.paths.insert(out.paths.end(), found->paths.begin(), found->paths.end());
    }
    return out;
}

// layers  empty: what `name` says
DrawnPaths drawn_paths(const std::string& name,
                       const std::vector<std::string>& layers,
                       double millimetres,
                       std::vector<std::string>& notes)
{
    const std::size_t mark = layer_mark(name);
    const std::string file = name.substr(0, mark);
    const std::string layer = mark == std::string::npos ? "" : name.substr(mark + 1);
    return layers.empty() ? read_drawn_paths(file, millimetres, layer, &notes)
                          : paths_of_layers(file, layers, millimetres, notes);
}

struct NestedDrawing {
    LoopNesting nesting;
    double join;  // mm
};

NestedDrawing nested_drawing(const DrawnPaths& drawn, EndDistance gaps)
{
    const double join = gaps.given ? std::max(*gaps.given, kEndsMeet)
                                   : std::max(gaps.least, join_limit(drawn.resolution));
    return {nest_loops(drawn.paths, join), join};
}

std::vector<FileLoop> named_loops(const std::string& name,
                                  const NestedDrawing& drawn,
                                  std::vector<std::string>& notes)
{
    const auto& [nesting, join] = drawn;
    if (nesting.crossing) {
        throw InputError(fmt::format("{}: its loops cross each other at x {:.6g} y {:.6g} mm", name,
                                     nesting.crossing->x, nesting.crossing->y));
    }
    describe_loops(name, nesting, join, notes);
    std::vector<FileLoop> out;
    for (const ClosedLoop& loop : nesting.loops) {
        const std::string place =
            nesting.loops.size() == 1
                ? name
                : fmt::format("{}: loop {} of {}, at x {:.6g} y {:.6g} mm", name, out.size() + 1,
                              nesting.loops.size(), loop.outline.front().x, loop.outline.front().y);
        out.push_back({closed_loop(loop.curves, place, join), place, loop.parent, loop.depth});
    }
    return out;
}

// True if the name is that of a drawing, in which "#layer" may follow the file.
bool names_drawing(const std::string& name)
{
    return is_drawing_file(name.substr(0, layer_mark(name)));
}

}  // namespace

std::vector<FileLoop> loops_of(const std::string& name,
                               const DrawnPaths& drawn,
                               EndDistance gaps,
                               std::vector<std::string>& notes)
{
    const NestedDrawing nested = nested_drawing(drawn, gaps);
    if (!nested.nesting.open.empty()) {
        refuse_open(name, nested.nesting, nested.join);
    }
    return named_loops(name, nested, notes);
}

FileShapes shapes_of(const std::string& name,
                     const DrawnPaths& drawn,
                     EndDistance gaps,
                     std::vector<std::string>& notes)
{
    const NestedDrawing nested = nested_drawing(drawn, gaps);
    return {named_loops(name, nested, notes), nested.nesting.open};
}

std::vector<FileLoop> read_loops(const std::string& name,
                                 double millimetres,
                                 EndDistance gaps,
                                 std::vector<std::string>& notes)
{
    if (names_drawing(name)) {
        return loops_of(name, drawn_paths(name, {}, millimetres, notes), gaps, notes);
    }
    if (path_ending(name) == ".json") {
        return {{closed_loop(read_json_curves(name, millimetres), name), name}};
    }
    throw InputError(fmt::format("{}: loops are read from .json, {}, not from \"{}\"", name,
                                 kDrawingEndings, path_ending(name)));
}

FileShapes read_shapes(const std::string& name,
                       const std::vector<std::string>& layers,
                       double millimetres,
                       EndDistance gaps,
                       std::vector<std::string>& notes)
{
    if (!names_drawing(name)) {
        return {read_loops(name, millimetres, gaps, notes), {}};
    }
    return shapes_of(name, drawn_paths(name, layers, millimetres, notes), gaps, notes);
}

std::vector<Operation> pockets_of(const Operation& operation,
                                  const std::vector<FileLoop>& loops,
                                  const std::vector<FileLoop>& more_islands)
{
    constexpr double kChord = 1e-3;  // mm
    std::vector<Operation> pockets;
    std::vector<std::size_t> bounds;  // of each pocket, its loop
    for (std::size_t k = 0; k < loops.size(); ++k) {
        if (loops[k].depth % 2 == 0) {
            pockets.push_back(operation);
            pockets.back().outline.boundary = loops[k].loop;
            pockets.back().outline.boundary_file = loops[k].name;
            bounds.push_back(k);
        }
    }
    if (pockets.empty()) {
        throw InputError(operation.outline.boundary_file + ": except_diameters leaves no loop");
    }
    const auto add = [](Operation& pocket, const FileLoop& island) {
        pocket.outline.islands.push_back(island.loop);
        pocket.outline.island_files.push_back(island.name);
    };
    for (const FileLoop& loop : loops) {
        if (loop.depth % 2 == 1) {
            const auto bound =
                std::find(bounds.begin(), bounds.end(), static_cast<std::size_t>(loop.parent));
            add(pockets[static_cast<std::size_t>(bound - bounds.begin())], loop);
        }
    }
    for (const FileLoop& island : more_islands) {
        const auto outline = loop_polyline(island.loop, kChord);
        // smallest pocket first; of a single pocket check_operation() checks the islands
        const auto around = std::find_if(pockets.rbegin(), pockets.rend(), [&](const Operation& o) {
            return pockets.size() == 1 ||
                   !lies_outside(outline, loop_polyline(*o.outline.boundary, kChord));
        });
        if (around == pockets.rend()) {
            throw InputError(
                fmt::format("{}: the island lies outside all {} pockets of {}, at x "
                            "{:.6g} y {:.6g} mm",
                            island.name, pockets.size(), operation.outline.boundary_file,
                            outline.front().x, outline.front().y));
        }
        add(*around, island);
    }
    return pockets;
}

}  // namespace cusp::import
