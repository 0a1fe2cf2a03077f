// One cache for each kind of geometry.
#include "host_tools/job/import/part_files.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/drawn_shapes.hpp"
#include "host_tools/job/import/mesh_file.hpp"
#include "host_tools/job/import/mesh_holes.hpp"
#include "host_tools/job/import/nurbs_validity.hpp"
#include "host_tools/job/import/part_edges.hpp"
#include "host_tools/job/import/part_regions.hpp"
#include "host_tools/job/import/path_ending.hpp"
#include "host_tools/job/job/loop_shape.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::import {

using nurbs::Curve;
using nurbs::Surface;

namespace {

// Seen from above: curves of drawings lie in x and y.
void move_curves(const Similarity& placed, std::vector<Curve>& curves)
{
    for (Curve& curve : curves) {
        for (Vec3d& point : curve.points) {
            point = placed.of(point);
        }
    }
}

void move_loops(const Similarity& placed, std::vector<FileLoop>& loops)
{
    // seen from below, a loop goes the other way round
    const bool mirrors = placed.axes[0].x * placed.axes[1].y < placed.axes[0].y * placed.axes[1].x;
    for (FileLoop& found : loops) {
        move_curves(placed, found.loop);
        if (mirrors) {
            found.loop = job::reversed(found.loop);
        }
    }
}

// Drawings may be far away until they are placed.
void check_place(const std::vector<Curve>& curves, const std::string& name)
{
    for (const Curve& curve : curves) {
        for (const Vec3d& p : curve.points) {
            if (std::max(std::abs(p.x), std::abs(p.y)) > kLargestCoordinate) {
                throw InputError(fmt::format(
                    "{}: drawn at x {:.10g} y {:.10g} mm, the limit is {:g}: [placing] with origin "
                    "= \"corner\" moves it to the origin",
                    name, p.x, p.y, kLargestCoordinate));
            }
        }
    }
}

std::array<Vec3d, 3> moved(const Similarity& place, const std::array<Vec3d, 3>& facet)
{
    return {place.of(facet[0]), place.of(facet[1]), place.of(facet[2])};
}

Surface moved(const Similarity& place, Surface surface)
{
    for (Vec3d& point : surface.points) {
        point = place.of(point);
    }
    return surface;
}

// Drawings and holes are seen from above.
std::vector<Curve> moved(const Similarity& place, std::vector<Curve> curves)
{
    move_curves(place, curves);
    return curves;
}

Curve moved(const Similarity& place, const Curve& curve)
{
    return moved(place, std::vector{curve}).front();
}

job::OpenChain moved(const Similarity& place, job::OpenChain chain)
{
    move_curves(place, chain.pieces);
    return chain;
}

job::Hole moved(const Similarity& place, job::Hole hole)
{
    hole.at = in_plan(place.of({hole.at.x, hole.at.y, 0}));
    return hole;
}

std::string without_layer(const std::string& name) { return name.substr(0, layer_mark(name)); }

void check_apart(const std::vector<FileLoop>& copies)
{
    constexpr double kChord = 5e-3;     // mm
    constexpr double kTouching = 1e-2;  // mm: copies side by side may have an edge in common
    std::vector<std::vector<Vec2d>> outlines;
    for (const FileLoop& loop : copies) {
        outlines.push_back(job::loop_polyline(loop.loop, kChord));
    }
    if (const auto at = job::crossing_of(outlines, kTouching)) {
        throw InputError(
            fmt::format("{}: copies cross at x {:.6g} y {:.6g} mm: place them farther apart",
                        without_layer(copies.front().name), at->x, at->y));
    }
}

// Each item in all places, one after the other: the order by size stays.
template <class Item>
void repeat(const std::vector<Similarity>& places, std::vector<Item>& items)
{
    if (places.empty()) {
        return;
    }
    std::vector<Item> all;
    all.reserve(places.size() * items.size());
    for (const Item& item : items) {
        for (const Similarity& place : places) {
            all.push_back(moved(place, item));
        }
    }
    items = std::move(all);
}

// Errors: InputError where copies cross.
void repeat(const std::vector<Similarity>& places, std::vector<FileLoop>& loops)
{
    if (places.empty()) {
        return;
    }
    const int count = static_cast<int>(places.size());
    std::vector<FileLoop> all;
    for (const FileLoop& loop : loops) {
        for (int i = 0; i < count; ++i) {
            FileLoop copy = loop;
            copy.parent = loop.parent < 0 ? -1 : loop.parent * count + i;
            copy.name += i > 0 ? fmt::format(", copy {}", i + 1) : "";
            move_curves(places[static_cast<std::size_t>(i)], copy.loop);
            all.push_back(std::move(copy));
        }
    }
    check_apart(all);
    loops = std::move(all);
}

}  // namespace

Similarity PartFiles::placed(const std::string& file) const
{
    const auto found = placed_.find(file);
    return found == placed_.end() ? turn_ : found->second.then(turn_);
}

std::optional<ReliefSize> PartFiles::relief(const std::string& file) const
{
    const auto found = reliefs_.find(file);
    return found == reliefs_.end() ? std::nullopt : std::optional{found->second};
}

