// Reads each kind of file, then inspects its surfaces or mesh.
#include "host_tools/part_info/part_info.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>
#include <variant>

#include "host_tools/import/cad_surfaces.hpp"
#include "host_tools/import/dxf_curves.hpp"
#include "host_tools/import/geometry_json.hpp"
#include "host_tools/import/mesh_file.hpp"
#include "host_tools/import/part_extent.hpp"
#include "host_tools/import/path_ending.hpp"
#include "host_tools/input_error/input_error.hpp"
#include "host_tools/part_info/mesh_places.hpp"
#include "host_tools/part_info/surface_facets.hpp"

#include "fmt/format.h"

namespace cusp::part_info {

using import::CadModel;
using import::DxfLayer;
using import::DxfLayers;
using import::extent_of_surfaces;
using import::extent_of_triangles;
using import::Facets;
using import::is_cad_file;
using import::is_mesh_file;
using import::nest_loops;
using import::path_ending;
using import::read_cad_model;
using import::read_dxf_layers;
using import::read_facets;
using import::read_json_shapes;
using nurbs::Curve;
using nurbs::Surface;
using part_model::PartModel;

namespace {

// Largest ball that is tried, in diagonals of the part.
constexpr double kLargestBall = 5;
constexpr std::size_t kBallPlaces = 20000;
// Fraction of the tolerance that the facets for trial balls may deviate from the faces.
constexpr double kFacetShare = 0.25;

PartUnit unit_of(double millimetres, bool assumed)
{
    return {millimetres == 1 ? "mm" : "inch", millimetres, assumed};
}

void start_box(PartInfo& info)
{
    info.box_low = {kInfinite, kInfinite, kInfinite};
    info.box_high = {-kInfinite, -kInfinite, -kInfinite};
}

void widen_box(PartInfo& info, Vec3d p)
{
    info.box_low = {std::min(info.box_low.x, p.x), std::min(info.box_low.y, p.y),
                    std::min(info.box_low.z, p.z)};
    info.box_high = {std::max(info.box_high.x, p.x), std::max(info.box_high.y, p.y),
                     std::max(info.box_high.z, p.z)};
}

// Hidden layers count only if there is no other.
void take_box_of_layers(PartInfo& info)
{
    const auto widen = [&info](const auto& chains) {
        for (const auto& chain : chains) {
            for (const Vec2d p : chain.outline) {
                widen_box(info, {p.x, p.y, 0});
            }
        }
    };
    const bool all_hidden = std::all_of(info.layers.begin(), info.layers.end(),
                                        [](const LayerInfo& layer) { return layer.hidden; });
    start_box(info);
    for (const LayerInfo& layer : info.layers) {
        if (!layer.hidden || all_hidden) {
            widen(layer.loops.loops);
            widen(layer.loops.open);
        }
    }
}

void read_curves(PartInfo& info, const std::vector<Curve>& curves)
{
    info.layers.push_back({"", false, "", nest_loops(curves, import::kEndsMeet)});
    take_box_of_layers(info);
    info.box_low.z = kInfinite;
    info.box_high.z = -kInfinite;
    for (const Curve& curve : curves) {
        for (const Vec3d& p : curve.points) {
            info.box_low.z = std::min(info.box_low.z, p.z);
            info.box_high.z = std::max(info.box_high.z, p.z);
        }
    }
}

void read_drawing(PartInfo& info,
                  const std::string& file,
                  const std::string& wanted,
                  double millimetres)
{
    DxfLayers drawing = read_dxf_layers(file, millimetres);
    info.format = "DXF";
    info.unit = unit_of(drawing.millimetres, !drawing.names_unit);
    std::string names;
    for (DxfLayer& layer : drawing.layers) {
        names += (names.empty() ? "\"" : ", \"") + layer.name + "\"";
        if (wanted.empty() || layer.name == wanted) {
            info.layers.push_back(
                {layer.name, layer.hidden, layer.problem, nest_loops(layer.curves)});
        }
    }
    if (info.layers.empty()) {
        throw InputError(fmt::format("{}: no curve on the layer \"{}\"; layers with curves: {}",
                                     file, wanted, names));
    }
    take_box_of_layers(info);
    if (!(info.box_low.x <= info.box_high.x)) {
        throw InputError(info.layers.front().problem);
    }
}

TopOfPart top_of(const PartModel& mesh)
{
    return [&mesh](double x, double y) {
        const auto found = mesh.height_at(x, y);
        return found ? std::optional{found->point.z} : std::nullopt;
    };
}

std::vector<char> hidden_points(const TopOfPart& top, const std::vector<GroundPlace>& places)
{
    std::vector<char> hidden;
    hidden.reserve(places.size());
    for (const GroundPlace& place : places) {
        hidden.push_back(hidden_from_above(top, place) ? 1 : 0);
    }
    return hidden;
}

// An even selection of about `max_count` points that are not hidden.
void add_seen(const std::vector<GroundPlace>& places,
              const std::vector<char>& hidden,
              std::size_t max_count,
              std::vector<GroundPlace>& seen)
{
    const std::size_t step = std::max<std::size_t>(1, places.size() / max_count);
    for (std::size_t k = 0; k < places.size(); k += step) {
        if (hidden[k] == 0) {
            seen.push_back(places[k]);
        }
    }
}

double largest_asked_for(const PartInfo& info)
{
    return kLargestBall * norm(info.box_high - info.box_low);
}

void take_box(PartInfo& info, const import::PartExtent& extent)
{
    info.box_low = extent.low;
    info.box_high = extent.high;
}

void inspect_surfaces(PartInfo& info, const std::vector<double>& outwards, double tolerance)
{
    info.pieces = info.surfaces.size();
    const SurfacePlaces found = surface_places(info.surfaces, outwards);
    take_box(info, extent_of_surfaces(info.surfaces));
    const SurfaceFacets facets = surface_facets(info.surfaces, kFacetShare * tolerance);
    const PartModel model{facets.triangles};
    const std::vector<char> hidden = hidden_points(top_of(model), found.places);
    info.ground = ground_of(found.places, hidden, info.box_low.z);
    info.hollow = smallest_hollow(info.surfaces, found, hidden);
    std::vector<GroundPlace> seen;
    if (info.hollow) {
        seen.push_back(info.hollow->place);
    }
    add_seen(found.places, hidden, kBallPlaces, seen);
    info.ball = largest_ball(model, seen, std::max(tolerance, facets.tolerance / kFacetShare),
                             facets.tolerance, facets.triangles.size(), largest_asked_for(info));
}

void inspect_mesh(PartInfo& info, double tolerance)
{
    info.pieces = info.triangles.size();
    take_box(info, extent_of_triangles(info.triangles));
    std::vector<GroundPlace> places;
    std::vector<GroundPlace> creases;
    {
        const WeldedMesh mesh = weld(info.triangles);
        info.mesh = mesh.health;
        places = facet_places(mesh);
        creases = crease_places(mesh, kBallPlaces);
    }
    const PartModel model{info.triangles};
    const TopOfPart top = top_of(model);
    const std::vector<char> hidden = hidden_points(top, places);
    info.ground = ground_of(places, hidden, info.box_low.z);
    std::vector<GroundPlace> seen;
    add_seen(creases, hidden_points(top, creases), 2 * kBallPlaces, seen);
    add_seen(places, hidden, kBallPlaces, seen);
    info.ball = largest_ball(model, seen, tolerance, 0, info.pieces, largest_asked_for(info));
}

void read_json(PartInfo& info, const std::string& file, const InspectSettings& settings)
{
    info.unit = unit_of(settings.millimetres, true);
    auto shapes = read_json_shapes(file, settings.millimetres);
    if (const auto* curves = std::get_if<std::vector<Curve>>(&shapes)) {
        info.format = "JSON curves";
        read_curves(info, *curves);
        return;
    }
    info.format = "JSON surfaces";
    info.surfaces = std::move(std::get<std::vector<Surface>>(shapes));
    inspect_surfaces(info, {}, settings.tolerance);
}

void read_mesh_file(PartInfo& info, const std::string& file, const InspectSettings& settings)
{
    Facets facets = read_facets(file, settings.millimetres);
    info.format = path_ending(file) == ".stl" ? "STL" : path_ending(file) == ".obj" ? "OBJ" : "3MF";
    info.unit =
        facets.unit.empty() ? unit_of(settings.millimetres, true) : PartUnit{facets.unit, 0, false};
    info.triangles = std::move(facets.triangles);
    info.degenerate = facets.degenerate;
    inspect_mesh(info, settings.tolerance);
}

void read_cad(PartInfo& info, const std::string& file, double tolerance)
{
    const std::string ending = path_ending(file);
    CadModel model = read_cad_model(file);
    info.format = ending == ".step" || ending == ".stp"   ? "STEP"
                  : ending == ".iges" || ending == ".igs" ? "IGES"
                                                          : "BREP";
    info.unit = model.unit.empty() ? unit_of(1, true) : PartUnit{model.unit, 0, false};
    info.solids = model.solids;
    info.unread_faces = model.unread;
    info.surfaces = std::move(model.faces);
    inspect_surfaces(info, model.outwards, tolerance);
}

}  // namespace

PartInfo inspect_part(const std::string& name, const InspectSettings& settings)
{
    const std::size_t mark = name.rfind('#');
    const bool layered = mark != std::string::npos && path_ending(name.substr(0, mark)) == ".dxf";
    const std::string file = layered ? name.substr(0, mark) : name;
    const std::string ending = path_ending(file);
    PartInfo info;
    info.file = name;
    if (ending == ".json") {
        read_json(info, file, settings);
    } else if (is_mesh_file(file)) {
        read_mesh_file(info, file, settings);
    } else if (ending == ".dxf") {
        read_drawing(info, file, layered ? name.substr(mark + 1) : "", settings.millimetres);
    } else if (is_cad_file(file)) {
        read_cad(info, file, settings.tolerance);
    } else {
        throw InputError(fmt::format("{}: parts are read from .dxf, {}, not from \"{}\"", file,
                                     import::kPartEndings, ending));
    }
    return info;
}

}  // namespace cusp::part_info
