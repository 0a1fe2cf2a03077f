#include "host_tools/job/import/svg_transform.hpp"

#include <array>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/svg_text.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

constexpr std::size_t kMostValues = 6;

struct Values {
    std::array<double, kMostValues> value{};
    std::size_t count{};
};

constexpr double kDegree = kPi / 180;

PlaneMap turned_by(double degrees)
{
    const double c = elementary::cos(degrees * kDegree);
    const double s = elementary::sin(degrees * kDegree);
    return {{c, s}, {-s, c}, {0, 0}};
}

// True if the function was one of SVG's with that number of values.
bool append(PlaneMap& map, std::string_view name, const Values& given)
{
    const auto& v = given.value;
    const std::size_t count = given.count;
    if (name == "matrix" && count == 6) {
        map = map * PlaneMap{{v[0], v[1]}, {v[2], v[3]}, {v[4], v[5]}};
    } else if (name == "translate" && (count == 1 || count == 2)) {
        map = map * moved_by({v[0], v[1]});
    } else if (name == "scale" && (count == 1 || count == 2)) {
        map = map * stretched_by(v[0], count == 1 ? v[0] : v[1]);
    } else if (name == "rotate" && (count == 1 || count == 3)) {
        const Vec2d about{v[1], v[2]};
        map = map * moved_by(about) * turned_by(v[0]) * moved_by({-about.x, -about.y});
    } else if (name == "skewX" && count == 1) {
        map = map * PlaneMap{{1, 0}, {elementary::tan(v[0] * kDegree), 1}, {0, 0}};
    } else if (name == "skewY" && count == 1) {
        map = map * PlaneMap{{1, elementary::tan(v[0] * kDegree)}, {0, 1}, {0, 0}};
    } else {
        return false;
    }
    return true;
}

}  // namespace

nurbs::Curve PlaneMap::of(nurbs::Curve curve) const
{
    for (Vec3d& point : curve.points) {
        const Vec2d to = of(Vec2d{point.x, point.y});
        point = {to.x, to.y, point.z};
    }
    return curve;
}

PlaneMap operator*(const PlaneMap& outer, const PlaneMap& inner)
{
    const Vec2d at = outer.of(inner.at);
    return {outer.of(inner.x) - outer.at, outer.of(inner.y) - outer.at, at};
}

PlaneMap moved_by(Vec2d way) { return {{1, 0}, {0, 1}, way}; }

PlaneMap stretched_by(double along_x, double along_y)
{
    return {{along_x, 0}, {0, along_y}, {0, 0}};
}

PlaneMap plane_map(std::string_view text, const std::string& place)
{
    PlaneMap map;
    SvgText reader{text};
    for (reader.skip(); !reader.at_end(); reader.skip()) {
        const std::string rest{reader.rest()};
        const std::string_view name = reader.word();
        Values values;
        reader.skip();
        bool sound = reader.next() == '(';
        if (sound) {
            reader.take();
            for (auto value = reader.number(); value && values.count < kMostValues;
                 value = reader.number()) {
                values.value[values.count++] = *value;
            }
            reader.skip();
            sound = reader.next() == ')';
        }
        if (!sound || !append(map, name, values)) {
            throw InputError(fmt::format(
                "{}: transform: \"{}\" is no function of SVG with its values", place, rest));
        }
        reader.take();
    }
    return map;
}

}  // namespace cusp::import
