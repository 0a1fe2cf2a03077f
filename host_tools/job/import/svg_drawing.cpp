// The tree is walked once; each shape remembers the names of everything around it.
#include "host_tools/job/import/svg_drawing.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <set>
#include <string_view>
#include <utility>

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/drawing_notes.hpp"
#include "host_tools/job/import/nurbs_validity.hpp"
#include "host_tools/job/import/svg_shapes.hpp"
#include "host_tools/job/import/svg_text.hpp"
#include "host_tools/job/import/svg_transform.hpp"

#include "fmt/format.h"

namespace cusp::import {
namespace {

constexpr int kDeepest = 16;  // of `use` in `use`
constexpr int kDeepestElement = 256;
constexpr std::size_t kMost = 500000;  // elements, those that are used again counted again
constexpr const char* kNoLayer = "0";  // of shapes in no named group

// The paths of one shape.
struct SvgPiece {
    std::vector<DrawingPath> paths;  // mm
    std::string layer;
    std::vector<std::string> names;  // labels and ids, its own and those of the groups around it
    bool hidden{};
};

// Everything that holds for an element and all that is in it.
struct Surroundings {
    PlaneMap map;  // to millimetres, y upwards
    Vec2d viewport{};
    std::string layer{kNoLayer};
    std::vector<std::string> names;
    bool in_layer{};  // of Inkscape
    bool hidden{};
    int uses{};   // around it
    int depth{};  // of elements
};

bool is_group(const std::string& name)
{
    return name == "g" || name == "a" || name == "switch" || name == "svg" || name == "symbol";
}

// `name: value` in the attribute `style`, or the attribute `name`.
bool has_style(const pugi::xml_node& node, std::string_view name, std::string_view value)
{
    std::string style{node.attribute("style").value()};
    style.erase(std::remove_if(style.begin(), style.end(),
                               [](unsigned char c) { return std::isspace(c) != 0; }),
                style.end());
    const std::string wanted = fmt::format("{}:{}", name, value);
    const std::size_t at = (";" + style + ";").find(";" + wanted + ";");
    return at != std::string::npos || node.attribute(std::string{name}.c_str()).value() == value;
}

class SvgReader {
public:
    explicit SvgReader(const std::string& file) : file_{file}, text_{files::text_of_file(file)}
    {
        for (std::size_t k = 0; k < text_.size(); ++k) {
            if (text_[k] == '\n') {
                line_ends_.push_back(static_cast<std::ptrdiff_t>(k));
            }
        }
        const pugi::xml_parse_result parsed = document_.load_buffer(
            text_.data(), text_.size(), pugi::parse_default | pugi::parse_trim_pcdata);
        if (!parsed) {
            throw InputError(fmt::format("{}: no SVG drawing: {}", place_at(parsed.offset),
                                         parsed.description()));
        }
        const pugi::xml_node root = document_.document_element();
        if (svg_name(root) != "svg") {
            throw InputError(fmt::format("{}: no SVG drawing: it begins with <{}>", file_,
                                         std::string{root.name()}.substr(0, 40)));
        }
        collect_ids(root);
        Surroundings page;
        const PlaneMap on_page = viewport_map(root, page, page_size(root));
        constexpr double kMillimetre = 1 / kPixelsPerMillimetre;
        page.map =
            PlaneMap{{kMillimetre, 0}, {0, -kMillimetre}, {0, height_ * kMillimetre}} * on_page;
        unit_ = norm(page.map.x);
        walk_children(root, page);
    }

    const std::vector<SvgPiece>& pieces() const { return pieces_; }
    double unit() const { return unit_; }
    bool names_size() const { return names_size_; }

    std::vector<std::string> notes() const
    {
        std::vector<std::string> notes;
        if (!names_size_) {
            notes.push_back(
                fmt::format("{}: no width or height in mm or inches: 1 unit of the drawing is "
                            "{:.6g} mm, 96 an inch",
                            file_, unit_));
        }
        if (texts_ > 0) {
            note_texts(file_, texts_, first_text_, notes);
        }
        note_left_out(file_, left_out_, notes);
        return notes;
    }

