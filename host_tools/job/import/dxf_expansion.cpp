// A block is expanded in its own coordinates and moved to each cell of the array of its reference.
#include "host_tools/job/import/dxf_expansion.hpp"

#include <algorithm>
#include <array>
#include <iterator>

#include "firmware/base/math.hpp"
#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/dxf_entities.hpp"
#include "host_tools/job/import/dxf_plane.hpp"

#include "fmt/format.h"

namespace cusp::import {

using nurbs::Curve;

namespace {

constexpr int kDeepestNesting = 16;
// Bounds the expansion of nested blocks in arrays.
constexpr std::size_t kMostCurves = 100000;

// From the coordinates of a block to those that hold its reference.
struct Reference {
    Vec3d base, place, scale;
    double cosine, sine;
    Similarity axes;
    unsigned columns, rows;
    Vec3d apart;

    Vec3d of(Vec3d p, unsigned cell) const
    {
        const Vec3d q{scale.x * (p.x - base.x) + apart.x * (cell % columns),
                      scale.y * (p.y - base.y) + apart.y * (cell / columns),
                      scale.z * (p.z - base.z)};
        return axes.of({place.x + cosine * q.x - sine * q.y, place.y + sine * q.x + cosine * q.y,
                        place.z + q.z});
    }
};

class Expander {
public:
    // lenient  hidden layers are drawn, and entities with errors are left out
    Expander(const DxfDrawing& drawing, std::string layer, bool lenient)
        : drawing_{drawing}, layer_{std::move(layer)}, lenient_{lenient}
    {
    }

    DxfPieces run()
    {
        add_all(drawing_.entities(), "", 0);
        return std::move(out_);
    }

private:
    bool shown(const DxfEntity& entity, std::string_view within) const;
    void add_all(const std::vector<DxfEntity>& entities, std::string_view within, int depth);
    // Returns the index of the last entity that was consumed: vertices follow their polyline.
    std::size_t add_at(const std::vector<DxfEntity>& entities,
                       std::size_t at,
                       std::string_view within,
                       int depth);
    void add(const DxfEntity& entity);
    void add_path(DrawingPath path);
    void leave_out(const std::string& kind) { ++out_.left_out[kind]; }
    void add_insert(const DxfEntity& entity, std::string_view within, int depth);
    Reference reference_of(const DxfEntity& entity, const DxfBlock& block) const;
    void repeat(const DxfEntity& entity,
                const Reference& reference,
                std::vector<DrawingPath>& paths,
                std::size_t first) const;
    std::size_t count() const
    {
        return out_.paths.size() + out_.points.size() + out_.texts.size() + curves_;
    }

