// A DXF file is pairs of lines: a group code, then its value. Code 0 starts an entity.
#include "host_tools/import/dxf_curves.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <string_view>

#include "host_tools/import/nurbs_validity.hpp"
#include "host_tools/import/text_of_file.hpp"
#include "host_tools/input_error/input_error.hpp"
#include "host_tools/nurbs/knot_insertion.hpp"

#include "fmt/format.h"

namespace cusp::host {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kLeastLength = 1e-9;

struct Group {
    int code;
    std::string_view value;
    int line;  // of the value
};

struct Entity {
    std::string_view type;
    int line;
    std::vector<Group> groups;
};

struct Vertex {
    Vec2d at;
    double bulge;  // tangent of a quarter of the sweep to the next vertex
};

std::string_view trimmed(std::string_view text)
{
    const auto first = text.find_first_not_of(" \t\r");
    const auto last = text.find_last_not_of(" \t\r");
    return first == std::string_view::npos ? std::string_view{}
                                           : text.substr(first, last - first + 1);
}

class DxfReader {
public:
    DxfReader(std::string file, std::string layer, double millimetres)
        : file_{std::move(file)},
          layer_{std::move(layer)},
          text_{text_of_file(file_)},
          unit_{millimetres}
    {
    }

    std::vector<Curve> read();

private:
    std::vector<Group> groups() const;
    std::vector<Entity> section(std::string_view wanted, bool& found) const;
    void read_unit();
    void read_layers();
    std::string_view text(const Entity& entity, int code, std::string_view otherwise) const;
    bool shown(const Entity& entity) const;
    double number(const Group& group) const;
    double value(const Entity& entity, int code, double otherwise) const;
    double required(const Entity& entity, int code) const;
    // A whole number from 0 to 65535, where others would be cut off.
    unsigned flags(const Entity& entity, int code) const
    {
        constexpr double kMost = 65535;
        return static_cast<unsigned>(std::clamp(value(entity, code, 0), 0.0, kMost));
    }
    std::vector<double> values(const Entity& entity, int code) const;
    [[noreturn]] void refuse(int line, const std::string& reason) const
    {
        throw InputError(fmt::format("{}:{}: {}", file_, line, reason));
    }

    void add(const Entity& entity);
    void add_line(const Entity& entity);
    void add_arc(const Entity& entity);
    void add_ellipse(const Entity& entity);
    void add_light_polyline(const Entity& entity);
    // Takes the vertices that follow; returns the number of the last of them.
    std::size_t add_old_polyline(const std::vector<Entity>& all, std::size_t first);
    void add_vertices(const Entity& entity, const std::vector<Vertex>& vertices);
    void add_spline(const Entity& entity);

