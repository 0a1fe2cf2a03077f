// Turns first, then measures what the turn has left, then shifts.
#include "host_tools/job/import/placing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "host_tools/base/elementary/elementary.hpp"
#include "host_tools/job/import/mesh_file.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/import/relief_facets.hpp"

#include "fmt/format.h"

namespace cusp::import {

namespace {

// Cosine and sine, exact for quarter turns.
std::array<double, 2> direction_of(double degrees)
{
    constexpr double kQuarter = 90.0;
    const double quarters = degrees / kQuarter;
    if (quarters == std::floor(quarters)) {
        constexpr std::array<std::array<double, 2>, 4> kTurns{
            {{{1, 0}}, {{0, 1}}, {{-1, 0}}, {{0, -1}}}};
        return kTurns[static_cast<std::size_t>(quarters - 4 * std::floor(quarters / 4))];
    }
    const double angle = degrees * elementary::acos(-1.0) / 180;
    return {elementary::cos(angle), elementary::sin(angle)};
}

// About x (0), y (1) or z (2).
Similarity turn_about(std::size_t axis, double degrees)
{
    const auto [c, s] = direction_of(degrees);
    const std::size_t from = (axis + 1) % 3;
    const std::size_t to = (axis + 2) % 3;
    Similarity turn;
    turn.axes[from] = c * turn.axes[from] + s * Similarity{}.axes[to];
    turn.axes[to] = c * Similarity{}.axes[to] - s * Similarity{}.axes[from];
    return turn;
}

Similarity turn_to_z(const std::string& up)
{
    return up == "+x"   ? turn_about(1, -90)
           : up == "-x" ? turn_about(1, 90)
           : up == "+y" ? turn_about(0, 90)
           : up == "-y" ? turn_about(0, -90)
           : up == "-z" ? turn_about(0, 180)
                        : Similarity{};
}

Similarity scaling(double factor)
{
    Similarity scaled;
    for (Vec3d& axis : scaled.axes) {
        axis = factor * axis;
    }
    return scaled;
}

// Without the "#layer" of a drawing.
std::string file_of(const std::string& name)
{
    const std::string file = name.substr(0, layer_mark(name));
    return is_drawing_file(file) ? file : name;
}

bool has(const std::vector<std::string>& list, const std::string& text)
{
    return std::find(list.begin(), list.end(), text) != list.end();
}

// Each file once, in the order of the job.
std::vector<std::string> distinct(const std::vector<std::string>& names)
{
    std::vector<std::string> files;
    for (const std::string& name : names) {
        if (!has(files, file_of(name))) {
            files.push_back(file_of(name));
        }
    }
    return files;
}

void check_files(const std::vector<Placing>& placings, const PlacedFiles& files)
{
    std::vector<std::string> known = distinct(files.parts);
    const std::vector<std::string> drawings = distinct(files.drawings);
    known.insert(known.end(), drawings.begin(), drawings.end());
    std::vector<std::string> named;
    bool has_general = false;
    for (const Placing& placing : placings) {
        if (placing.files.empty() && has_general) {
            throw PlacingError("two tables have no file: one can be for all other files");
        }
        has_general = has_general || placing.files.empty();
        for (const std::string& file : placing.files) {
            if (!has(known, file)) {
                throw PlacingError(fmt::format("{} is no file that an operation names", file));
            }
            if (has(named, file)) {
                throw PlacingError(fmt::format("{} is placed twice", file));
            }
            named.push_back(file);
        }
    }
}

class Placer {
public:
    Placer(const PlacedFiles& files, double millimetres, PartFiles& parts)
        : files_{distinct(files.parts), distinct(files.drawings)},
          layers_{files.drawings},
          millimetres_{millimetres},
          parts_{parts}
    {
    }

