// Converts the entities of a drawing to curves and expands blocks where they are inserted.
#include "host_tools/import/dxf_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "firmware/base/math.hpp"
#include "host_tools/import/drawn_shapes.hpp"
#include "host_tools/import/dxf_drawing.hpp"
#include "host_tools/import/nearest_name.hpp"
#include "host_tools/import/nurbs_validity.hpp"
#include "host_tools/input_error/input_error.hpp"
#include "host_tools/nurbs/knot_insertion.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

using nurbs::Curve;

namespace {

constexpr double kLeastLength = 1e-9;
constexpr int kDeepestNesting = 16;
// Bounds the expansion of nested blocks in arrays.
constexpr std::size_t kMostCurves = 100000;

struct Vertex {
    Vec2d at;
    double bulge;  // tangent of a quarter of the sweep to the next vertex
};

class CurveMaker {
public:
    // layer  "": all that are shown
    CurveMaker(const DxfDrawing& drawing, std::string layer)
        : drawing_{drawing}, layer_{std::move(layer)}, unit_{drawing.unit()}
    {
    }

    // In the order of the drawing; none where the layer draws nothing.
    std::vector<Curve> read();

    // As read(), and the places of POINTs.
    DxfPlaces read_places();

    // The places of texts, which draw no curve.
    std::vector<Vec2d> read_texts();

private:
    // within  the layer of the block's reference, for objects on layer "0"; "": not in a block
    bool shown(const DxfEntity& entity, std::string_view within) const;
    void add_all(const std::vector<DxfEntity>& entities, std::string_view within, int depth);
    void add(const DxfEntity& entity);
    void add_insert(const DxfEntity& entity, std::string_view within, int depth);
    // Of a text where only texts are asked for.
    void add_text(const DxfEntity& entity);
    void add_line(const DxfEntity& entity);
    void add_arc(const DxfEntity& entity);
    void add_ellipse(const DxfEntity& entity);
    void add_light_polyline(const DxfEntity& entity);
    // Consumes the VERTEX entities that follow; returns the index of the last one.
    std::size_t add_old_polyline(const std::vector<DxfEntity>& all,
                                 std::size_t first,
                                 std::string_view within);
    void add_vertices(const DxfEntity& entity, const std::vector<Vertex>& vertices);
    void add_spline(const DxfEntity& entity);