    std::string file_;
    std::string layer_;  // "": all that are shown
    std::string text_;
    double unit_;
    std::vector<Group> groups_;
    std::set<std::string_view> hidden_;
    std::vector<Curve> curves_;
};

std::vector<Group> DxfReader::groups() const
{
    std::vector<Group> out;
    std::string_view rest{text_};
    int line = 0;
    const auto next = [&] {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        const std::string_view text = trimmed(rest.substr(0, end));
        rest.remove_prefix(std::min(end + 1, rest.size()));
        ++line;
        return text;
    };
    while (!rest.empty()) {
        const std::string_view code = next();
        if (code.empty() && rest.empty()) {
            break;
        }
        int number = 0;
        const auto [end, error] = std::from_chars(code.data(), code.data() + code.size(), number);
        if (error != std::errc{} || end != code.data() + code.size()) {
            refuse(line, fmt::format("\"{}\" is no DXF group code", code.substr(0, 40)));
        }
        if (rest.empty()) {
            refuse(line, "the drawing ends after a group code");
        }
        const std::string_view text = next();
        out.push_back({number, text, line});
    }
    return out;
}

// The objects of one section, each from its code 0 on.
std::vector<Entity> DxfReader::section(std::string_view wanted, bool& found) const
{
    std::vector<Entity> out;
    bool inside = false;
    bool names_section = false;
    for (const Group& group : groups_) {
        if (names_section && group.code == 2) {
            inside = group.value == wanted;
            found = found || inside;
        }
        names_section = group.code == 0 && group.value == "SECTION";
        if (group.code == 0 && group.value == "ENDSEC") {
            inside = false;
        } else if (inside && group.code == 0) {
            out.push_back({group.value, group.line, {}});
        } else if (inside && !out.empty()) {
            out.back().groups.push_back(group);
        }
    }
    return out;
}

void DxfReader::read_unit()
{
    bool asked = false;
    for (const Group& group : groups_) {
        if (group.code == 9) {
            asked = group.value == "$INSUNITS";
        } else if (asked && group.code == 70) {
            constexpr double kInches = 1;
            constexpr double kMillimetres = 4;
            constexpr double kInch = 25.4;
            const double unit = number(group);
            unit_ = unit == kInches ? kInch : unit == kMillimetres ? 1.0 : unit_;
            return;
        } else if (group.code == 0 && group.value == "ENDSEC") {
            return;  // of the header, the first section
        }
    }
}

// Layers that are switched off or frozen draw nothing.
void DxfReader::read_layers()
{
    bool found = false;
    for (const Entity& table : section("TABLES", found)) {
        if (table.type != "LAYER") {
            continue;
        }
        const bool frozen = (flags(table, 70) & 1U) != 0;
        if (frozen || value(table, 62, 1) < 0) {
            hidden_.insert(text(table, 2, ""));
        }
    }
}

std::string_view DxfReader::text(const Entity& entity, int code, std::string_view otherwise) const
{
    for (const Group& group : entity.groups) {
        if (group.code == code) {
            return group.value;
        }
    }
    return otherwise;
}

bool DxfReader::shown(const Entity& entity) const
{
    const std::string_view layer = text(entity, 8, "0");
    const bool chosen = layer_.empty() ? hidden_.count(layer) == 0 : layer == layer_;
    constexpr int kPaperSpace = 67;
    constexpr int kInvisible = 60;
    return chosen && value(entity, kPaperSpace, 0) == 0 && value(entity, kInvisible, 0) == 0;
}

double DxfReader::number(const Group& group) const
{
    double value = 0;
    const char* end = group.value.data() + group.value.size();
    const char* begin = group.value.data();
    begin += begin != end && *begin == '+' ? 1 : 0;
    const auto [stop, error] = std::from_chars(begin, end, value);
    if (error != std::errc{} || stop != end || !std::isfinite(value)) {
        refuse(group.line, fmt::format("\"{}\" is not a number", group.value.substr(0, 40)));
    }
    return value;
}

double DxfReader::value(const Entity& entity, int code, double otherwise) const
{
    for (const Group& group : entity.groups) {
        if (group.code == code) {
            return number(group);
        }
    }
    return otherwise;
}

double DxfReader::required(const Entity& entity, int code) const
{
    const bool there = std::any_of(entity.groups.begin(), entity.groups.end(),
                                   [&](const Group& group) { return group.code == code; });
    if (!there) {
        refuse(entity.line, fmt::format("{} without group {}", entity.type, code));
    }
    return value(entity, code, 0);
}

std::vector<double> DxfReader::values(const Entity& entity, int code) const
{
    std::vector<double> out;
    for (const Group& group : entity.groups) {
        if (group.code == code) {
            out.push_back(number(group));
        }
    }
    return out;
}

Curve line_curve(Vec2d a, Vec2d b)
{
    return {1, {0, 0, 1, 1}, {{a.x, a.y, 0}, {b.x, b.y, 0}}, {1, 1}};
}

// Objects drawn from below (extrusion towards -z) have their x mirrored.
double side_of(double extrusion_z) { return extrusion_z < 0 ? -1.0 : 1.0; }

void mirror(Curve& curve, double side)
{
    for (Vec3d& p : curve.points) {
        p.x *= side;
    }
}

void DxfReader::add_line(const Entity& entity)
{
    const Vec2d a{unit_ * required(entity, 10), unit_ * required(entity, 20)};
    const Vec2d b{unit_ * required(entity, 11), unit_ * required(entity, 21)};
    if (norm(b - a) > kLeastLength) {
        curves_.push_back(line_curve(a, b));
    }
}

void DxfReader::add_arc(const Entity& entity)
{
    const Vec2d centre{unit_ * required(entity, 10), unit_ * required(entity, 20)};
    const double radius = unit_ * required(entity, 40);
    if (!(radius > 0)) {
        refuse(entity.line, fmt::format("{} of radius {} mm", entity.type, radius));
    }
    double start = 0;
    double sweep = 2 * kPi;
    if (entity.type == "ARC") {
        start = required(entity, 50) * kPi / 180;
        sweep = std::fmod(required(entity, 51) * kPi / 180 - start, 2 * kPi);
        sweep += sweep <= 0 ? 2 * kPi : 0;
    }
    Curve curve = arc_curve(centre, radius, start, sweep);
    mirror(curve, side_of(value(entity, 230, 1)));
    curves_.push_back(curve);
}

// Centre, end of the longer half axis from there, ratio of the axes, first and last parameter.
void DxfReader::add_ellipse(const Entity& entity)
{
    const Vec2d centre{unit_ * required(entity, 10), unit_ * required(entity, 20)};
    const Vec2d major{unit_ * required(entity, 11), unit_ * required(entity, 21)};
    const double ratio = required(entity, 40);
    if (!(ratio > 0) || !(norm(major) > kLeastLength)) {
        refuse(entity.line, fmt::format("ELLIPSE with half axes of {:g} and {:g} mm", norm(major),
                                        ratio * norm(major)));
    }
    const double start = value(entity, 41, 0);
    double sweep = std::fmod(value(entity, 42, 2 * kPi) - start, 2 * kPi);
    constexpr double kWhole = 1e-9;
    sweep += sweep <= kWhole ? 2 * kPi : 0;
    // unlike an arc's its points are never mirrored: a drawing from below turns the short axis
    const double turn = ratio * side_of(value(entity, 230, 1));
    const Vec2d minor{-turn * major.y, turn * major.x};
    Curve curve = arc_curve({0, 0}, 1, start, sweep);
    for (Vec3d& p : curve.points) {
        const Vec2d at = centre + p.x * major + p.y * minor;
        p = {at.x, at.y, 0};
    }
    curves_.push_back(curve);
}

std::size_t DxfReader::add_old_polyline(const std::vector<Entity>& all, std::size_t first)
{
    constexpr unsigned kMesh = 16U | 64U;
    if ((flags(all[first], 70) & kMesh) != 0) {
        refuse(all[first].line, "POLYLINE: a mesh is no outline");
    }
    std::vector<Vertex> vertices;
    std::size_t last = first;
    while (last + 1 < all.size() && all[last + 1].type == "VERTEX") {
        const Entity& vertex = all[++last];
        constexpr unsigned kControlPoint = 16U;  // of a spline that the other vertices follow
        if ((flags(vertex, 70) & kControlPoint) == 0) {
            vertices.push_back({{unit_ * required(vertex, 10), unit_ * required(vertex, 20)},
                                value(vertex, 42, 0)});
        }
    }
    if (shown(all[first])) {
        add_vertices(all[first], vertices);
    }
    return last;
}

void DxfReader::add_light_polyline(const Entity& entity)
{
    std::vector<Vertex> vertices;
    for (const Group& group : entity.groups) {
        if (group.code == 10) {
            vertices.push_back({{unit_ * number(group), 0}, 0});
        } else if (group.code == 20 && !vertices.empty()) {
            vertices.back().at.y = unit_ * number(group);
        } else if (group.code == 42 && !vertices.empty()) {
            vertices.back().bulge = number(group);
        }
    }
    add_vertices(entity, vertices);
}

void DxfReader::add_vertices(const Entity& entity, const std::vector<Vertex>& vertices)
{
    const bool closed = (flags(entity, 70) & 1U) != 0;
    const double side = side_of(value(entity, 230, 1));
    for (std::size_t i = 0; i + (closed ? 0 : 1) < vertices.size(); ++i) {
        const Vertex& from = vertices[i];
        const Vec2d to = vertices[(i + 1) % vertices.size()].at;
        const Vec2d chord = to - from.at;
        if (!(norm(chord) > kLeastLength)) {
            continue;
        }
        Curve curve = line_curve(from.at, to);
        constexpr double kStraight = 1e-9;
        if (std::abs(from.bulge) > kStraight) {
            const double sweep = 4 * std::atan(from.bulge);
            // the centre lies to the left of the chord for a counter-clockwise arc below a half
            // turn
            const double offset = (1 - from.bulge * from.bulge) / (4 * from.bulge);
            const Vec2d centre = 0.5 * (from.at + to) + offset * Vec2d{-chord.y, chord.x};
            const Vec2d spoke = from.at - centre;
            curve = arc_curve(centre, norm(spoke), std::atan2(spoke.y, spoke.x), sweep);
            curve.points.front() = {from.at.x, from.at.y, 0};
            curve.points.back() = {to.x, to.y, 0};
        }
        mirror(curve, side);
        curves_.push_back(curve);
    }
}

void DxfReader::add_spline(const Entity& entity)
{
    Curve curve;
    required(entity, 71);
    curve.degree = static_cast<int>(flags(entity, 71));
    curve.knots = values(entity, 40);
    curve.weights = values(entity, 41);
    const std::vector<double> x = values(entity, 10);
    const std::vector<double> y = values(entity, 20);
    if (x.empty() || x.size() != y.size()) {
        refuse(entity.line,
               fmt::format("SPLINE with {} x and {} y of control points", x.size(), y.size()));
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        curve.points.push_back({unit_ * x[i], unit_ * y[i], 0});
    }
    if (curve.weights.empty()) {
        curve.weights.assign(curve.points.size(), 1.0);
    }
    check_curve(curve, fmt::format("{}:{}: SPLINE", file_, entity.line));
    curves_.push_back(clamped(curve));
}

void DxfReader::add(const Entity& entity)
{
    // what draws no outline
    static const std::array<std::string_view, 10> kSkipped{"SEQEND", "TEXT",  "MTEXT",  "DIMENSION",
                                                           "HATCH",  "POINT", "LEADER", "VIEWPORT",
                                                           "ATTDEF", "IMAGE"};
    if (entity.type == "LINE") {
        add_line(entity);
    } else if (entity.type == "ARC" || entity.type == "CIRCLE") {
        add_arc(entity);
    } else if (entity.type == "LWPOLYLINE") {
        add_light_polyline(entity);
    } else if (entity.type == "ELLIPSE") {
        add_ellipse(entity);
    } else if (entity.type == "SPLINE") {
        add_spline(entity);
    } else if (std::find(kSkipped.begin(), kSkipped.end(), entity.type) == kSkipped.end()) {
        refuse(
            entity.line,
            fmt::format("{}: known are LINE, ARC, CIRCLE, ELLIPSE, LWPOLYLINE, POLYLINE and SPLINE",
                        entity.type));
    }
}

double apart(Vec3d a, Vec3d b) { return std::hypot(a.x - b.x, a.y - b.y); }

// Each curve followed by the one that starts or ends nearest to its end.
std::vector<Curve> in_order(std::vector<Curve> curves)
{
    for (std::size_t i = 0; i + 1 < curves.size(); ++i) {
        const Vec3d end = curves[i].points.back();
        std::size_t nearest = i + 1;
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t k = i + 1; k < curves.size(); ++k) {
            const double distance =
                std::min(apart(end, curves[k].points.front()), apart(end, curves[k].points.back()));
            if (distance < least) {
                least = distance;
                nearest = k;
            }
        }
        std::swap(curves[i + 1], curves[nearest]);
        Curve& next = curves[i + 1];
        if (apart(end, next.points.back()) < apart(end, next.points.front())) {
            next = reversed(next);
        }
    }
    return curves;
}

