// Readers of job files, surfaces, meshes and loops. Results are in millimetres, and checked.
//
//     const job::Job job = read_job("part.toml", strategies::all());  // with the parts that it names
//     const std::vector<nurbs::Surface> faces = read_surfaces("part.step");
//     const job::Loop wall = read_loop("plate.dxf#outline");
//     const toolpath::Post post = read_post("linuxcnc", "");  // post_reader.hpp
//
// A job's tables have readers of their own: tools and their library (job_tools.hpp), fixtures
// (fixture_reader.hpp), stock (stock_table.hpp), 2.5-D keys (prismatic_reader.hpp), placing
// (placing_reader.hpp). All read a JobTable, which checks keys, types and ranges.
//
// Every reader throws InputError with file, place, value and limit.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/import/relief_size.hpp"
#include "host_tools/job/import/similarity.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/job/job/strategy.hpp"

namespace cusp::import {

// Reads a TOML job and the parts it names. Throws InputError, also where it has several set-ups.
//
// strategies  that operations may name: strategies::all()
job::Job read_job(const std::string& file, const job::Strategies& strategies);
// A job for each set-up, in order: its operations, fixtures, and parts as they lie in it. One for a job
// without set-ups. Throws InputError.
//
// machine  as JobText has it
std::vector<job::Job> read_setups(const std::string& file,
                                  const job::Strategies& strategies,
                                  const std::string& machine = {});

// A job given as text.
struct JobText {
    std::string text;    // TOML
    std::string name;    // of the job, for messages
    std::string folder;  // base of its relative paths; "": the current folder
    // File of a machine in place of the job's, relative to the current folder; "": the job's.
    std::string machine{};
};
class PartFiles;
// As read_setups(), from text.
std::vector<job::Job> read_setups(const JobText& job, const job::Strategies& strategies);
// As above, from text. Files that `parts` already holds are not read again.
job::Job read_job(const JobText& job, const job::Strategies& strategies, PartFiles& parts);

// Geometry without a job, with clamped ends. Throws InputError.
//
// millimetres     of one unit of the file: 1 or 25.4; STEP, IGES, BREP and 3MF have their own
// mesh_tolerance  mm: how far the surface may be above a mesh; never below (height_field.hpp)
// notes           receives sentences on what was left out or changed; may be null
// placed          applied to the file's geometry
// relief          of a picture, else none
std::vector<nurbs::Surface> read_surfaces(const std::string& file,
                                          double millimetres = 1.0,
                                          double mesh_tolerance = 0.01,
                                          std::vector<std::string>* notes = nullptr,
                                          const Similarity& placed = {},
                                          const std::optional<ReliefSize>& relief = std::nullopt);
// The triangles of a mesh file (STL, OBJ, 3MF) or a picture (PNG), in mm. `notes` receives sentences on facets left out
// and overhangs.
std::vector<std::array<Vec3d, 3>> read_mesh(const std::string& file,
                                            double millimetres,
                                            std::vector<std::string>* notes = nullptr,
                                            const Similarity& placed = {},
                                            const std::optional<ReliefSize>& relief = std::nullopt);
// The one loop of a file: closed to 1e-3 mm, simple, counter-clockwise. `name` may be
// FILE.dxf#LAYER. file_loops.hpp reads several.
job::Loop read_loop(const std::string& name, double millimetres = 1.0);

}  // namespace cusp::import
