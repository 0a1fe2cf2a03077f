// A circle is a closed curve all of whose points are as far from their mean, or arcs that meet; a block may turn and
// scale it.
#include "host_tools/job/import/dxf_holes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "firmware/base/math.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/drawing.hpp"
#include "host_tools/job/import/geometry_json.hpp"
#include "host_tools/job/import/loop_nesting.hpp"
#include "host_tools/job/import/path_ending.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

using job::Chain;
using job::Hole;
using nurbs::Curve;

namespace {

struct DrawingName {
    std::string file;
    std::string layer;
};

DrawingName parts_of(const std::string& name)
{
    const std::size_t mark = layer_mark(name);
    DrawingName parts{name.substr(0, mark), mark == std::string::npos ? "" : name.substr(mark + 1)};
    if (!is_drawing_file(parts.file) && path_ending(parts.file) != ".json") {
        throw InputError(fmt::format("{}: drawings are read from {}, not from \"{}\"", name,
                                     kDrawingEndings, path_ending(parts.file)));
    }
    return parts;
}

std::optional<Hole> circle_of(const Curve& curve)
{
    constexpr int kSamples = 24;
    constexpr double kRoundness = 1e-6;  // of the radius
    const double begin = curve.domain_begin();
    const double step = (curve.domain_end() - begin) / kSamples;
    if (norm(in_plan(curve.points.front()) - in_plan(curve.points.back())) > kEndsMeet) {
        return std::nullopt;
    }
    // of a circle in equal pieces, opposite samples are opposite points
    const Vec2d centre = 0.5 * (in_plan(point_at(curve, begin)) +
                                in_plan(point_at(curve, begin + step * kSamples / 2)));
    const double radius = norm(in_plan(curve.points.front()) - centre);
    const double rounding = 8 * std::numeric_limits<double>::epsilon() * norm(centre);
    for (int i = 0; i < kSamples; ++i) {
        const double away = norm(in_plan(point_at(curve, begin + i * step)) - centre);
        if (!(std::abs(away - radius) <= kRoundness * radius + rounding)) {
            return std::nullopt;
        }
    }
    return Hole{centre, 2 * radius};
}

Vec2d begin_of(const Chain& chain) { return in_plan(chain.front().points.front()); }
Vec2d end_of(const Chain& chain) { return in_plan(chain.back().points.back()); }

// Curves whose ends meet, in order.
std::vector<Chain> joined(const std::vector<Curve>& curves)
{
    std::vector<Chain> chains;
    std::vector<bool> used(curves.size(), false);
    for (std::size_t first = 0; first < curves.size(); ++first) {
        if (used[first]) {
            continue;
        }
        Chain chain{curves[first]};
        used[first] = true;
        for (bool grew = true; grew;) {
            grew = false;
            for (std::size_t k = first + 1; k < curves.size(); ++k) {
                if (used[k]) {
                    continue;
                }
                const Chain one{curves[k]};
                const Chain turned{reversed(curves[k])};
                const auto meets = [](Vec2d a, Vec2d b) {
                    return norm(a - b) <= kEndsMeet;
                };
                if (meets(end_of(chain), begin_of(one))) {
                    chain.push_back(one.front());
                } else if (meets(end_of(chain), end_of(one))) {
                    chain.push_back(turned.front());
                } else if (meets(begin_of(chain), end_of(one))) {
                    chain.insert(chain.begin(), one.front());
                } else if (meets(begin_of(chain), begin_of(one))) {
                    chain.insert(chain.begin(), turned.front());
                } else {
                    continue;
                }
                used[k] = true;
                grew = true;
            }
        }
        chains.push_back(std::move(chain));
    }
    return chains;
}

// The centre of the circle through three points; not finite on a line.
Vec2d centre_of(Vec2d a, Vec2d b, Vec2d c)
{
    const Vec2d u = b - a;
    const Vec2d v = c - a;
    const double twice = 2 * (u.x * v.y - u.y * v.x);
    const double uu = u.x * u.x + u.y * u.y;
    const double vv = v.x * v.x + v.y * v.y;
    return a + Vec2d{(v.y * uu - u.y * vv) / twice, (u.x * vv - v.x * uu) / twice};
}

// A circle drawn as arcs: by a polyline with bulges, or broken up.
std::optional<Hole> circle_of_arcs(const Chain& chain)
{
    constexpr std::size_t kSamples = 12;  // of a curve
    constexpr double kWhole = 0.9;        // of the circle's area: no arc drawn there and back
    if (norm(begin_of(chain) - end_of(chain)) > kEndsMeet) {
        return std::nullopt;
    }
    std::vector<Vec2d> points;
    for (const Curve& curve : chain) {
        const double step = (curve.domain_end() - curve.domain_begin()) / kSamples;
        for (std::size_t k = 0; k < kSamples; ++k) {
            const double at = curve.domain_begin() + static_cast<double>(k) * step;
            points.push_back(in_plan(point_at(curve, at)));
        }
    }
    const std::size_t third = points.size() / 3;
    const Vec2d centre = centre_of(points[0], points[third], points[2 * third]);
    const double radius = norm(points[0] - centre);
    double twice_area = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
        const Vec2d a = points[k] - centre;
        const Vec2d b = points[(k + 1) % points.size()] - centre;
        twice_area += a.x * b.y - a.y * b.x;
        if (!(std::abs(norm(a) - radius) <= kEndsMeet)) {
            return std::nullopt;
        }
    }
    if (!(std::abs(twice_area) / 2 >= kWhole * kPi * radius * radius)) {
        return std::nullopt;
    }
    return Hole{centre, 2 * radius};
}