    const DxfDrawing& drawing_;
    std::string layer_;
    double unit_;
    std::vector<Curve> curves_;
    std::size_t references_{};
    bool with_points_{false};  // as curves of no length
    bool texts_alone_{false};  // their places, as curves of no length
};

std::string_view layer_of(const DxfEntity& entity, std::string_view within)
{
    const std::string_view own = DxfDrawing::text(entity, 8, "0");
    return own == "0" && !within.empty() ? within : own;
}

bool CurveMaker::shown(const DxfEntity& entity, std::string_view within) const
{
    const std::string_view layer = layer_of(entity, within);
    // Entities of a block may be on the requested layer, whatever the layer of the INSERT.
    const bool chosen =
        layer_.empty() ? !drawing_.hidden(layer) : layer == layer_ || entity.type == "INSERT";
    constexpr int kPaperSpace = 67;
    constexpr int kInvisible = 60;
    return chosen && drawing_.value(entity, kPaperSpace, 0) == 0 &&
           drawing_.value(entity, kInvisible, 0) == 0;
}

// Objects drawn from below (extrusion towards -z) have their x mirrored.
double side_of(double extrusion_z) { return extrusion_z < 0 ? -1.0 : 1.0; }

void mirror(Curve& curve, double side)
{
    for (Vec3d& p : curve.points) {
        p.x *= side;
    }
}

void CurveMaker::add_line(const DxfEntity& entity)
{
    const Vec2d a{unit_ * drawing_.required(entity, 10), unit_ * drawing_.required(entity, 20)};
    const Vec2d b{unit_ * drawing_.required(entity, 11), unit_ * drawing_.required(entity, 21)};
    if (norm(b - a) > kLeastLength) {
        curves_.push_back(line_curve(a, b));
    }
}

void CurveMaker::add_arc(const DxfEntity& entity)
{
    const Vec2d centre{unit_ * drawing_.required(entity, 10),
                       unit_ * drawing_.required(entity, 20)};
    const double radius = unit_ * drawing_.required(entity, 40);
    if (!(radius > 0)) {
        drawing_.refuse(entity.line, fmt::format("{} of radius {} mm", entity.type, radius));
    }
    double start = 0;
    double sweep = 2 * kPi;
    if (entity.type == "ARC") {
        start = drawing_.required(entity, 50) * kPi / 180;
        sweep = std::fmod(drawing_.required(entity, 51) * kPi / 180 - start, 2 * kPi);
        sweep += sweep <= 0 ? 2 * kPi : 0;
    }
    Curve curve = arc_curve(centre, radius, start, sweep);
    mirror(curve, side_of(drawing_.value(entity, 230, 1)));
    curves_.push_back(curve);
}

// Centre, end of the longer half axis from there, ratio of the axes, first and last parameter.
void CurveMaker::add_ellipse(const DxfEntity& entity)
{
    const Vec2d centre{unit_ * drawing_.required(entity, 10),
                       unit_ * drawing_.required(entity, 20)};
    const Vec2d major{unit_ * drawing_.required(entity, 11), unit_ * drawing_.required(entity, 21)};
    const double ratio = drawing_.required(entity, 40);
    if (!(ratio > 0) || !(norm(major) > kLeastLength)) {
        drawing_.refuse(entity.line, fmt::format("ELLIPSE with half axes of {:g} and {:g} mm",
                                                 norm(major), ratio * norm(major)));
    }
    const double start = drawing_.value(entity, 41, 0);
    double sweep = std::fmod(drawing_.value(entity, 42, 2 * kPi) - start, 2 * kPi);
    constexpr double kWhole = 1e-9;
    sweep += sweep <= kWhole ? 2 * kPi : 0;
    // unlike an arc, its points are never mirrored: extrusion towards -z reverses the short axis
    const double turn = ratio * side_of(drawing_.value(entity, 230, 1));
    const Vec2d minor{-turn * major.y, turn * major.x};
    Curve curve = arc_curve({0, 0}, 1, start, sweep);
    for (Vec3d& p : curve.points) {
        const Vec2d at = centre + p.x * major + p.y * minor;
        p = {at.x, at.y, 0};
    }
    curves_.push_back(curve);
}

std::size_t CurveMaker::add_old_polyline(const std::vector<DxfEntity>& all,
                                         std::size_t first,
                                         std::string_view within)
{
    constexpr unsigned kMesh = 16U | 64U;
    if ((drawing_.flags(all[first], 70) & kMesh) != 0) {
        drawing_.refuse(all[first].line, "POLYLINE: a mesh is no outline");
    }
    std::vector<Vertex> vertices;
    std::size_t last = first;
    while (last + 1 < all.size() && all[last + 1].type == "VERTEX") {
        const DxfEntity& vertex = all[++last];
        constexpr unsigned kControlPoint = 16U;  // of a spline that the other vertices follow
        if ((drawing_.flags(vertex, 70) & kControlPoint) == 0) {
            vertices.push_back(
                {{unit_ * drawing_.required(vertex, 10), unit_ * drawing_.required(vertex, 20)},
                 drawing_.value(vertex, 42, 0)});
        }
    }
    if (shown(all[first], within) && !texts_alone_) {
        add_vertices(all[first], vertices);
    }
    return last;
}

void CurveMaker::add_light_polyline(const DxfEntity& entity)
{
    std::vector<Vertex> vertices;
    for (const DxfGroup& group : entity.groups) {
        if (group.code == 10) {
            vertices.push_back({{unit_ * drawing_.number(group), 0}, 0});
        } else if (group.code == 20 && !vertices.empty()) {
            vertices.back().at.y = unit_ * drawing_.number(group);
        } else if (group.code == 42 && !vertices.empty()) {
            vertices.back().bulge = drawing_.number(group);
        }
    }
    add_vertices(entity, vertices);
}

void CurveMaker::add_vertices(const DxfEntity& entity, const std::vector<Vertex>& vertices)
{
    const bool closed = (drawing_.flags(entity, 70) & 1U) != 0;
    const double side = side_of(drawing_.value(entity, 230, 1));
    for (std::size_t i = 0; i + (closed ? 0 : 1) < vertices.size(); ++i) {
        const Vertex& from = vertices[i];
        const Vec2d to = vertices[(i + 1) % vertices.size()].at;
        if (!(norm(to - from.at) > kLeastLength)) {
            continue;
        }
        Curve curve = bulged_curve(from.at, to, from.bulge);
        mirror(curve, side);
        curves_.push_back(curve);
    }
}

void CurveMaker::add_spline(const DxfEntity& entity)
{
    Curve curve;
    drawing_.required(entity, 71);
    curve.degree = static_cast<int>(drawing_.flags(entity, 71));
    curve.knots = drawing_.values(entity, 40);
    merge_close_knots(curve.knots);
    curve.weights = drawing_.values(entity, 41);
    const std::vector<double> x = drawing_.values(entity, 10);
    const std::vector<double> y = drawing_.values(entity, 20);
    if (x.empty() || x.size() != y.size()) {
        drawing_.refuse(entity.line, fmt::format("SPLINE with {} x and {} y of control points",
                                                 x.size(), y.size()));
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        curve.points.push_back({unit_ * x[i], unit_ * y[i], 0});
    }
    if (curve.weights.empty()) {
        curve.weights.assign(curve.points.size(), 1.0);
    }
    const std::string place = fmt::format("{}:{}: SPLINE", drawing_.file(), entity.line);
    for (const Curve& part : parts_of(curve)) {
        check_curve(part, place);
        curves_.push_back(clamped(part));
    }
}

void CurveMaker::add_text(const DxfEntity& entity)
{
    const bool is_text = entity.type == "TEXT" || entity.type == "MTEXT" || entity.type == "ATTRIB";
    if (is_text && !DxfDrawing::text(entity, 10, "").empty()) {
        const Vec2d at{unit_ * drawing_.value(entity, 10, 0),
                       unit_ * drawing_.value(entity, 20, 0)};
        curves_.push_back(line_curve(at, at));
        mirror(curves_.back(),
               entity.type == "MTEXT" ? 1 : side_of(drawing_.value(entity, 230, 1)));
    }
}

void CurveMaker::add(const DxfEntity& entity)
{
    // these draw no outline
    static const std::array<std::string_view, 11> kSkipped{"ATTRIB",    "SEQEND", "TEXT",  "MTEXT",
                                                           "DIMENSION", "HATCH",  "POINT", "LEADER",
                                                           "VIEWPORT",  "ATTDEF", "IMAGE"};
    if (texts_alone_) {
        add_text(entity);
    } else if (entity.type == "LINE") {
        add_line(entity);
    } else if (entity.type == "POINT" && with_points_) {
        const Vec2d at{unit_ * drawing_.required(entity, 10),
                       unit_ * drawing_.required(entity, 20)};
        curves_.push_back(line_curve(at, at));
    } else if (entity.type == "ARC" || entity.type == "CIRCLE") {
        add_arc(entity);
    } else if (entity.type == "LWPOLYLINE") {
        add_light_polyline(entity);
    } else if (entity.type == "ELLIPSE") {
        add_ellipse(entity);
    } else if (entity.type == "SPLINE") {
        add_spline(entity);
    } else if (std::find(kSkipped.begin(), kSkipped.end(), entity.type) == kSkipped.end()) {
        drawing_.refuse(
            entity.line,
            fmt::format(
                "{}: known are LINE, ARC, CIRCLE, ELLIPSE, LWPOLYLINE, POLYLINE, SPLINE and INSERT",
                entity.type));
    }
}

// Draws the block once for each cell of the array: relative to its base point, scaled, rotated and
// translated.
void CurveMaker::add_insert(const DxfEntity& entity, std::string_view within, int depth)
{
    const std::string_view name = DxfDrawing::text(entity, 2, "");
    const DxfBlock* block = drawing_.block(name);
    if (block == nullptr) {
        drawing_.refuse(entity.line, fmt::format("INSERT of \"{}\": no such block", name));
    }
    if (++references_ > kMostCurves) {
        drawing_.refuse(entity.line, fmt::format("the drawing refers to blocks more than {} times",
                                                 kMostCurves));
    }
    if (depth >= kDeepestNesting) {
        drawing_.refuse(entity.line, fmt::format("INSERT of \"{}\": blocks are nested more than {} "
                                                 "deep",
                                                 name, kDeepestNesting));
    }
    const Vec2d base{unit_ * drawing_.value(block->head, 10, 0),
                     unit_ * drawing_.value(block->head, 20, 0)};
    const Vec2d place{unit_ * drawing_.required(entity, 10), unit_ * drawing_.required(entity, 20)};
    const Vec2d scale{drawing_.value(entity, 41, 1), drawing_.value(entity, 42, 1)};
    if (scale.x == 0 || scale.y == 0) {
        drawing_.refuse(entity.line,
                        fmt::format("INSERT of \"{}\": scale {:g}, {:g}", name, scale.x, scale.y));
    }
    const double angle = drawing_.value(entity, 50, 0) * kPi / 180;
    const double cosine = std::cos(angle);
    const double sine = std::sin(angle);
    const double side = side_of(drawing_.value(entity, 230, 1));
    const unsigned columns = std::max(1U, drawing_.flags(entity, 70, 1));
    const unsigned rows = std::max(1U, drawing_.flags(entity, 71, 1));
    const Vec2d apart{unit_ * drawing_.value(entity, 44, 0), unit_ * drawing_.value(entity, 45, 0)};
    const std::size_t first = curves_.size();
    add_all(block->entities, layer_of(entity, within), depth + 1);
    const std::vector<Curve> drawn{curves_.begin() + static_cast<std::ptrdiff_t>(first),
                                   curves_.end()};
    curves_.resize(first);
    if (drawn.empty()) {
        return;
    }
    if (drawn.size() * columns * rows > kMostCurves) {
        drawing_.refuse(entity.line, fmt::format("INSERT of \"{}\" draws more than {} curves", name,
                                                 kMostCurves));
    }
    for (unsigned k = 0; k < columns * rows; ++k) {
        const Vec2d cell{apart.x * (k % columns), apart.y * (k / columns)};
        for (Curve curve : drawn) {
            for (Vec3d& p : curve.points) {
                const Vec2d q{scale.x * (p.x - base.x) + cell.x, scale.y * (p.y - base.y) + cell.y};
                p = {side * (place.x + cosine * q.x - sine * q.y),
                     place.y + sine * q.x + cosine * q.y, 0};
            }
            curves_.push_back(std::move(curve));
        }
    }
}

void CurveMaker::add_all(const std::vector<DxfEntity>& entities, std::string_view within, int depth)
{
    for (std::size_t i = 0; i < entities.size(); ++i) {
        if (entities[i].type == "POLYLINE") {
            i = add_old_polyline(entities, i, within);
        } else if (shown(entities[i], within)) {
            if (entities[i].type == "INSERT") {
                add_insert(entities[i], within, depth);
            } else {
                add(entities[i]);
            }
        }
        if (curves_.size() > kMostCurves) {
            drawing_.refuse(entities[i].line,
                            fmt::format("the drawing holds more than {} curves", kMostCurves));
        }
    }
}

std::vector<Curve> CurveMaker::read()
{
    add_all(drawing_.entities(), "", 0);
    for (const Curve& curve : curves_) {
        check_curve(curve, drawing_.file());
    }
    return std::move(curves_);
}

DxfPlaces CurveMaker::read_places()
{
    with_points_ = true;
    add_all(drawing_.entities(), "", 0);
    DxfPlaces places;
    for (Curve& curve : curves_) {
        if (curve.degree == 1 && curve.points.front() == curve.points.back()) {
            places.points.push_back(in_plan(curve.points.front()));
        } else {
            check_curve(curve, drawing_.file());
            places.curves.push_back(std::move(curve));
        }
    }
    return places;
}

std::vector<Vec2d> CurveMaker::read_texts()
{
    texts_alone_ = true;
    add_all(drawing_.entities(), "", 0);
    std::vector<Vec2d> places;
    for (const Curve& curve : curves_) {
        places.push_back(in_plan(curve.points.front()));
    }
    return places;
}

// Texts beside curves, which somebody may expect to be cut.
void note_texts(const DxfDrawing& drawing,
                const std::string& layer,
                std::vector<std::string>& notes)
{
    const std::vector<Vec2d> texts = CurveMaker{drawing, layer}.read_texts();
    if (!texts.empty()) {
        const bool one = texts.size() == 1;
        notes.push_back(fmt::format(
            "{}{}{}: {} at x {:.6g} y {:.6g} mm {} not cut: convert text to curves in the drawing "
            "program",
            drawing.file(), layer.empty() ? "" : "#", layer,
            one ? "a text" : fmt::format("{} texts, the first", texts.size()), texts.front().x,
            texts.front().y, one ? "is" : "are"));
    }
}

// What lies on a layer where no curve does: text has to be made into curves first.
std::string no_curve(const DxfDrawing& drawing, const std::string& layer)
{
    if (layer.empty()) {
        return drawing.file() + ": the drawing holds no curve";
    }
    std::string kinds;
    for (const DxfEntity& entity : drawing.entities()) {
        const std::string kind{entity.type};
        if (layer_of(entity, "") == layer && kinds.find(kind) == std::string::npos) {
            kinds += (kinds.empty() ? "" : ", ") + kind;
        }
    }
    std::string text = fmt::format("{}: no curve on the layer \"{}\"", drawing.file(), layer);
    if (!kinds.empty()) {
        text += fmt::format("; it holds {}: convert {} to curves in the drawing program", kinds,
                            kinds.find("TEXT") != std::string::npos ? "text" : "them");
    } else {
        constexpr std::size_t kNamed = 3;
        const std::set<std::string> layers = drawing.layers();
        text += fmt::format(
            "; layers of the drawing: \"{}\"{}",
            fmt::join(nearest_names(layer, {layers.begin(), layers.end()}, kNamed), "\", \""),
            layers.size() > kNamed ? " and more" : "");
    }
    return text;
}

}  // namespace

