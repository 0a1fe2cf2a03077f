// The objects of a DXF drawing: pairs of lines, a group code, then its value. Code 0 starts an
// object.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace cusp::import {

struct DxfGroup {
    int code;
    std::string_view value;
    int line;  // of the value
};

struct DxfEntity {
    std::string_view type;
    int line;
    std::vector<DxfGroup> groups;
};

// A named group of objects that INSERT draws again.
struct DxfBlock {
    DxfEntity head;  // with its base point
    std::vector<DxfEntity> entities;
};

// Reads a file. References that it returns are valid as long as it lives. All errors are InputError
// with file and line.
class DxfDrawing {
public:
    // millimetres  of one unit, where the drawing names none: neither by $INSUNITS nor by $MEASUREMENT
    DxfDrawing(std::string file, double millimetres);
    DxfDrawing(const DxfDrawing&) = delete;
    DxfDrawing& operator=(const DxfDrawing&) = delete;

    const std::vector<DxfEntity>& entities() const { return entities_; }
    // Names match in any case; no such block: nullptr.
    const DxfBlock* block(std::string_view name) const;
    double unit() const { return unit_; }  // mm
    // As the drawing names it, "centimetres"; "": it names none.
    const std::string& unit_name() const { return unit_name_; }
    // A sentence on the unit where it is not the one that was handed in; else "".
    const std::string& unit_note() const { return unit_note_; }
    // mm: one unit of the last decimal place that coordinates of curves are written with; 0 where they
    // are whole numbers.
    double resolution() const;
    // True if anything may lie off the plane of x and y.
    bool has_depth() const;
    // The names of all layers that objects are on, those in blocks included, in order.
    std::set<std::string> layers() const;
    // Layers that are switched off or frozen draw nothing.
    bool hidden(std::string_view layer) const { return hidden_.count(layer) > 0; }

    static std::string_view text(const DxfEntity& entity, int code, std::string_view otherwise);
    double number(const DxfGroup& group) const;
    double value(const DxfEntity& entity, int code, double otherwise) const;
    double required(const DxfEntity& entity, int code) const;
    std::vector<double> values(const DxfEntity& entity, int code) const;
    // A bit field, clamped to 0 ... 65535: the conversion of other values is undefined.
    unsigned flags(const DxfEntity& entity, int code, unsigned otherwise = 0) const
    {
        constexpr double kMost = 65535;
        return static_cast<unsigned>(std::clamp(value(entity, code, otherwise), 0.0, kMost));
    }
    [[noreturn]] void refuse(int line, const std::string& reason) const;
    const std::string& file() const { return file_; }

private:
    std::vector<DxfGroup> groups() const;
    // Calls visit(group) for every group of objects and blocks.
    template <class Visit>
    void each_group(const Visit& visit) const;
    const DxfGroup* header_value(std::string_view name) const;
    std::vector<DxfEntity> section(std::string_view wanted, bool& found) const;
    void read_unit();
    void read_layers();
    void read_blocks();

    std::string file_;
    std::string text_;
    double unit_;
    std::string unit_name_;
    std::string unit_note_;
    std::vector<DxfGroup> groups_;
    std::set<std::string_view> hidden_;
    std::map<std::string, DxfBlock> blocks_;
    std::vector<DxfEntity> entities_;
};

}  // namespace cusp::import
