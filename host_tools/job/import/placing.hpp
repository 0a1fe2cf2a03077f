// Places the parts of a job: scales, turns and moves them. docs/job_file.md has the keys.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/job/import/part_extent.hpp"
#include "host_tools/job/import/part_files.hpp"
#include "host_tools/job/import/similarity.hpp"

namespace cusp::import {

inline constexpr double kMostPlaces = 10000;  // of a part

// One more place of a part that is placed already.
struct CopyPlace {
    Vec2d at{};        // mm: by which it is moved, after the turn
    double degrees{};  // about the job's z axis
};

// Applied in this order: relief, scale, up, rotate, origin, move, copies.
struct Placing {
    std::vector<std::string> files;      // that it is for; none: all that no other placing names
    std::optional<ReliefSize> relief{};  // of pictures
    double scale{1.0};
    std::string up{"+z"};             // the file's axis that becomes z
    Vec3d rotate{};                   // degrees about x, then y, then z
    std::string origin;               // "corner", "centre", "top", or "" for the file's own
    Vec3d move{};                     // mm
    std::vector<CopyPlace> copies{};  // all places of the part; none: it lies where `move` puts it
};

inline const std::vector<std::string> kUpAxes{"+x", "-x", "+y", "-y", "+z", "-z"};
inline const std::vector<std::string> kOrigins{"corner", "centre", "top"};

// Scale, up and rotate. Quarter turns are exact.
Similarity turn_of(const Placing& placing);
// The placing of a drawing, which is in x and y: scale, and rotation about z only.
Similarity turn_of_drawing(const Placing& placing);

// Origin and move of what the turn has left in `box`: "top" puts the box's top at z = 0, "corner"
// also its least x and y at 0, "centre" its middle.
Vec3d shift_of(const Placing& placing, const PartExtent& box);

// The files of a job, by their paths.
struct PlacedFiles {
    std::vector<std::string> parts;     // of surfaces and meshes
    std::vector<std::string> drawings;  // of loops; "#layer" may follow
};

// From where a part is placed to its copies.
std::vector<Similarity> moves_of(const std::vector<CopyPlace>& copies);

// A placing that does not fit the files of its job.
class PlacingError : public InputError {
public:
    using InputError::InputError;
};

// Hands `parts` where each file lies. The box of an origin is that of all parts of the placing, or
// of its drawings where it has no part: they keep their places to each other.
//
// millimetres  of one unit of files that name none
//
// Errors: PlacingError where a file is named twice or is no file of the job, where two placings name
// none; InputError as the readers throw it.
void place_parts(const std::vector<Placing>& placings,
                 const PlacedFiles& files,
                 double millimetres,
                 PartFiles& parts);

}  // namespace cusp::import