    // named  files of all other placings
    void place(const Placing& placing, const std::vector<std::string>& named) const
    {
        const auto governs = [&](const std::string& file) {
            return placing.files.empty() ? !has(named, file) : has(placing.files, file);
        };
        PlacedFiles governed;
        std::copy_if(files_.parts.begin(), files_.parts.end(), std::back_inserter(governed.parts),
                     governs);
        std::copy_if(files_.drawings.begin(), files_.drawings.end(),
                     std::back_inserter(governed.drawings), governs);
        if (placing.relief &&
            std::none_of(governed.parts.begin(), governed.parts.end(), is_picture_file)) {
            throw PlacingError("width and heights are for pictures, .png");
        }
        for (const std::string& file : governed.parts) {
            parts_.place(file, turn_of(placing));
            if (placing.relief && is_picture_file(file)) {
                parts_.size_relief(file, *placing.relief);
            }
        }
        for (const std::string& file : governed.drawings) {
            parts_.place(file, turn_of_drawing(placing));
        }
        const Vec3d shift =
            placing.origin.empty() ? placing.move : shift_of(placing, box_of(governed));
        for (const std::string& file : governed.parts) {
            parts_.shift(file, shift);
        }
        for (const std::string& file : governed.drawings) {
            parts_.shift(file, {shift.x, shift.y, 0});
        }
        copy(placing, governed);
    }

private:
    void copy(const Placing& placing, const PlacedFiles& governed) const
    {
        if (placing.copies.empty()) {
            return;
        }
        for (const auto* const files : {&governed.parts, &governed.drawings}) {
            for (const std::string& file : *files) {
                parts_.copy(file, moves_of(placing.copies));
            }
        }
    }

    static constexpr double kChord = 1e-3;  // mm, of the box of a mesh

    PartExtent box_of(const PlacedFiles& governed) const
    {
        std::optional<PartExtent> box;
        const auto add = [&](const PartExtent& more) {
            box = box ? joined(*box, more) : more;
        };
        for (const std::string& file : governed.parts) {
            add(is_mesh_file(file)
                    ? extent_of_triangles(parts_.mesh(file, millimetres_))
                    : extent_of_surfaces(parts_.surfaces(file, millimetres_, kChord)));
        }
        if (!box) {
            for (const std::string& name : layers_) {
                if (has(governed.drawings, file_of(name))) {
                    add(box_of_drawing(name));
                }
            }
        }
        return box.value_or(PartExtent{});
    }

    PartExtent box_of_drawing(const std::string& name) const
    {
        return extent_of_curves(parts_.curves(name, millimetres_));
    }

    PlacedFiles files_;
    std::vector<std::string> layers_;
    double millimetres_;
    PartFiles& parts_;
};

}  // namespace

Similarity turn_of(const Placing& placing)
{
    return scaling(placing.scale)
        .then(turn_to_z(placing.up))
        .then(turn_about(0, placing.rotate.x))
        .then(turn_about(1, placing.rotate.y))
        .then(turn_about(2, placing.rotate.z));
}

Similarity turn_of_drawing(const Placing& placing)
{
    return scaling(placing.scale).then(turn_about(2, placing.rotate.z));
}

std::vector<Similarity> moves_of(const std::vector<CopyPlace>& copies)
{
    std::vector<Similarity> moves;
    for (const CopyPlace& place : copies) {
        moves.push_back(turn_about(2, place.degrees));
        moves.back().shift = {place.at.x, place.at.y, 0};
    }
    return moves;
}

Vec3d shift_of(const Placing& placing, const PartExtent& box)
{
    Vec3d shift = placing.move;
    if (placing.origin == "corner") {
        shift = shift - Vec3d{box.low.x, box.low.y, 0};
    } else if (placing.origin == "centre") {
        shift = shift - Vec3d{(box.low.x + box.high.x) / 2, (box.low.y + box.high.y) / 2, 0};
    }
    return placing.origin.empty() ? shift : shift - Vec3d{0, 0, box.high.z};
}

void place_parts(const std::vector<Placing>& placings,
                 const PlacedFiles& files,
                 double millimetres,
                 PartFiles& parts)
{
    check_files(placings, files);
    std::vector<std::string> named;
    for (const Placing& placing : placings) {
        named.insert(named.end(), placing.files.begin(), placing.files.end());
    }
    const Placer placer{files, millimetres, parts};
    for (const Placing& placing : placings) {
        placer.place(placing, named);
    }
    parts.finish_placing();
}

}  // namespace cusp::import
