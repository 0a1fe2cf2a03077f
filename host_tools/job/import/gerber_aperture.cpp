// A macro's primitives are laid over each other in order; those that are not exposed are taken away.
#include "host_tools/job/import/gerber_aperture.hpp"

#include <cmath>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/number_text/number_text.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"
#include "host_tools/job/import/gerber_expression.hpp"
#include "host_tools/job/import/gerber_shapes.hpp"
#include "host_tools/job/import/svg_transform.hpp"

#include "fmt/format.h"

namespace cusp::import {

using offset::Contour;
using offset::Region2d;

namespace {

constexpr double kLargestAperture = 1e4;  // mm
constexpr int kMostCorners = 10000;

std::vector<std::string_view> split_at(std::string_view text, char mark)
{
    std::vector<std::string_view> fields;
    while (true) {
        const std::size_t end = text.find(mark);
        fields.push_back(text.substr(0, end));
        if (end == std::string_view::npos) {
            return fields;
        }
        text.remove_prefix(end + 1);
    }
}

// One aperture's parameters, or those of one primitive.
class ApertureReader {
public:
    ApertureReader(std::string name,
                   std::vector<double> values,
                   double unit,
                   const std::string& place)
        : name_{std::move(name)}, values_{std::move(values)}, unit_{unit}, place_{place}
    {
    }

