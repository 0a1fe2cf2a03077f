// The name says which shadow of the facets is wanted.
#include "host_tools/job/import/part_regions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/number_text/number_text.hpp"
#include "host_tools/geometry/offset/region_overlay.hpp"
#include "host_tools/geometry/offset/shadow.hpp"
#include "host_tools/geometry/waterline_slices/fitted_edges.hpp"
#include "host_tools/job/import/drawn_shapes.hpp"
#include "host_tools/job/import/mesh_file.hpp"
#include "host_tools/job/import/part_extent.hpp"
#include "host_tools/job/import/path_ending.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

using offset::Edge;
using offset::Region2d;

namespace {

constexpr const char* kRegions = "#outline, #above:Z, #below:Z, #level:Z, #edges:Z:Z:WIDTH";
constexpr const char* kFilled = ":no_holes";
constexpr const char* kHoleTops = "holes:";
constexpr const char* kEdges = "edges";
constexpr double kSameTop = 1e-3;  // mm

struct RegionName {
    std::string file;
    std::string kind;
    double z;  // of `kind` "outline" 0
};

double height_of(const std::string& name,
                 const std::string& kind,
                 const std::string& text,
                 double millimetres)
{
    const auto z = number_text::number_of(text);
    if (!z || !std::isfinite(*z)) {
        throw InputError(fmt::format("{}: \"{}\" is no height: a number is needed, such as #{}:-4",
                                     name, text, kind));
    }
    return *z * millimetres;
}

std::string region_text(const std::string& name)
{
    const std::size_t mark = layer_mark(name);
    return mark == std::string::npos ? "" : name.substr(mark + 1);
}

RegionName read_name(const std::string& name, double millimetres)
{
    std::string text = region_text(name);
    if (names_filled_region(name)) {
        text.erase(text.size() - std::string{kFilled}.size());
    }
    const std::size_t colon = std::min(text.find(':'), text.size());
    RegionName read{name.substr(0, layer_mark(name)), text.substr(0, colon), 0};
    if (const auto band = edge_band(name, millimetres)) {
        read.z = band->low;
        return read;
    }
    const bool has_height = read.kind == "above" || read.kind == "below" || read.kind == "level";
    if (!has_height && text != "outline") {
        throw InputError(
            fmt::format("{}: a part has no \"{}\"; its regions are {}", name, text, kRegions));
    }
    if (has_height) {
        read.z =
            height_of(name, read.kind, text.substr(std::min(colon + 1, text.size())), millimetres);
    }
    return read;
}

[[noreturn]] void refuse_empty(const std::string& name,
                               const RegionName& wanted,
                               const PartExtent& box,
                               const std::vector<std::array<Vec3d, 3>>& facets)
{
    if (wanted.kind == "level") {
        std::vector<double> heights;
        for (const offset::LevelHeight& level : offset::level_heights(facets)) {
            heights.push_back(std::round(level.z * 1e4) / 1e4);
        }
        throw InputError(fmt::format(
            "{}: no level ground at z {:g} mm; {}", name, wanted.z,
            heights.empty() ? "the part has none"
                            : fmt::format("it is at z {:g} mm", fmt::join(heights, ", "))));
    }
    throw InputError(
        fmt::format("{}: nothing {} z {:g} mm; the part reaches from z {:.6g} to {:.6g} mm", name,
                    wanted.kind == "below" ? "is to be cut down to" : "stands above", wanted.z,
                    box.low.z, box.high.z));
}

// The circle that the contour is, to a few of its fits; the border of a round hole is one.
std::optional<nurbs::Curve> circle_of(const offset::Contour& contour)
{
    constexpr double kRound = 3 * kRegionFit;
    constexpr double kLook = 0.05;  // of the way around between two looks
    const double step = kLook * length(contour);
    std::vector<Vec2d> looks;
    for (const Edge& edge : contour) {
        const int count = 1 + static_cast<int>(length(edge) / step);
        for (int k = 0; k < count; ++k) {
            looks.push_back(point_on(edge, (k + 0.5) / count));
        }
    }
    const PartExtent box = extent_of_curves(drawn_region({{contour}}).paths.front().curves);
    const Vec2d centre = 0.5 * in_plan(box.low + box.high);
    double radius = 0;
    for (const Vec2d look : looks) {
        radius += norm(look - centre) / static_cast<double>(looks.size());
    }
    const bool is_round = std::all_of(looks.begin(), looks.end(), [&](Vec2d look) {
        return std::abs(norm(look - centre) - radius) <= kRound;
    });
    const bool has_corners = std::any_of(contour.begin(), contour.end(),
                                         [](const Edge& edge) { return edge.turn == 0; });
    if (!is_round || has_corners || contour.size() > 8) {
        return std::nullopt;
    }
    return arc_curve(centre, radius, 0, offset::area(contour) > 0 ? 2 * kPi : -2 * kPi);
}

}  // namespace

Region2d box_region(const PartExtent& box)
{
    const Vec2d a{box.low.x, box.low.y};
    const Vec2d b{box.high.x, box.low.y};
    const Vec2d c{box.high.x, box.high.y};
    const Vec2d d{box.low.x, box.high.y};
    return {{{offset::line_edge(a, b), offset::line_edge(b, c), offset::line_edge(c, d),
              offset::line_edge(d, a)}}};
}

