#include "host_tools/job/import/svg_shapes.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/svg_path.hpp"
#include "host_tools/job/import/svg_text.hpp"
#include "host_tools/job/import/svg_transform.hpp"

#include "fmt/format.h"

namespace cusp::import {

using nurbs::Curve;

namespace {

// Lengths of one element.
struct ShapeLengths {
    const pugi::xml_node& node;
    Vec2d viewport;
    const std::string& place;

    double along_x(const char* name) const
    {
        return svg_length_of(node, name, viewport.x, 0, place);
    }
    double along_y(const char* name) const
    {
        return svg_length_of(node, name, viewport.y, 0, place);
    }
    // Per cent of radii are of the mean diagonal.
    double radius(const char* name) const
    {
        return svg_length_of(node, name, elementary::hypot(viewport.x, viewport.y) / std::sqrt(2.0),
                             0, place);
    }
};

Curve ellipse(Vec2d centre, Vec2d radii)
{
    return PlaneMap{{radii.x, 0}, {0, radii.y}, centre}.of(arc_curve({0, 0}, 1, 0, 2 * kPi));
}

void add_line(DrawingPath& path, Vec2d from, Vec2d to)
{
    if (norm(to - from) > 0) {
        path.curves.push_back(line_curve(from, to));
    }
}

DrawingPath rectangle(Vec2d corner, Vec2d size, Vec2d rounding)
{
    DrawingPath path{{}, true};
    const Vec2d r{std::min(rounding.x, size.x / 2), std::min(rounding.y, size.y / 2)};
    const Vec2d far = corner + size;
    const auto round = [&](Vec2d from, Vec2d to) {
        if (r.x > 0 && r.y > 0) {
            path.curves.push_back(elliptic_arc(from, to, r, 0, false, true));
        }
    };
    add_line(path, {corner.x + r.x, corner.y}, {far.x - r.x, corner.y});
    round({far.x - r.x, corner.y}, {far.x, corner.y + r.y});
    add_line(path, {far.x, corner.y + r.y}, {far.x, far.y - r.y});
    round({far.x, far.y - r.y}, {far.x - r.x, far.y});
    add_line(path, {far.x - r.x, far.y}, {corner.x + r.x, far.y});
    round({corner.x + r.x, far.y}, {corner.x, far.y - r.y});
    add_line(path, {corner.x, far.y - r.y}, {corner.x, corner.y + r.y});
    round({corner.x, corner.y + r.y}, {corner.x + r.x, corner.y});
    return path;
}

DrawingPath rectangle_of(const ShapeLengths& of)
{
    const Vec2d size{of.along_x("width"), of.along_y("height")};
    if (!(size.x > 0 && size.y > 0)) {
        return {};
    }
    Vec2d rounding{of.along_x("rx"), of.along_y("ry")};
    // One of both holds for the other, too.
    if (!of.node.attribute("rx")) {
        rounding.x = rounding.y;
    } else if (!of.node.attribute("ry")) {
        rounding.y = rounding.x;
    }
    const bool round = rounding.x > 0 && rounding.y > 0;
    return rectangle({of.along_x("x"), of.along_y("y")}, size, round ? rounding : Vec2d{});
}

DrawingPath polyline(const pugi::xml_node& node, bool closed, const std::string& place)
{
    DrawingPath path{{}, closed};
    SvgText text{node.attribute("points").value()};
    std::vector<Vec2d> points;
    for (text.skip(); !text.at_end(); text.skip()) {
        const auto x = text.number();
        const auto y = text.number();
        if (!x || !y) {
            throw InputError(
                fmt::format("{}: points, character {}: \"{}\": pairs of numbers are needed", place,
                            text.position() + 1, text.rest()));
        }
        points.push_back({*x, *y});
    }
    for (std::size_t k = 1; k < points.size(); ++k) {
        add_line(path, points[k - 1], points[k]);
    }
    if (closed && !points.empty()) {
        add_line(path, points.back(), points.front());
    }
    return path;
}

}  // namespace

std::string svg_name(const pugi::xml_node& node)
{
    const std::string name{node.name()};
    return name.substr(name.find(':') + 1);
}

bool is_svg_shape(const std::string& name)
{
    static constexpr std::array kShapes{"path", "rect",     "circle", "ellipse",
                                        "line", "polyline", "polygon"};
    return std::find(kShapes.begin(), kShapes.end(), name) != kShapes.end();
}

double svg_length_of(const pugi::xml_node& node,
                     const char* attribute,
                     double whole,
                     double otherwise,
                     const std::string& place)
{
    const pugi::xml_attribute given = node.attribute(attribute);
    const std::string_view text{given.value()};
    if (!given || text == "auto") {
        return otherwise;
    }
    const auto length = svg_length(text);
    if (!length) {
        throw InputError(
            fmt::format("{}: {}: \"{}\" is no length: a number with px, mm, cm, in, pt, pc, Q or %",
                        place, attribute, text.substr(0, 40)));
    }
    return length->relative ? length->pixels / 100 * whole : length->pixels;
}

std::vector<DrawingPath> paths_of_shape(const pugi::xml_node& node,
                                        Vec2d viewport,
                                        const std::string& place)
{
    const std::string name = svg_name(node);
    const ShapeLengths of{node, viewport, place};
    if (name == "path") {
        return paths_of_data(node.attribute("d").value(), place);
    }
    DrawingPath path;
    if (name == "rect") {
        path = rectangle_of(of);
    } else if (name == "line") {
        add_line(path, {of.along_x("x1"), of.along_y("y1")}, {of.along_x("x2"), of.along_y("y2")});
    } else if (name == "polyline" || name == "polygon") {
        path = polyline(node, name == "polygon", place);
    } else {
        const bool circle = name == "circle";
        const Vec2d radii = circle ? Vec2d{of.radius("r"), of.radius("r")}
                                   : Vec2d{of.along_x("rx"), of.along_y("ry")};
        if (radii.x > 0 && radii.y > 0) {
            path = {{ellipse({of.along_x("cx"), of.along_y("cy")}, radii)}, true};
        }
    }
    std::vector<DrawingPath> paths;
    if (!path.curves.empty()) {
        paths.push_back(std::move(path));
    }
    return paths;
}

}  // namespace cusp::import
