// Faces of STEP, IGES and BREP models as trimmed NURBS surfaces, by Open CASCADE.
//
// Open CASCADE is loaded when the first such file is read: linking it would add 25 ms to the start
// of every command. Only the module libcusp_cad.so uses it; it is built where Open CASCADE is
// installed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "host_tools/geometry/nurbs/nurbs.hpp"
#include "host_tools/job/import/similarity.hpp"

namespace cusp::import {

// The file names its unit, but BREP, which is in mm; the result is in mm, turned and moved by `placed`
// before any face is left out. Analytic faces become rational B-splines, exactly; the trimming
// curves in (u, v) are those of Open CASCADE. Faces of solids without an upward normal are left out:
// a tool from above cannot reach them, and the faces above them are in the model. Loose faces that
// close a volume count as a solid. A hole that faces leave open above is closed, as in a mesh
// (mesh_holes.hpp).
//
// Errors: InputError with the file and the reason: no such file, not STEP, IGES or BREP, no upward
// face, contradicting trims, no libcusp_cad.so.
//
// notes  what is wrong in the file and was mended, in words; may be null
std::vector<nurbs::Surface> read_cad_surfaces(const std::string& file,
                                              const Similarity& placed = {},
                                              std::vector<std::string>* notes = nullptr);

// A fault of some faces of a file that was mended or taken: their number, and the largest change,
// mm.
struct FaceFault {
    static constexpr double kReported = 0.01;  // mm: less is rounding

    std::size_t faces{};
    double most{};

    void add(double off)
    {
        if (off > kReported) {
            add(FaceFault{1, off});
        }
    }
    void add(const FaceFault& other)
    {
        faces += other.faces;
        most = other.most > most ? other.most : most;
    }
};

// The faces of a model, and facts about the file.
struct CadModel {
    std::string unit;      // of length, as named in the file; "": it names none
    std::size_t solids{};  // volumes that faces close
    std::size_t unread{};  // faces of solids without an upward normal and with broken edges
    FaceFault points;      // edges without length in the file that have one on the surface
    FaceFault gaps;        // ends of edges that should meet
    FaceFault lobes;       // cut off where edges cross each other
    FaceFault beside;      // edges beside their surface
    std::vector<nurbs::Surface> faces;  // all others, in mm
    // Of CadWanted::kUpward the triangles of all faces where these do not close, for the search for holes
    // (mesh_holes.hpp); of kFacets and kEverything all triangles.
    std::vector<std::array<Vec3d, 3>> triangles;
    std::vector<double> outwards;  // of each face: +1 if du x dv points out of its solid, -1
                                   // if into it; 0: the face belongs to no solid
};

// The faults of the file that were mended, in words.
std::vector<std::string> notes_of(const CadModel& model, const std::string& file);

// As read_cad_surfaces(), but faces of solids without an upward normal are kept.
CadModel read_cad_model(const std::string& file);

// As read_cad_model(), with the triangles of read_cad_facets().
CadModel read_whole_cad_model(const std::string& file);

// Triangles of all faces, no farther than kFacetsOff from them, which meet at shared edges.
//
// Errors: as read_cad_surfaces().
inline constexpr double kFacetsOff = 1e-3;  // mm
std::vector<std::array<Vec3d, 3>> read_cad_facets(const std::string& file,
                                                  const Similarity& placed);

// The wanted parts of a model: faces with an upward normal, all faces, triangles alone, or all faces and triangles.
enum class CadWanted : std::uint8_t { kUpward, kAllFaces, kFacets, kEverything };

// All three, by Open CASCADE.
CadModel cad_model(const std::string& file, const Similarity& placed, CadWanted wanted);

}  // namespace cusp::import

// The entry point of libcusp_cad.so. Its undefined symbols are resolved by the program.
extern "C" void cusp_read_cad_model(const std::string& file,
                                    const cusp::import::Similarity& placed,
                                    cusp::import::CadWanted wanted,
                                    cusp::import::CadModel& model);