std::vector<Similarity> PartFiles::copies(const std::string& name) const
{
    const auto found = copies_.find(copies_.count(name) > 0 ? name : without_layer(name));
    if (found == copies_.end() || names_part_region(name)) {
        return {};  // regions are those of all copies
    }
    std::vector<Similarity> places;
    for (const Similarity& place : found->second) {
        places.push_back(turn_.inverse().then(place).then(turn_));
    }
    return places;
}

const std::vector<Surface>& PartFiles::surfaces(const std::string& file,
                                                double millimetres,
                                                double mesh_tolerance)
{
    // Only a mesh depends on the tolerance.
    const double tolerance = is_mesh_file(file) ? mesh_tolerance : 0;
    const auto [found, is_new] = surfaces_.try_emplace({file, tolerance});
    if (is_new) {
        found->second =
            read_surfaces(file, millimetres, tolerance, &notes_, placed(file), relief(file));
        repeat(copies(file), found->second);
    }
    return found->second;
}

const Triangles& PartFiles::mesh(const std::string& file, double millimetres)
{
    const auto [found, is_new] = meshes_.try_emplace(file);
    if (is_new) {
        found->second = read_mesh(file, millimetres, &notes_, placed(file), relief(file));
        repeat(copies(file), found->second);
    }
    return found->second;
}

void PartFiles::close_mesh(const std::vector<std::string>& files, Triangles& mesh)
{
    std::vector<std::string> said;
    cover_holes(fmt::format("{}", fmt::join(files, ", ")), mesh, said);
    for (const std::string& sentence : said) {
        if (std::find(notes_.begin(), notes_.end(), sentence) == notes_.end()) {
            note(sentence);
        }
    }
}

const std::vector<FileLoop>& PartFiles::loops(const std::string& file,
                                              double millimetres,
                                              EndDistance gaps)
{
    const auto [found, is_new] = loops_.try_emplace({file, gaps.least, gaps.given.value_or(-1)});
    if (is_new) {
        const DrawnPaths* const drawn = this->drawn(file, millimetres);
        found->second = drawn == nullptr ? read_loops(file, millimetres, gaps, notes_)
                                         : loops_of(file, *drawn, gaps, notes_);
        if (names_broken_edges(file)) {
            keep_broken_edges(file, millimetres, facets(without_layer(file), millimetres),
                              found->second);
        }
        move_loops(placed_drawing(file), found->second);
        repeat(copies(file), found->second);
        for (const FileLoop& loop : found->second) {
            check_place(loop.loop, file);
        }
    }
    return found->second;
}

FileShapes PartFiles::shapes(const std::string& file,
                             const std::vector<std::string>& layers,
                             double millimetres,
                             EndDistance gaps)
{
    const Similarity move = placed_drawing(file);
    const DrawnPaths* const drawn = this->drawn(file, millimetres);
    FileShapes shapes = drawn == nullptr ? read_shapes(file, layers, millimetres, gaps, notes_)
                                         : shapes_of(file, *drawn, gaps, notes_);
    if (names_broken_edges(file)) {
        keep_broken_edges(file, millimetres, facets(without_layer(file), millimetres),
                          shapes.loops);
    }
    move_loops(move, shapes.loops);
    repeat(copies(file), shapes.loops);
    for (const FileLoop& loop : shapes.loops) {
        check_place(loop.loop, file);
    }
    repeat({move}, shapes.open);
    repeat(copies(file), shapes.open);
    for (const job::OpenChain& chain : shapes.open) {
        check_place(chain.pieces, file);
    }
    return shapes;
}

std::vector<Curve> PartFiles::curves(const std::string& file, double millimetres) const
{
    std::vector<Curve> curves = read_curves(file, millimetres, nullptr);
    move_curves(placed_drawing(file), curves);
    repeat(copies(file), curves);
    return curves;
}

const Triangles& PartFiles::facets(const std::string& file, double millimetres)
{
    const auto [found, is_new] = facets_.try_emplace(file);
    if (is_new) {
        if (is_mesh_file(file)) {
            found->second = mesh(file, millimetres);
        } else {
            found->second = read_cad_facets(file, placed(file));
            repeat(copies(file), found->second);
        }
        close_mesh({file}, found->second);
    }
    return found->second;
}

const DrawnPaths* PartFiles::drawn(const std::string& name, double millimetres)
{
    if (const auto found = drawn_.find(name); found != drawn_.end()) {
        return &found->second;
    }
    if (!names_part_region(name)) {
        return nullptr;
    }
    const auto [found, is_new] = regions_.try_emplace(name);
    if (is_new) {
        const std::string file = without_layer(name);
        const bool filled = names_filled_region(name) && is_cad_file(file);
        found->second = part_region(name, millimetres, facets(file, millimetres),
                                    filled ? mouths_of(cad_holes(file)) : std::vector<job::Hole>{});
    }
    return &found->second;
}

// A region is that of the part as it is placed.
Similarity PartFiles::placed_drawing(const std::string& name) const
{
    if (names_part_region(name)) {
        return {};
    }
    const std::string file = without_layer(name);
    return placed(placed_.count(file) > 0 ? file : name);
}

