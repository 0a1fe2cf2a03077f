// One view for all layers of a drawing, so that they keep their places to each other.
#include "host_tools/job/import/dxf_curves.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/drawing_notes.hpp"
#include "host_tools/job/import/dxf_drawing.hpp"
#include "host_tools/job/import/dxf_expansion.hpp"
#include "host_tools/job/import/dxf_plane.hpp"
#include "host_tools/job/import/nurbs_validity.hpp"

#include "fmt/format.h"

namespace cusp::import {

using nurbs::Curve;

namespace {

std::string named(const DxfDrawing& drawing, const std::string& layer)
{
    return drawing.file() + (layer.empty() ? "" : "#") + layer;
}

void note_interpolated(const std::string& name,
                       std::size_t splines,
                       std::vector<std::string>& notes)
{
    if (splines > 0) {
        notes.push_back(fmt::format(
            "{}: {} given by fit points alone: cut as the cubic through them; between them other "
            "programs may draw another curve",
            name, splines == 1 ? "a SPLINE is" : fmt::format("{} SPLINEs are", splines)));
    }
}

class Reader {
public:
    Reader(const std::string& file, double millimetres) : drawing_{file, millimetres}
    {
        if (drawing_.has_depth()) {
            const DrawingBox extent = extent_of(all_that_can_be_drawn(drawing_).paths);
            view_ = view_of(extent);
            view_note_ = view_note(file, view_, extent);
        }
    }

    const DxfDrawing& drawing() const { return drawing_; }

    DxfPieces read(const std::string& layer) const
    {
        DxfPieces drawn = expanded(drawing_, layer);
        for (auto* paths : {&drawn.paths, &drawn.points, &drawn.texts}) {
            flatten(view_, *paths);
        }
        for (const DrawingPath& path : drawn.paths) {
            for (const Curve& curve : path.curves) {
                check_curve(curve, drawing_.file(), kLargestDrawn);
            }
        }
        return drawn;
    }

    std::vector<std::string> notes_on_file() const
    {
        std::vector<std::string> notes;
        for (const std::string& note : {drawing_.unit_note(), view_note_}) {
            if (!note.empty()) {
                notes.push_back(note);
            }
        }
        return notes;
    }

    // no_points  points are not wanted
    std::vector<std::string> notes_on_layer(const std::string& layer,
                                            const DxfPieces& drawn,
                                            bool no_points) const
    {
        std::vector<std::string> notes;
        const std::string name = named(drawing_, layer);
        std::map<std::string, std::size_t> kinds = drawn.left_out;
        if (no_points && !drawn.points.empty()) {
            kinds["POINT"] = drawn.points.size();
        }
        if (!drawn.texts.empty()) {
            note_texts(name, drawn.texts.size(),
                       in_plan(drawn.texts.front().curves.front().points.front()), notes);
        }
        note_left_out(name, kinds, notes);
        note_interpolated(name, drawn.interpolated, notes);
        note_far(drawing_.file(), drawn.paths, notes);
        return notes;
    }

    void add_notes(const std::string& layer,
                   const DxfPieces& drawn,
                   bool no_points,
                   std::vector<std::string>& notes) const
    {
        for (const auto& more : {notes_on_file(), notes_on_layer(layer, drawn, no_points)}) {
            notes.insert(notes.end(), more.begin(), more.end());
        }
    }

private:
    DxfDrawing drawing_;
    DrawingSide view_{DrawingSide::kAbove};
    std::string view_note_;
};

// The entities of a layer without curves: text has to be made into curves first.
std::string no_curve(const DxfDrawing& drawing, const std::string& layer)
{
    std::string kinds;
    for (const DxfEntity& entity : drawing.entities()) {
        const std::string kind{entity.type};
        if ((layer.empty() || layer_of(entity, "") == layer) &&
            kinds.find(kind) == std::string::npos) {
            kinds += (kinds.empty() ? "" : ", ") + kind;
        }
    }
    std::string text = layer.empty()
                           ? drawing.file() + ": the drawing holds no curve"
                           : fmt::format("{}: no curve on the layer \"{}\"", drawing.file(), layer);
    if (!kinds.empty()) {
        text += fmt::format("; it holds {}: convert {} to curves in the drawing program", kinds,
                            kinds.find("TEXT") != std::string::npos ? "text" : "them");
    } else if (!layer.empty()) {
        text += nearest_layers(layer, drawing.layers());
    }
    return text;
}

}  // namespace

DrawnPaths read_dxf_paths(const std::string& file,
                          double millimetres,
                          const std::string& layer,
                          std::vector<std::string>* notes)
{
    const Reader reader{file, millimetres};
    DxfPieces drawn = reader.read(layer);
    if (drawn.paths.empty()) {
        throw InputError(no_curve(reader.drawing(), layer));
    }
    if (notes != nullptr) {
        reader.add_notes(layer, drawn, true, *notes);
    }
    return {std::move(drawn.paths), reader.drawing().resolution()};
}

DrawnPlaces read_dxf_places(const std::string& file,
                            double millimetres,
                            const std::string& layer,
                            std::vector<std::string>* notes)
{
    const Reader reader{file, millimetres};
    const DxfPieces drawn = reader.read(layer);
    if (notes != nullptr) {
        reader.add_notes(layer, drawn, false, *notes);
    }
    DrawnPlaces places{{}, curves_of(drawn.paths)};
    for (const DrawingPath& point : drawn.points) {
        places.points.push_back(in_plan(point.curves.front().points.front()));
    }
    return places;
}

DrawnLayers read_dxf_layers(const std::string& file, double millimetres)
{
    const Reader reader{file, millimetres};
    const DxfDrawing& drawing = reader.drawing();
    DrawnLayers out{
        drawing.unit(), drawing.unit_name(), drawing.resolution(), {}, reader.notes_on_file()};
    for (const std::string& name : drawing.layers()) {
        DrawnLayer layer{name, drawing.hidden(name), {}, {}};
        try {
            DxfPieces drawn = reader.read(name);
            layer.paths = std::move(drawn.paths);
            for (std::string& note : reader.notes_on_layer(name, drawn, true)) {
                out.notes.push_back(std::move(note));
            }
        } catch (const InputError& error) {
            layer.problem = error.what();
        }
        if (!layer.paths.empty() || !layer.problem.empty()) {
            out.layers.push_back(std::move(layer));
        }
    }
    if (out.layers.empty()) {
        throw InputError(no_curve(drawing, ""));
    }
    return out;
}

}  // namespace cusp::import