    std::string no_curve(const std::string& layer) const
    {
        if (layer.empty()) {
            return fmt::format("{}: the drawing holds no curve{}", file_,
                               texts_ > 0 ? "; convert text to curves in the drawing program" : "");
        }
        std::set<std::string> names;
        for (const SvgPiece& piece : pieces_) {
            names.insert(piece.layer);
        }
        return fmt::format("{}: no curve on the layer \"{}\"", file_, layer) +
               nearest_layers(layer, names);
    }

private:
    std::string place_at(std::ptrdiff_t offset) const
    {
        const auto line = std::lower_bound(line_ends_.begin(), line_ends_.end(), offset);
        return fmt::format("{}:{}", file_, 1 + (line - line_ends_.begin()));
    }

    std::string place_of(const pugi::xml_node& node) const { return place_at(node.offset_debug()); }

    void collect_ids(const pugi::xml_node& node)
    {
        for (pugi::xml_node at = node; at;) {
            if (const pugi::xml_attribute id = at.attribute("id")) {
                ids_.emplace(id.value(), at);
            }
            if (at.first_child()) {
                at = at.first_child();
                continue;
            }
            while (at && at != node && !at.next_sibling()) {
                at = at.parent();
            }
            at = at == node ? pugi::xml_node{} : at.next_sibling();
        }
    }

    // Pixels of the page, 0 where neither a size nor a view box names it.
    Vec2d page_size(const pugi::xml_node& root)
    {
        const auto size = [&](const char* name) -> std::optional<double> {
            const auto length = svg_length(root.attribute(name).value());
            if (!length || length->relative) {
                return std::nullopt;
            }
            names_size_ = names_size_ || length->absolute;
            return length->pixels;
        };
        const auto width = size("width");
        const auto height = size("height");
        const auto box = view_box(root);
        const Vec2d whole = box ? box->size : Vec2d{};
        // A page with one size keeps the proportions of its view box.
        const double along = box && width    ? *width / whole.x
                             : box && height ? *height / whole.y
                                             : 1;
        height_ = height.value_or(along * whole.y);
        return {width.value_or(along * whole.x), height_};
    }

    struct ViewBox {
        Vec2d low, size;
    };

    std::optional<ViewBox> view_box(const pugi::xml_node& node) const
    {
        const pugi::xml_attribute given = node.attribute("viewBox");
        if (!given) {
            return std::nullopt;
        }
        SvgText text{given.value()};
        const auto x = text.number(), y = text.number(), width = text.number(),
                   height = text.number();
        if (!x || !y || !width || !height || !(*width > 0) || !(*height > 0)) {
            throw InputError(fmt::format(
                "{}: viewBox: \"{}\": four numbers are needed, width and height above 0",
                place_of(node), std::string{given.value()}.substr(0, 40)));
        }
        return ViewBox{{*x, *y}, {*width, *height}};
    }

    // From the coordinates in a drawing, or a symbol, to those of the place that it has.
    PlaneMap viewport_map(const pugi::xml_node& node, Surroundings& around, Vec2d size) const
    {
        const auto box = view_box(node);
        if (!box) {
            around.viewport = size;
            return {};
        }
        around.viewport = box->size;
        if (!(size.x > 0 && size.y > 0)) {
            return moved_by({-box->low.x, -box->low.y});
        }
        Vec2d scale{size.x / box->size.x, size.y / box->size.y};
        const std::string aspect{node.attribute("preserveAspectRatio").value()};
        Vec2d free{};
        if (aspect.find("none") == std::string::npos) {
            const bool slice = aspect.find("slice") != std::string::npos;
            scale.x = scale.y = slice ? std::max(scale.x, scale.y) : std::min(scale.x, scale.y);
            const auto share = [&](const char* low, const char* high) {
                return aspect.find(low) != std::string::npos    ? 0.0
                       : aspect.find(high) != std::string::npos ? 1.0
                                                                : 0.5;
            };
            free = {share("xMin", "xMax") * (size.x - scale.x * box->size.x),
                    share("YMin", "YMax") * (size.y - scale.y * box->size.y)};
        }
        return moved_by(free) * stretched_by(scale.x, scale.y) *
               moved_by({-box->low.x, -box->low.y});
    }

