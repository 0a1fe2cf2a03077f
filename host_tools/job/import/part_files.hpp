// PartFiles: a cache of the parts of a job; each file is read once.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "host_tools/job/import/cad_holes.hpp"
#include "host_tools/job/import/dxf_holes.hpp"
#include "host_tools/job/import/file_loops.hpp"
#include "host_tools/job/import/import.hpp"
#include "host_tools/job/import/relief_size.hpp"
#include "host_tools/job/import/similarity.hpp"

namespace cusp::import {

using Triangles = std::vector<std::array<Vec3d, 3>>;

// Files lie as they are, or as `place` and `shift` say (placing.hpp).
//
// Errors, here and below: InputError, as `read_surfaces`, `read_mesh` and `read_loops` throw it.
//
// millimetres  of one unit of a file that names no unit: 1 or 25.4; equal in all calls
class PartFiles {
public:
    // mesh_tolerance  mm: as in `read_surfaces`
    const std::vector<nurbs::Surface>& surfaces(const std::string& file,
                                                double millimetres,
                                                double mesh_tolerance);
    const Triangles& mesh(const std::string& file, double millimetres);
    // Closes the holes of the mesh that all these files make, and notes it (mesh_holes.hpp).
    void close_mesh(const std::vector<std::string>& files, Triangles& mesh);
    // gaps  as in `read_loops`
    const std::vector<FileLoop>& loops(const std::string& file,
                                       double millimetres,
                                       EndDistance gaps);
    // As read_shapes(), placed; read anew by each call.
    FileShapes shapes(const std::string& file,
                      const std::vector<std::string>& layers,
                      double millimetres,
                      EndDistance gaps);
    // All curves of a drawing, or of a JSON file, wherever they are.
    std::vector<nurbs::Curve> curves(const std::string& file, double millimetres) const;

    // As read_holes() and read_chains(), placed. The holes of a model have their heights
    // (cad_holes.hpp).
    std::vector<job::Hole> holes(const std::string& file,
                                 double millimetres,
                                 DiameterRange range,
                                 bool only_circles);
    std::vector<job::Chain> chains(const std::string& file, double millimetres);
    // Those of a model with their cones, placed.
    const CadHoles& cad_holes(const std::string& file);

    // A drawing that is no file, such as a text: loops(), shapes() and chains() find it by its name.
    void draw(const std::string& name, DrawnPaths drawn) { drawn_[name] = std::move(drawn); }

    // The facets of a model or a mesh, whole and closed (close_mesh()), for its regions (part_regions.hpp), which loops() and shapes() find
    // by their names.
    const Triangles& facets(const std::string& file, double millimetres);

    void note(const std::string& sentence) { notes_.push_back(sentence); }

    // Places a file that was not read yet; its name has no "#layer".
    void place(const std::string& file, const Similarity& placed);
    // Sizes a picture that was not read yet.
    void size_relief(const std::string& file, const ReliefSize& size) { reliefs_[file] = size; }
    // Moves what was read of the file, and what will be. mm
    void shift(const std::string& file, Vec3d by);
    // The file lies in all these places, and no longer where place() and shift() say: they act before.
    void copy(const std::string& file, const std::vector<Similarity>& places);
    // Turns all files that lie as the above say, in space; what was read is forgotten.
    void turn_all(const Similarity& turn);
    // After the last of both: a job that finds its files placed leaves them there.
    void finish_placing() { is_placed_ = true; }
    bool is_placed() const { return is_placed_; }

    // Sentences on what the readers left out or changed so far.
    const std::vector<std::string>& notes() const { return notes_; }

private:
    // A drawing that is no file, where the name is that of one; null: it is a file.
    const DrawnPaths* drawn(const std::string& name, double millimetres);
    // tops  z at which they begin; none: all
    std::vector<job::Hole> model_holes(const std::string& name,
                                       DiameterRange range,
                                       std::optional<std::array<double, 2>> tops);
    Similarity placed(const std::string& file) const;
    std::optional<ReliefSize> relief(const std::string& file) const;
    // From where placed() says to all places of the file.
    std::vector<Similarity> copies(const std::string& name) const;
    // The placing of a drawing, the same for all layers.
    Similarity placed_drawing(const std::string& name) const;

    // keys: file, tolerance
    std::map<std::pair<std::string, double>, std::vector<nurbs::Surface>> surfaces_;
    std::map<std::string, Triangles> meshes_;
    // keys: file, limits of gaps; below 0: not given
    std::map<std::tuple<std::string, double, double>, std::vector<FileLoop>> loops_;
    std::map<std::string, DrawnPaths> drawn_;
    std::map<std::string, Triangles> facets_;    // of models
    std::map<std::string, DrawnPaths> regions_;  // of parts, placed
    std::map<std::string, CadHoles> cad_holes_;
    std::map<std::string, Similarity> placed_;  // by file; others lie as they are
    std::map<std::string, std::vector<Similarity>> copies_;
    std::map<std::string, ReliefSize> reliefs_;
    Similarity turn_;  // of all files, last
    bool is_placed_{false};
    std::vector<std::string> notes_;
};

}  // namespace cusp::import