    [[noreturn]] void refuse(const std::string& what) const
    {
        throw InputError(fmt::format("{}: aperture {}: {}", place_, name_, what));
    }
    bool has(std::size_t k) const { return k < values_.size(); }
    std::size_t count() const { return values_.size(); }
    double value(std::size_t k, const char* what) const
    {
        if (!has(k)) {
            refuse(fmt::format("{} is missing", what));
        }
        return values_[k];
    }
    double coordinate(std::size_t k, const char* what) const
    {
        const double mm = value(k, what) * unit_;
        if (!(std::fabs(mm) <= kLargestAperture)) {
            refuse(fmt::format("{} is {:g} mm: at most {:g}", what, mm, kLargestAperture));
        }
        return mm;
    }
    double size(std::size_t k, const char* what) const
    {
        const double mm = coordinate(k, what);
        if (mm < 0) {
            refuse(fmt::format("{} is {:g} mm: below 0", what, mm));
        }
        return mm;
    }
    Vec2d point(std::size_t k) const { return {coordinate(k, "x"), coordinate(k + 1, "y")}; }
    double angle(std::size_t k) const { return has(k) ? values_[k] * kPi / 180 : 0.0; }
    int whole(std::size_t k, const char* what, int least, int most) const
    {
        const double number = value(k, what);
        if (!(number >= least && number <= most) || number != std::floor(number)) {
            refuse(
                fmt::format("{} is {:g}: a whole number from {} to {}", what, number, least, most));
        }
        return static_cast<int>(number);
    }

private:
    std::string name_;
    std::vector<double> values_;
    double unit_;
    const std::string& place_;
};

PlaneMap turned_by(double angle)
{
    return {{elementary::cos(angle), elementary::sin(angle)},
            {-elementary::sin(angle), elementary::cos(angle)},
            {}};
}

Contour regular_polygon(Vec2d centre, int corners, double diameter, double angle)
{
    std::vector<Vec2d> points;
    for (int k = 0; k < corners; ++k) {
        const double at = angle + 2 * kPi * k / corners;
        points.push_back(centre + Vec2d{elementary::cos(at), elementary::sin(at)} * (diameter / 2));
    }
    return polygon_contour(std::move(points));
}

Region2d region_of(const Contour& contour)
{
    return contour.empty() ? Region2d{} : Region2d{{contour}};
}

Region2d disc(Vec2d centre, double diameter)
{
    return diameter > 0 ? region_of(circle_contour(centre, diameter / 2)) : Region2d{};
}

Region2d thermal(const ApertureReader& p)
{
    const Vec2d centre = p.point(0);
    const double outer = p.size(2, "outer diameter");
    const double inner = p.size(3, "inner diameter");
    const double gap = p.size(4, "gap");
    Region2d ring = without(disc(centre, outer), disc(centre, inner));
    if (gap > 0) {
        Region2d cross;
        cross.contours = {rectangle_contour(centre, 2 * outer, gap),
                          rectangle_contour(centre, gap, 2 * outer)};
        ring = without(ring, cross);
    }
    return mapped(turned_by(p.angle(5)), ring);
}

Region2d outline_primitive(const ApertureReader& p)
{
    const int count = p.whole(1, "the number of corners", 1, kMostCorners);
    std::vector<Vec2d> points;
    for (int k = 0; k < count; ++k) {
        points.push_back(p.point(2 + 2 * static_cast<std::size_t>(k)));
    }
    const std::size_t end = 4 + 2 * static_cast<std::size_t>(count);
    return mapped(turned_by(p.angle(end)),
                  offset::united(region_of(polygon_contour(std::move(points))), {}));
}

Region2d vector_line(const ApertureReader& p)
{
    const double width = p.size(1, "width");
    const Vec2d from = p.point(2);
    const Vec2d to = p.point(4);
    const Vec2d beside = offset::left_normal(offset::unit(to - from)) * (width / 2);
    return mapped(
        turned_by(p.angle(6)),
        region_of(polygon_contour({from - beside, to - beside, to + beside, from + beside})));
}

// The region of a primitive, and whether it is exposed.
std::pair<Region2d, bool> primitive_of(int code, const ApertureReader& p)
{
    if (code == 7) {
        return {thermal(p), true};
    }
    const bool exposed = p.whole(0, "exposure", 0, 1) == 1;
    switch (code) {
        case 1:
            return {mapped(turned_by(p.angle(4)), disc(p.point(2), p.size(1, "diameter"))),
                    exposed};
        case 2:
        case 20:
            return {vector_line(p), exposed};
        case 4:
            return {outline_primitive(p), exposed};
        case 5:
            return {mapped(turned_by(p.angle(5)),
                           region_of(regular_polygon(p.point(2),
                                                     p.whole(1, "the number of corners", 3, 12),
                                                     p.size(4, "diameter"), 0))),
                    exposed};
        case 21:
            return {mapped(turned_by(p.angle(5)),
                           region_of(rectangle_contour(p.point(3), p.size(1, "width"),
                                                       p.size(2, "height")))),
                    exposed};
        case 22: {
            const Vec2d size{p.size(1, "width"), p.size(2, "height")};
            return {mapped(turned_by(p.angle(5)),
                           region_of(rectangle_contour(p.point(3) + 0.5 * size, size.x, size.y))),
                    exposed};
        }
        default:
            p.refuse(fmt::format("primitive {} is none of 1, 2, 4, 5, 7, 20, 21, 22", code));
    }
}

Region2d macro_region(const std::string& name,
                      const std::vector<std::string>& words,
                      const std::vector<double>& parameters,
                      double unit,
                      const std::string& place)
{
    GerberVariables variables;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        variables[static_cast<int>(k) + 1] = parameters[k];
    }
    const std::string where = fmt::format("{}: aperture {}", place, name);
    Region2d region;
    for (const std::string& word : words) {
        const std::string_view text{word};
        if (text.empty() || text.front() == '0') {
            continue;  // a comment
        }
        if (const std::size_t equals = text.find('=');
            text.front() == '$' && equals != std::string_view::npos) {
            const auto variable = number_text::number_of(text.substr(1, equals - 1));
            variables[static_cast<int>(variable.value_or(0))] =
                gerber_value(text.substr(equals + 1), variables, where);
            continue;
        }
        std::vector<double> values;
        for (const std::string_view field : split_at(text, ',')) {
            values.push_back(gerber_value(field, variables, where));
        }
        const int code = static_cast<int>(values.front());
        values.erase(values.begin());
        const auto [shape, exposed] = primitive_of(code, {name, std::move(values), unit, place});
        region = exposed ? offset::united(region, shape) : offset::without(region, shape);
    }
    return region;
}

Aperture standard_aperture(char kind, const ApertureReader& p)
{
    Aperture aperture;
    std::size_t hole = 2;
    if (kind == 'C') {
        hole = 1;
        aperture.diameter = p.size(0, "diameter");
        aperture.shape = disc({}, aperture.diameter);
    } else if (kind == 'P') {
        hole = 3;
        aperture.shape = region_of(regular_polygon({}, p.whole(1, "the number of corners", 3, 12),
                                                   p.size(0, "diameter"), p.angle(2)));
    } else {
        const double width = p.size(0, "width");
        const double height = p.size(1, "height");
        if (width > 0 && height > 0) {
            aperture.shape = region_of(kind == 'R' ? rectangle_contour({}, width, height)
                                                   : obround_contour({}, width, height));
        }
        if (kind == 'R') {
            aperture.corners = {{-width / 2, -height / 2},
                                {width / 2, -height / 2},
                                {width / 2, height / 2},
                                {-width / 2, height / 2}};
        }
    }
    const double across = p.has(hole) ? p.size(hole, "hole diameter") : 0.0;
    if (across > 0) {
        aperture.shape = offset::without(aperture.shape, disc({}, across));
        aperture.diameter = 0;
        aperture.corners.clear();
    }
    return aperture;
}

}  // namespace

Aperture aperture_of(std::string_view text,
                     double unit,
                     const ApertureMacros& macros,
                     const std::string& place)
{
    const std::size_t comma = text.find(',');
    const std::string name{text.substr(0, comma)};
    std::vector<double> values;
    if (comma != std::string_view::npos) {
        for (const std::string_view field : split_at(text.substr(comma + 1), 'X')) {
            const auto number = number_text::number_of(field);
            if (!number) {
                throw InputError(fmt::format("{}: aperture {}: \"{}\" is no number", place, name,
                                             std::string{field}.substr(0, 40)));
            }
            values.push_back(*number);
        }
    }
    if (const auto macro = macros.find(name); macro != macros.end()) {
        return {macro_region(name, macro->second, values, unit, place)};
    }
    if (name != "C" && name != "R" && name != "O" && name != "P") {
        throw InputError(
            fmt::format("{}: aperture \"{}\": it is neither C, R, O, P nor a macro of the file",
                        place, name.substr(0, 40)));
    }
    return standard_aperture(name.front(), {name, std::move(values), unit, place});
}

}  // namespace cusp::import