    void walk_children(const pugi::xml_node& node, const Surroundings& around)
    {
        for (const pugi::xml_node& child : node.children()) {
            if (child.type() == pugi::node_element) {
                walk(child, around);
            }
        }
    }

    void walk(const pugi::xml_node& node, Surroundings here)
    {
        if (++here.depth > kDeepestElement) {
            throw InputError(
                fmt::format("{}: elements more than {} deep", place_of(node), kDeepestElement));
        }
        if (++walked_ > kMost) {
            throw InputError(fmt::format("{}: more than {} elements", place_of(node), kMost));
        }
        const std::string name = svg_name(node);
        const bool group = is_group(name);
        if (name == "symbol" && here.uses == 0) {
            return;  // drawn where it is used
        }
        add_names(node, group && name != "symbol", here);
        here.hidden = here.hidden || has_style(node, "display", "none") ||
                      has_style(node, "visibility", "hidden");
        if (const pugi::xml_attribute transform = node.attribute("transform")) {
            here.map = here.map * plane_map(transform.value(), place_of(node));
        }
        if (group) {
            if (name == "svg") {
                enter(
                    node, here,
                    {svg_length_of(node, "width", here.viewport.x, here.viewport.x, place_of(node)),
                     svg_length_of(node, "height", here.viewport.y, here.viewport.y,
                                   place_of(node))});
            }
            walk_children(node, here);
        } else if (name == "use") {
            use(node, here);
        } else if (is_svg_shape(name)) {
            draw(node, here);
        } else if (name == "text") {
            first_text_ =
                texts_ == 0
                    ? here.map.of({svg_length_of(node, "x", here.viewport.x, 0, place_of(node)),
                                   svg_length_of(node, "y", here.viewport.y, 0, place_of(node))})
                    : first_text_;
            ++texts_;
        } else if (name == "image" || name == "foreignObject") {
            ++left_out_[name];
        }
    }

    // A nested drawing or a symbol of that size.
    void enter(const pugi::xml_node& node, Surroundings& here, Vec2d size) const
    {
        const std::string place = place_of(node);
        const Vec2d at{svg_length_of(node, "x", here.viewport.x, 0, place),
                       svg_length_of(node, "y", here.viewport.y, 0, place)};
        here.map = here.map * moved_by(at);
        here.map = here.map * viewport_map(node, here, size);
    }

    void use(const pugi::xml_node& node, Surroundings here)
    {
        const std::string place = place_of(node);
        const pugi::xml_attribute plain = node.attribute("href");
        const std::string target{(plain ? plain : node.attribute("xlink:href")).value()};
        const auto found =
            target.empty() || target[0] != '#' ? ids_.end() : ids_.find(target.substr(1));
        if (found == ids_.end()) {
            throw InputError(fmt::format("{}: use: \"{}\" is no object of this drawing", place,
                                         target.substr(0, 60)));
        }
        if (++here.uses > kDeepest) {
            throw InputError(fmt::format("{}: use: \"{}\" is more than {} deep", place,
                                         target.substr(0, 60), kDeepest));
        }
        here.map = here.map * moved_by({svg_length_of(node, "x", here.viewport.x, 0, place),
                                        svg_length_of(node, "y", here.viewport.y, 0, place)});
        if (svg_name(found->second) == "symbol") {
            const Vec2d whole = here.viewport;
            here.map =
                here.map * viewport_map(found->second, here,
                                        {svg_length_of(node, "width", whole.x, whole.x, place),
                                         svg_length_of(node, "height", whole.y, whole.y, place)});
        }
        walk(found->second, here);
    }