std::vector<Curve> DxfReader::read()
{
    groups_ = groups();
    read_unit();
    read_layers();
    bool found = false;
    const std::vector<Entity> all = section("ENTITIES", found);
    if (!found) {
        throw InputError(file_ + ": no DXF drawing with an ENTITIES section");
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].type == "POLYLINE") {
            i = add_old_polyline(all, i);
        } else if (shown(all[i])) {
            add(all[i]);
        }
    }
    if (curves_.empty()) {
        throw InputError(layer_.empty()
                             ? file_ + ": the drawing holds no curve"
                             : fmt::format("{}: no curve on the layer \"{}\"", file_, layer_));
    }
    for (const Curve& curve : curves_) {
        check_curve(curve, file_);
    }
    return in_order(std::move(curves_));
}

}  // namespace

Curve arc_curve(Vec2d centre, double radius, double start, double sweep)
{
    constexpr double kMostPerPiece = kPi / 2 + 1e-9;
    const int pieces = std::max(1, static_cast<int>(std::ceil(std::abs(sweep) / kMostPerPiece)));
    const double step = sweep / pieces;
    const double middle_weight = std::cos(step / 2);
    const auto on_circle = [&](double angle, double r) {
        return Vec3d{centre.x + r * std::cos(angle), centre.y + r * std::sin(angle), 0};
    };
    Curve curve{2, {0, 0, 0}, {on_circle(start, radius)}, {1}};
    for (int i = 0; i < pieces; ++i) {
        const double begin = start + i * step;
        curve.points.push_back(on_circle(begin + step / 2, radius / middle_weight));
        curve.points.push_back(on_circle(begin + step, radius));
        curve.weights.push_back(middle_weight);
        curve.weights.push_back(1);
        curve.knots.insert(curve.knots.end(), 2, i + 1);
    }
    curve.knots.push_back(pieces);
    return curve;
}

std::vector<Curve> read_dxf_curves(const std::string& file,
                                   double millimetres,
                                   const std::string& layer)
{
    return DxfReader{file, layer, millimetres}.read();
}

}  // namespace cusp::host