// The circles among the curves; `others` receives the number of curves that are part of none.
std::vector<Hole> circles_of(const std::vector<Curve>& curves, std::size_t& others)
{
    std::vector<Hole> circles;
    std::vector<Curve> rest;
    for (const Curve& curve : curves) {
        if (const auto circle = circle_of(curve)) {
            circles.push_back(*circle);
        } else {
            rest.push_back(curve);
        }
    }
    for (const Chain& chain : joined(rest)) {
        const auto circle = circle_of_arcs(chain);
        others += circle ? 0 : chain.size();
        if (circle) {
            circles.push_back(*circle);
        }
    }
    return circles;
}

}  // namespace

std::optional<Hole> circle_of_loop(const Chain& loop)
{
    return loop.size() == 1 ? circle_of(loop.front()) : circle_of_arcs(loop);
}

std::vector<Hole> read_holes(const std::string& name,
                             double millimetres,
                             DiameterRange range,
                             bool only_circles,
                             std::vector<std::string>& notes)
{
    const auto [file, layer] = parts_of(name);
    const DrawnPlaces drawn = read_drawn_places(file, millimetres, layer, &notes);
    std::vector<Hole> all;
    for (const Vec2d place : drawn.points) {
        all.push_back({place, 0});
    }
    std::size_t others = 0;
    std::size_t repeated = 0;  // not said: holes at one place are one anyway
    const std::vector<Hole> circles = circles_of(without_repeats(drawn.curves, repeated), others);
    all.insert(all.end(), circles.begin(), circles.end());
    if (others > 0) {
        notes.push_back(fmt::format("{}: {} and not drilled", name,
                                    others == 1 ? "1 curve is no circle"
                                                : fmt::format("{} curves are no circles", others)));
    }
    std::vector<Hole> holes;
    std::set<double> diameters;
    for (const Hole& hole : all) {
        diameters.insert(std::round(hole.diameter * 1e4) / 1e4);
        const bool wanted = hole.diameter > 0
                                ? hole.diameter >= range.least && hole.diameter <= range.greatest
                                : !only_circles;
        const bool again = std::any_of(holes.begin(), holes.end(), [&](const Hole& other) {
            return norm(other.at - hole.at) <= kEndsMeet;
        });
        if (wanted && !again) {
            holes.push_back(hole);
        }
    }
    if (holes.empty()) {
        diameters.erase(0);
        throw InputError(diameters.empty()
                             ? fmt::format("{}: no point and no circle to drill", name)
                             : fmt::format("{}: no circle of the wanted diameter; there are {:g} "
                                           "mm",
                                           name, fmt::join(diameters, ", ")));
    }
    return holes;
}

namespace {

// Those of a JSON file are paths of one curve.
std::vector<DrawingPath> read_paths(const std::string& name,
                                    double millimetres,
                                    std::vector<std::string>* notes)
{
    const auto [file, layer] = parts_of(name);
    if (path_ending(file) != ".json") {
        return read_drawn_paths(file, millimetres, layer, notes).paths;
    }
    std::vector<DrawingPath> paths;
    for (Curve& curve : read_json_curves(file, millimetres)) {
        paths.push_back({{std::move(curve)}, false});
    }
    return paths;
}

}  // namespace

std::vector<Curve> read_curves(const std::string& name,
                               double millimetres,
                               std::vector<std::string>* notes)
{
    return curves_of(read_paths(name, millimetres, notes));
}

std::vector<Chain> chains_of(const std::string& name,
                             const std::vector<Curve>& curves,
                             std::vector<std::string>& notes)
{
    std::size_t repeated = 0;
    const std::vector<Curve> once = without_repeats(curves, repeated);
    if (repeated > 0) {
        notes.push_back(repeats_text(name, repeated));
    }
    return joined(once);
}

std::vector<Chain> read_chains(const std::string& name,
                               double millimetres,
                               std::vector<std::string>& notes)
{
    return chains_of(name, read_curves(name, millimetres, &notes), notes);
}

}  // namespace cusp::import