    // Inkscape's labels are what people see; ids are there in all programs.
    static void add_names(const pugi::xml_node& node, bool group, Surroundings& here)
    {
        const std::string label{node.attribute("inkscape:label").value()};
        const std::string id{node.attribute("id").value()};
        for (const std::string& name : {id, label}) {
            if (!name.empty()) {
                here.names.push_back(name);
            }
        }
        const bool layer =
            node.attribute("inkscape:groupmode").value() == std::string_view{"layer"};
        const bool outermost = !here.in_layer && here.layer == kNoLayer;
        if (group && (layer || outermost) && !(label.empty() && id.empty())) {
            here.layer = here.names.back();
            here.in_layer = layer;
        }
    }

    void draw(const pugi::xml_node& node, const Surroundings& here)
    {
        const std::string place = place_of(node);
        if (here.map.determinant() == 0) {
            return;  // stretched to nothing
        }
        SvgPiece piece{paths_of_shape(node, here.viewport, place), here.layer, here.names,
                       here.hidden};
        for (DrawingPath& path : piece.paths) {
            for (nurbs::Curve& curve : path.curves) {
                curve = here.map.of(std::move(curve));
                check_curve(curve, place, kLargestDrawn);
            }
        }
        if (!piece.paths.empty()) {
            pieces_.push_back(std::move(piece));
        }
    }

    std::string file_;
    std::string text_;
    std::vector<std::ptrdiff_t> line_ends_;  // places in the text
    pugi::xml_document document_;
    std::map<std::string, pugi::xml_node> ids_;
    std::vector<SvgPiece> pieces_;
    std::map<std::string, std::size_t> left_out_;
    std::size_t texts_{};
    std::size_t walked_{};
    Vec2d first_text_{};  // mm
    double height_{};     // of the page, pixels
    double unit_{};       // mm
    bool names_size_{};   // in millimetres, inches ...
};

}  // namespace

DrawnPaths read_svg_paths(const std::string& file,
                          const std::string& layer,
                          std::vector<std::string>* notes)
{
    const SvgReader reader{file};
    DrawnPaths drawn;
    const bool is_layer = std::any_of(reader.pieces().begin(), reader.pieces().end(),
                                      [&](const SvgPiece& piece) { return piece.layer == layer; });
    for (const SvgPiece& piece : reader.pieces()) {
        const bool named =
            std::find(piece.names.begin(), piece.names.end(), layer) != piece.names.end();
        const bool wanted = layer.empty() ? !piece.hidden : is_layer ? piece.layer == layer : named;
        if (wanted) {
            drawn.paths.insert(drawn.paths.end(), piece.paths.begin(), piece.paths.end());
        }
    }
    if (drawn.paths.empty()) {
        throw InputError(reader.no_curve(layer));
    }
    if (notes != nullptr) {
        const std::vector<std::string> said = reader.notes();
        notes->insert(notes->end(), said.begin(), said.end());
        note_far(file, drawn.paths, *notes);
    }
    return drawn;
}

DrawnLayers read_svg_layers(const std::string& file)
{
    const SvgReader reader{file};
    const bool millimetres = std::abs(reader.unit() - 1) < 1e-9;
    const std::string name_of_unit = millimetres           ? "millimetres"
                                     : reader.names_size() ? fmt::format("{:.6g} mm", reader.unit())
                                                           : "pixels";
    DrawnLayers out{reader.unit(), name_of_unit, 0, {}, reader.notes()};
    std::map<std::string, DrawnLayer> layers;
    for (const SvgPiece& piece : reader.pieces()) {
        DrawnLayer& layer =
            layers.try_emplace(piece.layer, DrawnLayer{piece.layer, true, {}, {}}).first->second;
        layer.hidden = layer.hidden && piece.hidden;
        layer.paths.insert(layer.paths.end(), piece.paths.begin(), piece.paths.end());
    }
    for (auto& [name, layer] : layers) {
        note_far(file, layer.paths, out.notes);
        out.layers.push_back(std::move(layer));
    }
    if (out.layers.empty()) {
        throw InputError(reader.no_curve(""));
    }
    return out;
}

}  // namespace cusp::import
