// HarfBuzz works in the font's own units, which are whole numbers.
#include "host_tools/job/import/outline_font.hpp"

#include <hb-ot.h>
#include <hb.h>
#include <utility>

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/svg_transform.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

template <class Type, void (*kDestroy)(Type*)>
struct Destroy {
    void operator()(Type* object) const { kDestroy(object); }
};

template <class Type, void (*kDestroy)(Type*)>
using HarfBuzzObject = std::unique_ptr<Type, Destroy<Type, kDestroy>>;

using Blob = HarfBuzzObject<hb_blob_t, hb_blob_destroy>;
using Face = HarfBuzzObject<hb_face_t, hb_face_destroy>;
using Font = HarfBuzzObject<hb_font_t, hb_font_destroy>;
using Buffer = HarfBuzzObject<hb_buffer_t, hb_buffer_destroy>;
using DrawFunctions = HarfBuzzObject<hb_draw_funcs_t, hb_draw_funcs_destroy>;

// The outline of a glyph as HarfBuzz tells it: pieces from the current point on.
struct Pen {
    std::vector<DrawingPath> paths;
    DrawingPath path{};
    Vec2d here{};

    void draw(std::vector<Vec2d> points)
    {
        points.insert(points.begin(), here);
        here = points.back();
        if (has_extent(points)) {
            path.curves.push_back(bezier_curve(points));
        }
    }

    void close()
    {
        path.closed = true;
        if (!path.curves.empty()) {
            paths.push_back(std::move(path));
        }
        path = {};
    }

    static bool has_extent(const std::vector<Vec2d>& points)
    {
        for (const Vec2d p : points) {
            if (p.x != points.front().x || p.y != points.front().y) {
                return true;
            }
        }
        return false;
    }
};

void move_to(hb_draw_funcs_t* /*functions*/,
             void* pen,
             hb_draw_state_t* /*state*/,
             float x,
             float y,
             void* /*user*/)
{
    static_cast<Pen*>(pen)->here = {x, y};
}

void line_to(hb_draw_funcs_t* /*functions*/,
             void* pen,
             hb_draw_state_t* /*state*/,
             float x,
             float y,
             void* /*user*/)
{
    static_cast<Pen*>(pen)->draw({{x, y}});
}

void quadratic_to(hb_draw_funcs_t* /*functions*/,
                  void* pen,
                  hb_draw_state_t* /*state*/,
                  float x1,
                  float y1,
                  float x,
                  float y,
                  void* /*user*/)
{
    static_cast<Pen*>(pen)->draw({{x1, y1}, {x, y}});
}

void cubic_to(hb_draw_funcs_t* /*functions*/,
              void* pen,
              hb_draw_state_t* /*state*/,
              float x1,
              float y1,
              float x2,
              float y2,
              float x,
              float y,
              void* /*user*/)
{
    static_cast<Pen*>(pen)->draw({{x1, y1}, {x2, y2}, {x, y}});
}

void close_path(hb_draw_funcs_t* /*functions*/,
                void* pen,
                hb_draw_state_t* /*state*/,
                void* /*user*/)
{
    static_cast<Pen*>(pen)->close();
}

}  // namespace

struct OutlineFont::Parts {
    std::string file;
    std::string bytes;
    Font font;
    DrawFunctions functions;

    std::vector<DrawingPath> outline(hb_codepoint_t glyph) const
    {
        Pen pen;
        hb_font_get_glyph_shape(font.get(), glyph, functions.get(), &pen);
        return std::move(pen.paths);
    }
};

OutlineFont::OutlineFont(const std::string& file) : parts_{std::make_unique<Parts>()}
{
    parts_->file = file;
    parts_->bytes = files::text_of_file(file);
    const std::string& bytes = parts_->bytes;
    const Blob blob{hb_blob_create(bytes.data(), static_cast<unsigned int>(bytes.size()),
                                   HB_MEMORY_MODE_READONLY, nullptr, nullptr)};
    const Face face{hb_face_create(blob.get(), 0)};
    if (hb_face_get_glyph_count(face.get()) == 0) {
        throw InputError(
            fmt::format("{}: no font: TrueType or OpenType is needed (.ttf, .otf)", file));
    }
    parts_->font.reset(hb_font_create(face.get()));
    parts_->functions.reset(hb_draw_funcs_create());
    hb_draw_funcs_t* const functions = parts_->functions.get();
    hb_draw_funcs_set_move_to_func(functions, move_to, nullptr, nullptr);
    hb_draw_funcs_set_line_to_func(functions, line_to, nullptr, nullptr);
    hb_draw_funcs_set_quadratic_to_func(functions, quadratic_to, nullptr, nullptr);
    hb_draw_funcs_set_cubic_to_func(functions, cubic_to, nullptr, nullptr);
    hb_draw_funcs_set_close_path_func(functions, close_path, nullptr, nullptr);
    if (!(size().capital > 0)) {
        throw InputError(fmt::format("{}: the font has no capital H to measure its size by", file));
    }
}

OutlineFont::~OutlineFont() = default;

FontSize OutlineFont::size() const
{
    hb_font_t* const font = parts_->font.get();
    hb_codepoint_t glyph{};
    hb_glyph_extents_t box{};
    const bool has_h = hb_font_get_nominal_glyph(font, U'H', &glyph) != 0 &&
                       hb_font_get_glyph_extents(font, glyph, &box) != 0;
    hb_font_extents_t lines{};
    hb_font_get_h_extents(font, &lines);
    return {has_h ? static_cast<double>(box.y_bearing) : 0,
            static_cast<double>(lines.ascender - lines.descender + lines.line_gap)};
}

FontLine OutlineFont::line(const std::string& text, const std::string& place) const
{
    const Buffer buffer{hb_buffer_create()};
    hb_buffer_add_utf8(buffer.get(), text.data(), static_cast<int>(text.size()), 0,
                       static_cast<int>(text.size()));
    hb_buffer_guess_segment_properties(buffer.get());
    hb_shape(parts_->font.get(), buffer.get(), nullptr, 0);
    unsigned int count{};
    const hb_glyph_info_t* const glyphs = hb_buffer_get_glyph_infos(buffer.get(), &count);
    const hb_glyph_position_t* const places = hb_buffer_get_glyph_positions(buffer.get(), &count);
    FontLine line;
    for (unsigned int k = 0; k < count; ++k) {
        if (glyphs[k].codepoint == 0) {
            throw InputError(fmt::format(
                "{}: the font {} does not have {}", place, parts_->file,
                name_of_character(characters_of(text.substr(glyphs[k].cluster)).front())));
        }
        PlacedLetter letter{parts_->outline(glyphs[k].codepoint), line.width,
                            static_cast<double>(places[k].x_advance)};
        if (places[k].x_offset != 0 || places[k].y_offset != 0) {
            const PlaneMap offset = moved_by(
                {static_cast<double>(places[k].x_offset), static_cast<double>(places[k].y_offset)});
            for (DrawingPath& path : letter.paths) {
                for (nurbs::Curve& curve : path.curves) {
                    curve = offset.of(std::move(curve));
                }
            }
        }
        line.width += letter.width;
        line.letters.push_back(std::move(letter));
    }
    return line;
}

}  // namespace cusp::import
