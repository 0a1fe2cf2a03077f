// Reads {"shape": {"type": "surface" or "curve", "count": n, "data": [...]}}.
#include "host_tools/job/import/geometry_json.hpp"

#include <cmath>
#include <string_view>

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/json_text/json_text.hpp"
#include "host_tools/geometry/nurbs/knot_insertion.hpp"
#include "host_tools/job/import/nurbs_validity.hpp"
#include "host_tools/job/import/trim_loops.hpp"

#include "fmt/format.h"
#include "nlohmann/json.hpp"

namespace cusp::import {

using nurbs::Curve;
using nurbs::Surface;

namespace {

using Json = nlohmann::json;

const Json& member(const Json& object, const char* key, const std::string& place)
{
    if (!object.is_object() || !object.contains(key)) {
        throw InputError(fmt::format("{}: \"{}\" is missing", place, key));
    }
    return object.at(key);
}

double number(const Json& value, const std::string& place)
{
    if (!value.is_number()) {
        throw InputError(fmt::format("{}: {} is not a number", place, json_text::written(value)));
    }
    return value.get<double>();
}

int whole_number(const Json& object, const char* key, const std::string& place)
{
    constexpr double kMost = 1e6;
    const double value = number(member(object, key, place), fmt::format("{}: {}", place, key));
    if (value != std::floor(value) || std::abs(value) > kMost) {
        throw InputError(fmt::format("{}: {} is {}, a whole number up to {:g} is needed", place,
                                     key, value, kMost));
    }
    return static_cast<int>(value);
}

const Json& list(const Json& object, const char* key, const std::string& place)
{
    const Json& value = member(object, key, place);
    if (!value.is_array()) {
        throw InputError(fmt::format("{}: \"{}\" is not a list", place, key));
    }
    return value;
}

std::vector<double> numbers(const Json& object, const char* key, const std::string& place)
{
    std::vector<double> out;
    for (const Json& value : list(object, key, place)) {
        out.push_back(number(value, fmt::format("{}: {}[{}]", place, key, out.size())));
    }
    return out;
}

// Points of 2 or 3 coordinates, the same number in all; absent weights are 1.
void read_control_points(const Json& shape,
                         double millimetres,
                         const std::string& place,
                         std::vector<Vec3d>& points,
                         std::vector<double>& weights)
{
    const Json& control = member(shape, "control_points", place);
    const Json& listed = list(control, "points", place);
    for (const Json& point : listed) {
        const std::string where = fmt::format("{}: control point {}", place, points.size());
        if (!point.is_array() || (point.size() != 2 && point.size() != 3)) {
            throw InputError(where + " has not 2 or 3 coordinates");
        }
        if (point.size() != listed[0].size()) {
            throw InputError(fmt::format("{} has {} coordinates, control point 0 has {}", where,
                                         point.size(), listed[0].size()));
        }
        const double z = point.size() == 3 ? number(point[2], where) : 0;
        points.push_back(millimetres * Vec3d{number(point[0], where), number(point[1], where), z});
    }
    if (control.contains("weights") && !control.at("weights").is_null()) {
        weights = numbers(control, "weights", place);
    } else {
        weights.assign(points.size(), 1.0);
    }
}

Curve read_curve(const Json& shape, double millimetres, const std::string& place)
{
    Curve curve;
    curve.degree = whole_number(shape, "degree", place);
    curve.knots = numbers(shape, "knotvector", place);
    merge_close_knots(curve.knots);
    read_control_points(shape, millimetres, place, curve.points, curve.weights);
    check_curve(curve, place);
    return clamped(curve);
}

std::string trim_type(const Json& trim)
{
    if (!trim.is_object() || (trim.contains("type") && !trim.at("type").is_string())) {
        return "";
    }
    return trim.value("type", "spline");
}

void add_spline(const Json& trim, const std::string& place, std::vector<Curve>& curves)
{
    if (const std::string type = trim_type(trim); type != "spline") {
        throw InputError(
            fmt::format("{}: a trim of type \"{}\"; \"spline\" and, around splines, "
                        "\"container\" are known",
                        place, type));
    }
    const Curve curve = read_curve(trim, 1.0, place);
    const bool turned = trim.contains("reversed") && whole_number(trim, "reversed", place) != 0;
    curves.push_back(turned ? reversed(curve) : curve);
}

void add_trim(const Json& trim, const std::string& place, std::vector<Curve>& curves)
{
    if (trim_type(trim) != "container") {
        add_spline(trim, place, curves);
        return;
    }
    for (const Json& part : list(trim, "data", place)) {
        add_spline(part, place, curves);
    }
}

void read_trims(const Json& shape, const std::string& place, Surface& surface)
{
    if (!shape.contains("trims") || shape.at("trims").is_null()) {
        return;
    }
    const Json& trims = shape.at("trims");
    if (trims.is_object() && trims.contains("count") && trims.at("count") == 0) {
        return;
    }
    const Json& data = list(trims, "data", place + ": trims");
    if (trims.contains("count") &&
        whole_number(trims, "count", place + ": trims") != static_cast<int>(data.size())) {
        throw InputError(fmt::format("{}: trims: count is {}, data holds {}", place,
                                     json_text::written(trims.at("count")), data.size()));
    }
    std::vector<Curve> curves;
    for (const Json& trim : data) {
        add_trim(trim, fmt::format("{}: trim {}", place, curves.size() + 1), curves);
    }
    surface.trims = trim_loops(curves, surface, place);
}

Surface read_surface(const Json& shape, double millimetres, const std::string& place)
{
    Surface surface;
    surface.degree_u = whole_number(shape, "degree_u", place);
    surface.degree_v = whole_number(shape, "degree_v", place);
    surface.size_u = whole_number(shape, "size_u", place);
    surface.size_v = whole_number(shape, "size_v", place);
    surface.knots_u = numbers(shape, "knotvector_u", place);
    surface.knots_v = numbers(shape, "knotvector_v", place);
    merge_close_knots(surface.knots_u);
    merge_close_knots(surface.knots_v);
    read_control_points(shape, millimetres, place, surface.points, surface.weights);
    check_surface(surface, place);
    surface = clamped(surface);
    read_trims(shape, place, surface);
    return surface;
}

Json parsed(const std::string& file)
{
    try {
        return Json::parse(files::text_of_file(file));
    } catch (const Json::exception& error) {
        // After "[json.exception.parse_error.101] ".
        const std::string_view said = error.what();
        throw InputError(fmt::format("{}: not JSON: {}", file, said.substr(said.find("] ") + 2)));
    }
}

// Calls read(data[i], place) for each shape of the document.
template <class Read>
void for_each_shape(const Json& document, const std::string& file, const char* type, Read read)
{
    const Json& shape = member(document, "shape", file);
    const Json& found = member(shape, "type", file);
    if (found != type) {
        throw InputError(fmt::format("{}: type is {}, here a \"{}\" is needed", file,
                                     json_text::written(found), type));
    }
    const Json& data = list(shape, "data", file);
    if (shape.contains("count") &&
        whole_number(shape, "count", file) != static_cast<int>(data.size())) {
        throw InputError(fmt::format("{}: count is {}, data holds {}", file,
                                     json_text::written(shape.at("count")), data.size()));
    }
    if (data.empty()) {
        throw InputError(fmt::format("{}: holds no {}", file, type));
    }
    for (std::size_t i = 0; i < data.size(); ++i) {
        read(data[i], fmt::format("{}: {} {}", file, type, i + 1));
    }
}

std::vector<Surface> surfaces_of(const Json& document, const std::string& file, double millimetres)
{
    std::vector<Surface> surfaces;
    for_each_shape(document, file, "surface", [&](const Json& shape, const std::string& place) {
        surfaces.push_back(read_surface(shape, millimetres, place));
    });
    return surfaces;
}

std::vector<Curve> curves_of(const Json& document, const std::string& file, double millimetres)
{
    std::vector<Curve> curves;
    for_each_shape(document, file, "curve", [&](const Json& shape, const std::string& place) {
        curves.push_back(read_curve(shape, millimetres, place));
    });
    return curves;
}

}  // namespace

std::vector<Surface> read_json_surfaces(const std::string& file, double millimetres)
{
    return surfaces_of(parsed(file), file, millimetres);
}

std::vector<Curve> read_json_curves(const std::string& file, double millimetres)
{
    return curves_of(parsed(file), file, millimetres);
}

std::variant<std::vector<Surface>, std::vector<Curve>> read_json_shapes(const std::string& file,
                                                                        double millimetres)
{
    const Json document = parsed(file);
    const Json& type = member(member(document, "shape", file), "type", file);
    if (type == "curve") {
        return curves_of(document, file, millimetres);
    }
    return surfaces_of(document, file, millimetres);
}

}  // namespace cusp::import