std::vector<job::Hole> PartFiles::holes(const std::string& file,
                                        double millimetres,
                                        DiameterRange range,
                                        bool only_circles)
{
    if (is_cad_file(without_layer(file))) {
        return model_holes(file, range, hole_tops(file, millimetres));
    }
    const Similarity move = placed_drawing(file);
    const double scale = norm(move.axes[0]);
    const DiameterRange drawn{range.least / scale, range.greatest / scale};
    std::vector<job::Hole> holes = read_holes(file, millimetres, drawn, only_circles, notes_);
    for (job::Hole& hole : holes) {
        hole = {in_plan(move.of({hole.at.x, hole.at.y, 0})), scale * hole.diameter};
    }
    repeat(copies(file), holes);
    for (const job::Hole& hole : holes) {
        check_place({line_curve(hole.at, hole.at)}, file);
    }
    return holes;
}

const CadHoles& PartFiles::cad_holes(const std::string& file)
{
    const auto [known, is_new] = cad_holes_.try_emplace(file);
    CadHoles& found = known->second;
    if (is_new) {
        found = read_cad_holes(file, placed(file));
        const std::size_t places = std::max<std::size_t>(copies(file).size(), 1);
        repeat(copies(file), found.holes);
        std::vector<std::optional<job::HoleMouth>> cones;
        for (const auto& cone : found.cones) {
            cones.insert(cones.end(), places, cone);
        }
        found.cones = cones;
        if (found.closed_above > 0) {
            notes_.push_back(fmt::format("{}: {} below alone and {} not drilled", file,
                                         found.closed_above == 1
                                             ? "1 hole opens"
                                             : fmt::format("{} holes open", found.closed_above),
                                         found.closed_above == 1 ? "is" : "are"));
        }
    }
    return found;
}

std::vector<job::Hole> PartFiles::model_holes(const std::string& name,
                                              DiameterRange range,
                                              std::optional<std::array<double, 2>> tops)
{
    std::vector<job::Hole> holes;
    std::set<double> diameters;
    for (const job::Hole& hole : cad_holes(without_layer(name)).holes) {
        if (tops && (hole.span->top < tops->front() || hole.span->top > tops->back())) {
            continue;
        }
        diameters.insert(std::round(hole.diameter * 1e4) / 1e4);
        if (hole.diameter >= range.least && hole.diameter <= range.greatest) {
            holes.push_back(hole);
        }
    }
    if (holes.empty()) {
        throw InputError(diameters.empty()
                             ? name + ": no vertical hole to drill"
                             : fmt::format("{}: no hole of the wanted diameter; there are {:g} mm",
                                           name, fmt::join(diameters, ", ")));
    }
    return holes;
}

std::vector<job::Chain> PartFiles::chains(const std::string& file, double millimetres)
{
    const Similarity move = placed_drawing(file);
    const DrawnPaths* const drawn = this->drawn(file, millimetres);
    std::vector<job::Chain> chains = drawn == nullptr
                                         ? read_chains(file, millimetres, notes_)
                                         : chains_of(file, curves_of(drawn->paths), notes_);
    repeat({move}, chains);
    repeat(copies(file), chains);
    for (const job::Chain& chain : chains) {
        check_place(chain, file);
    }
    return chains;
}

void PartFiles::place(const std::string& file, const Similarity& placed) { placed_[file] = placed; }

void PartFiles::copy(const std::string& file, const std::vector<Similarity>& places)
{
    copies_[file] = places;
    const auto repeat_read = [&](auto& read) {
        for (auto& [key, items] : read) {
            const std::string& name = std::get<0>(key);
            if (name == file || without_layer(name) == file) {
                repeat(copies(name), items);
            }
        }
    };
    repeat_read(surfaces_);
    repeat_read(loops_);
    if (const auto found = meshes_.find(file); found != meshes_.end()) {
        repeat(places, found->second);
    }
    cad_holes_.erase(file);
    facets_.erase(file);
}

void PartFiles::turn_all(const Similarity& turn)
{
    turn_ = turn;
    surfaces_.clear();
    meshes_.clear();
    loops_.clear();
    cad_holes_.clear();
    facets_.clear();
    regions_.clear();
    notes_.clear();
}

void PartFiles::shift(const std::string& file, Vec3d by)
{
    placed_[file].shift = placed_[file].shift + by;
    for (auto& [key, surfaces] : surfaces_) {
        for (Surface& surface : surfaces) {
            for (Vec3d& point : surface.points) {
                point = key.first == file ? point + by : point;
            }
        }
    }
    if (const auto found = meshes_.find(file); found != meshes_.end()) {
        for (auto& triangle : found->second) {
            for (Vec3d& corner : triangle) {
                corner = corner + by;
            }
        }
    }
    cad_holes_.erase(file);
    facets_.erase(file);
    for (auto& [key, loops] : loops_) {
        if (std::get<0>(key) == file || without_layer(std::get<0>(key)) == file) {
            Similarity move;
            move.shift = by;
            move_loops(move, loops);
        }
    }
}

}  // namespace cusp::import
