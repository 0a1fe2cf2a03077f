#include "host_tools/job/import/part_geometry_reader.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/cad_surfaces.hpp"
#include "host_tools/job/import/drawing.hpp"
#include "host_tools/job/import/geometry_json.hpp"
#include "host_tools/job/import/loop_nesting.hpp"
#include "host_tools/job/import/mesh_file.hpp"
#include "host_tools/job/import/mesh_holes.hpp"
#include "host_tools/job/import/part_extent.hpp"
#include "host_tools/job/import/part_features.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/import/relief_facets.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::PartGeometry;
using job::PartLayer;
using job::PartUnit;
using nurbs::Curve;
using nurbs::Surface;

namespace {

PartUnit unit_of(double millimetres, bool assumed)
{
    return {millimetres == 1 ? "mm" : "inch", millimetres, assumed};
}

std::string short_name(const std::string& unit)
{
    return unit == "millimetres" ? "mm" : unit == "inches" ? "inch" : unit;
}

void take_extent(PartGeometry& part, const PartExtent& extent)
{
    part.box_low = extent.low;
    part.box_high = extent.high;
}

// Hidden layers count only if there is no other. z stays 0.
void take_box_of_layers(PartGeometry& part)
{
    const bool all_hidden = std::all_of(part.layers.begin(), part.layers.end(),
                                        [](const PartLayer& layer) { return layer.hidden; });
    part.box_low = {kInfinite, kInfinite, 0};
    part.box_high = {-kInfinite, -kInfinite, 0};
    const auto widen = [&part](const auto& chains) {
        for (const auto& chain : chains) {
            for (const Vec2d p : chain.outline) {
                part.box_low.x = std::min(part.box_low.x, p.x);
                part.box_low.y = std::min(part.box_low.y, p.y);
                part.box_high.x = std::max(part.box_high.x, p.x);
                part.box_high.y = std::max(part.box_high.y, p.y);
            }
        }
    };
    for (const PartLayer& layer : part.layers) {
        if (!layer.hidden || all_hidden) {
            widen(layer.loops.loops);
            widen(layer.loops.open);
        }
    }
}

void take_curves(PartGeometry& part, const std::vector<Curve>& curves)
{
    part.layers.push_back({"", false, "", nest_loops(curves, kEndsMeet)});
    take_box_of_layers(part);
    part.box_low.z = kInfinite;
    part.box_high.z = -kInfinite;
    for (const Curve& curve : curves) {
        for (const Vec3d& p : curve.points) {
            part.box_low.z = std::min(part.box_low.z, p.z);
            part.box_high.z = std::max(part.box_high.z, p.z);
        }
    }
}

void take_surfaces(PartGeometry& part, std::vector<Surface> surfaces)
{
    part.surfaces = std::move(surfaces);
    take_extent(part, extent_of_surfaces(part.surfaces));
}

void take_json(PartGeometry& part, const std::string& file, double millimetres)
{
    part.unit = unit_of(millimetres, true);
    auto shapes = read_json_shapes(file, millimetres);
    if (const auto* curves = std::get_if<std::vector<Curve>>(&shapes)) {
        part.format = "JSON curves";
        take_curves(part, *curves);
        return;
    }
    part.format = "JSON surfaces";
    take_surfaces(part, std::move(std::get<std::vector<Surface>>(shapes)));
}

// layer  "": all
void take_drawing(PartGeometry& part,
                  const std::string& file,
                  const std::string& layer,
                  double millimetres)
{
    DrawnLayers drawing = read_drawn_layers(file, millimetres);
    part.format = drawing_format(file);
    part.unit = drawing.unit_name.empty()
                    ? unit_of(drawing.millimetres, true)
                    : PartUnit{short_name(drawing.unit_name), drawing.millimetres, false};
    part.notes = drawing.notes;
    std::string names;
    for (DrawnLayer& drawn : drawing.layers) {
        names += (names.empty() ? "\"" : ", \"") + drawn.name + "\"";
        if (layer.empty() || drawn.name == layer) {
            part.layers.push_back({drawn.name, drawn.hidden, drawn.problem,
                                   nest_loops(drawn.paths, join_limit(drawing.resolution))});
        }
    }
    if (part.layers.empty()) {
        throw InputError(fmt::format("{}: no curve on the layer \"{}\"; layers with curves: {}",
                                     file, layer, names));
    }
    take_box_of_layers(part);
    if (!(part.box_low.x <= part.box_high.x)) {
        throw InputError(part.layers.front().problem);
    }
}

void take_mesh(PartGeometry& part, const std::string& file, double millimetres)
{
    const std::string ending = path_ending(file);
    // A picture has a size in a job alone.
    constexpr ReliefSize kShown{100, -5, 0};
    const bool picture = is_picture_file(file);
    Facets facets =
        read_facets(file, millimetres, {}, picture ? std::optional{kShown} : std::nullopt);
    part.format =
        picture ? "PNG, shown 100 mm wide and 5 mm high: width and heights of [placing] size it"
        : ending == ".stl" ? "STL"
        : ending == ".obj" ? "OBJ"
                           : "3MF";
    part.unit = facets.unit.empty() ? unit_of(millimetres, true) : PartUnit{facets.unit, 0, false};
    part.triangles = std::move(facets.triangles);
    part.degenerate = facets.degenerate;
    part.features = features_of_mesh(part.triangles);
    for (const MeshHole& hole : holes_from_above(part.triangles)) {
        part.holes_above.push_back({hole.middle, hole.size});
    }
    take_extent(part, extent_of_triangles(part.triangles));
}

void take_model(PartGeometry& part, const std::string& file)
{
    const std::string ending = path_ending(file);
    CadModel model = read_whole_cad_model(file);
    part.features = features_of_model(model);
    part.format = ending == ".step" || ending == ".stp"   ? "STEP"
                  : ending == ".iges" || ending == ".igs" ? "IGES"
                                                          : "BREP";
    part.unit = model.unit.empty() ? unit_of(1, true) : PartUnit{model.unit, 0, false};
    part.solids = model.solids;
    part.unread_faces = model.unread;
    part.notes = notes_of(model, file);
    part.outwards = std::move(model.outwards);
    take_surfaces(part, std::move(model.faces));
}

}  // namespace

PartGeometry read_part_geometry(const std::string& name, double millimetres)
{
    const std::size_t mark = layer_mark(name);
    const bool layered = mark != std::string::npos && is_drawing_file(name.substr(0, mark));
    const std::string file = layered ? name.substr(0, mark) : name;
    const std::string ending = path_ending(file);
    PartGeometry part;
    part.file = name;
    if (ending == ".json") {
        take_json(part, file, millimetres);
    } else if (is_mesh_file(file)) {
        take_mesh(part, file, millimetres);
    } else if (is_drawing_file(file)) {
        take_drawing(part, file, layered ? name.substr(mark + 1) : "", millimetres);
    } else if (is_cad_file(file)) {
        take_model(part, file);
    } else {
        throw InputError(fmt::format("{}: parts are read from {}, {}, not from \"{}\"", file,
                                     kDrawingEndings, kPartEndings, ending));
    }
    return part;
}

}  // namespace cusp::import