std::vector<Curve> read_dxf_curves(const std::string& file,
                                   double millimetres,
                                   const std::string& layer,
                                   std::vector<std::string>* notes)
{
    const DxfDrawing drawing{file, millimetres};
    std::vector<Curve> curves = CurveMaker{drawing, layer}.read();
    if (curves.empty()) {
        throw InputError(no_curve(drawing, layer));
    }
    if (notes != nullptr) {
        note_texts(drawing, layer, *notes);
    }
    return curves;
}

DxfPlaces read_dxf_places(const std::string& file, double millimetres, const std::string& layer)
{
    const DxfDrawing drawing{file, millimetres};
    return CurveMaker{drawing, layer}.read_places();
}

DxfLayers read_dxf_layers(const std::string& file, double millimetres)
{
    const DxfDrawing drawing{file, millimetres};
    DxfLayers out{drawing.unit(), drawing.names_unit(), {}};
    for (const std::string& name : drawing.layers()) {
        DxfLayer layer{name, drawing.hidden(name), {}, {}};
        try {
            layer.curves = CurveMaker{drawing, name}.read();
        } catch (const InputError& error) {
            layer.problem = error.what();
        }
        if (!layer.curves.empty() || !layer.problem.empty()) {
            out.layers.push_back(std::move(layer));
        }
    }
    if (out.layers.empty()) {
        throw InputError(no_curve(drawing, ""));
    }
    return out;
}

}  // namespace cusp::import