    const DxfDrawing& drawing_;
    std::string layer_;
    bool lenient_;
    DxfPieces out_;
    std::size_t curves_{};  // in paths, but for the first of each
    std::size_t references_{};
};

bool Expander::shown(const DxfEntity& entity, std::string_view within) const
{
    const std::string_view layer = layer_of(entity, within);
    // Entities of a block may be on the requested layer, whatever the layer of the INSERT.
    const bool chosen = layer_.empty() ? lenient_ || !drawing_.hidden(layer)
                                       : layer == layer_ || entity.type == "INSERT";
    constexpr int kPaperSpace = 67;
    constexpr int kInvisible = 60;
    return chosen && drawing_.value(entity, kPaperSpace, 0) == 0 &&
           drawing_.value(entity, kInvisible, 0) == 0;
}

void Expander::add_path(DrawingPath path)
{
    if (!path.curves.empty()) {
        curves_ += path.curves.size() - 1;
        out_.paths.push_back(std::move(path));
    }
}

void Expander::add(const DxfEntity& entity)
{
    // parts of others, what is filled in at an INSERT, windows of the paper
    constexpr std::array<std::string_view, 4> kParts{"SEQEND", "VERTEX", "ATTDEF", "VIEWPORT"};
    if (auto path = drawn_path(drawing_, entity, out_.interpolated)) {
        add_path(std::move(*path));
    } else if (entity.type == "POINT") {
        out_.points.push_back(drawn_place(drawing_, entity, false));
    } else if (entity.type == "TEXT" || entity.type == "MTEXT" || entity.type == "ATTRIB") {
        if (!DxfDrawing::text(entity, 10, "").empty() &&
            !DxfDrawing::text(entity, 20, "").empty()) {
            out_.texts.push_back(drawn_place(drawing_, entity, entity.type != "MTEXT"));
        }
    } else if (std::find(kParts.begin(), kParts.end(), entity.type) == kParts.end()) {
        leave_out(std::string{entity.type});
    }
}

Reference Expander::reference_of(const DxfEntity& entity, const DxfBlock& block) const
{
    const double unit = drawing_.unit();
    const Vec3d scale{drawing_.value(entity, 41, 1), drawing_.value(entity, 42, 1),
                      drawing_.value(entity, 43, 1)};
    if (scale.x == 0 || scale.y == 0) {
        drawing_.refuse(entity.line,
                        fmt::format("INSERT of \"{}\": scale {:g}, {:g}",
                                    DxfDrawing::text(entity, 2, ""), scale.x, scale.y));
    }
    const double angle = drawing_.value(entity, 50, 0) * kPi / 180;
    return {unit * Vec3d{drawing_.value(block.head, 10, 0), drawing_.value(block.head, 20, 0),
                         drawing_.value(block.head, 30, 0)},
            point_of(drawing_, entity, 10),
            scale,
            elementary::cos(angle),
            elementary::sin(angle),
            object_axes(extrusion_of(drawing_, entity)),
            std::max(1U, drawing_.flags(entity, 70, 1)),
            std::max(1U, drawing_.flags(entity, 71, 1)),
            {unit * drawing_.value(entity, 44, 0), unit * drawing_.value(entity, 45, 0), 0}};
}

// Replaces the paths from the first on by one copy for each cell.
void Expander::repeat(const DxfEntity& entity,
                      const Reference& reference,
                      std::vector<DrawingPath>& paths,
                      std::size_t first) const
{
    const std::vector<DrawingPath> drawn{
        std::make_move_iterator(paths.begin() + static_cast<std::ptrdiff_t>(first)),
        std::make_move_iterator(paths.end())};
    paths.resize(first);
    const unsigned cells = reference.columns * reference.rows;
    std::size_t curves = 0;
    for (const DrawingPath& path : drawn) {
        curves += path.curves.size();
    }
    if (curves > 0 && curves * cells > kMostCurves) {
        drawing_.refuse(entity.line, fmt::format("INSERT of \"{}\" draws more than {} curves",
                                                 DxfDrawing::text(entity, 2, ""), kMostCurves));
    }
    for (unsigned cell = 0; cell < cells && curves > 0; ++cell) {
        for (DrawingPath path : drawn) {
            for (Curve& curve : path.curves) {
                for (Vec3d& p : curve.points) {
                    p = reference.of(p, cell);
                }
            }
            paths.push_back(std::move(path));
        }
    }
}

void Expander::add_insert(const DxfEntity& entity, std::string_view within, int depth)
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
    const Reference reference = reference_of(entity, *block);
    const std::array<std::size_t, 3> first{out_.paths.size(), out_.points.size(),
                                           out_.texts.size()};
    const std::size_t curves = curves_;
    add_all(block->entities, layer_of(entity, within), depth + 1);
    curves_ = curves + (curves_ - curves) * reference.columns * reference.rows;
    repeat(entity, reference, out_.paths, first[0]);
    repeat(entity, reference, out_.points, first[1]);
    repeat(entity, reference, out_.texts, first[2]);
}

std::size_t Expander::add_at(const std::vector<DxfEntity>& entities,
                             std::size_t at,
                             std::string_view within,
                             int depth)
{
    const DxfEntity& entity = entities[at];
    std::vector<const DxfEntity*> vertices;
    if (entity.type == "POLYLINE") {
        while (at + 1 < entities.size() && entities[at + 1].type == "VERTEX") {
            vertices.push_back(&entities[++at]);
        }
    }
    try {
        if (!shown(entity, within)) {
            return at;
        }
        if (entity.type == "INSERT") {
            add_insert(entity, within, depth);
        } else if (entity.type != "POLYLINE") {
            add(entity);
        } else if (auto path = drawn_polyline(drawing_, entity, vertices)) {
            add_path(std::move(*path));
        } else {
            leave_out("POLYLINE (mesh)");
        }
    } catch (const InputError&) {
        if (!lenient_) {
            throw;
        }
    }
    return at;
}

void Expander::add_all(const std::vector<DxfEntity>& entities, std::string_view within, int depth)
{
    for (std::size_t i = 0; i < entities.size(); ++i) {
        i = add_at(entities, i, within, depth);
        if (count() > kMostCurves) {
            drawing_.refuse(entities[i].line,
                            fmt::format("the drawing holds more than {} curves", kMostCurves));
        }
    }
}

}  // namespace

std::string_view layer_of(const DxfEntity& entity, std::string_view within)
{
    const std::string_view own = DxfDrawing::text(entity, 8, "0");
    return own == "0" && !within.empty() ? within : own;
}

DxfPieces expanded(const DxfDrawing& drawing, const std::string& layer)
{
    return Expander{drawing, layer, false}.run();
}

DxfPieces all_that_can_be_drawn(const DxfDrawing& drawing)
{
    return Expander{drawing, "", true}.run();
}

}  // namespace cusp::import