bool names_part_region(const std::string& name)
{
    const std::size_t mark = layer_mark(name);
    if (mark == std::string::npos) {
        return false;
    }
    const std::string file = name.substr(0, mark);
    return is_cad_file(file) || is_mesh_file(file);
}

bool names_filled_region(const std::string& name)
{
    const std::string text = region_text(name);
    const std::string ending = kFilled;
    return text.size() > ending.size() &&
           text.compare(text.size() - ending.size(), ending.size(), ending) == 0;
}

std::optional<EdgeBand> edge_band(const std::string& name, double millimetres)
{
    const std::string text = region_text(name);
    if (text.substr(0, text.find(':')) != kEdges) {
        return std::nullopt;
    }
    std::vector<std::string> numbers;
    for (std::size_t colon = text.find(':'); colon != std::string::npos;) {
        const std::size_t next = text.find(':', colon + 1);
        numbers.push_back(text.substr(colon + 1, next - colon - 1));
        colon = next;
    }
    if (numbers.size() != 3) {
        throw InputError(fmt::format(
            "{}: broken edges are #edges:Z:Z:WIDTH, the heights of their lower and upper edge, and "
            "the width between them seen from above",
            name));
    }
    const auto at = [&](std::size_t k) {
        return height_of(name, "edges:-4:-3:1", numbers[k], millimetres);
    };
    return EdgeBand{at(0), at(1), at(2)};
}

std::optional<std::array<double, 2>> hole_tops(const std::string& name, double millimetres)
{
    const std::string text = region_text(name);
    if (text.empty()) {
        return std::nullopt;
    }
    const std::string begin = kHoleTops;
    const std::size_t colon = text.find(':', begin.size());
    if (text.rfind(begin, 0) != 0 || colon == std::string::npos) {
        throw InputError(fmt::format(
            "{}: holes of a part are chosen by #holes:Z:Z, the heights between which they begin",
            name));
    }
    const auto at = [&](const std::string& number) {
        return height_of(name, "holes:-4", number, millimetres);
    };
    return std::array{at(text.substr(begin.size(), colon - begin.size())) - kSameTop,
                      at(text.substr(colon + 1)) + kSameTop};
}

Region2d hole_disc(const job::Hole& hole)
{
    const double radius = hole.diameter / 2 + kRegionFit;
    const std::array<Vec2d, 4> ends{hole.at + Vec2d{radius, 0}, hole.at + Vec2d{0, radius},
                                    hole.at - Vec2d{radius, 0}, hole.at - Vec2d{0, radius}};
    offset::Contour contour;
    for (std::size_t k = 0; k < ends.size(); ++k) {
        contour.push_back(offset::arc_edge(ends[k], ends[(k + 1) % ends.size()], hole.at, 1));
    }
    return {{contour}};
}

Region2d with_holes_filled(const Region2d& region, const std::vector<job::Hole>& holes, double z)
{
    Region2d discs;
    for (const job::Hole& hole : holes) {
        if (hole.span->top > z + kSameTop) {
            discs.contours.push_back(hole_disc(hole).contours.front());
        }
    }
    return offset::united(region, discs);
}

nurbs::Curve drawn_curve(const Edge& edge)
{
    if (edge.turn == 0) {
        return line_curve(edge.start, edge.end);
    }
    const Vec2d spoke = edge.start - edge.centre;
    return arc_curve(edge.centre, edge.radius, elementary::atan2(spoke.y, spoke.x),
                     edge.turn * sweep(edge));
}

DrawnPaths drawn_region(const Region2d& region)
{
    DrawnPaths drawn;
    for (const offset::Contour& contour : region.contours) {
        DrawingPath path{{}, true};
        std::transform(contour.begin(), contour.end(), std::back_inserter(path.curves),
                       drawn_curve);
        drawn.paths.push_back(std::move(path));
    }
    return drawn;
}

DrawnPaths part_region(const std::string& name,
                       double millimetres,
                       const std::vector<std::array<Vec3d, 3>>& facets,
                       const std::vector<job::Hole>& filled)
{
    const RegionName wanted = read_name(name, millimetres);
    const PartExtent box = extent_of_triangles(facets);
    const double z = wanted.kind == "outline" ? box.low.z - 1 : wanted.z;
    const bool is_level = wanted.kind == "level";
    const Region2d stands = with_holes_filled(
        is_level ? offset::level_ground(facets, z) : offset::shadow_above(facets, z), filled, z);
    const Region2d region =
        wanted.kind == "below" ? offset::without(box_region(box), stands) : stands;
    const Region2d fitted = waterline_slices::fitted_region(region, kRegionFit);
    if (fitted.contours.empty()) {
        refuse_empty(name, wanted, box, facets);
    }
    DrawnPaths drawn = drawn_region(fitted);
    for (std::size_t k = 0; k < fitted.contours.size(); ++k) {
        if (const auto circle = circle_of(fitted.contours[k])) {
            drawn.paths[k].curves = {*circle};
        }
    }
    return drawn;
}

}  // namespace cusp::import
