// A set-up: how the stock lies while a program is cut, and the work offset of that program.
//
//     job.setup = job::Setup{"bottom", 55, job::Flip::kX};
//     job::add_earlier_program(job, top, "plate-top.ngc");   // cut before, in another set-up
//
// The stock is turned over about a line through the middle of its box, so it lies in the same box in
// every set-up. docs/decisions/0014-one-program-a-set-up.md says why.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "host_tools/geometry/nurbs/nurbs.hpp"

namespace cusp::job {

// About a line parallel to x or y.
enum class Flip : std::uint8_t { kNone, kX, kY };

struct Setup {
    std::string name;
    int offset{54};  // 54 to 59: G54 to G59
    Flip flip{Flip::kNone};
};

// "set-up bottom, G55, turned over about x".
std::string description_of(const Setup& setup);
// "part.ngc" of the set-up "bottom" is "part-bottom.ngc"; "" stays.
std::string file_of_setup(const std::string& file, const Setup& setup);

// A half turn about an axis through `middle`, or none. It is its own inverse.
struct SetupFlip {
    Vec3d signs{1, 1, 1};
    Vec3d middle{};

    Vec3d of(Vec3d p) const
    {
        const Vec3d d = p - middle;
        return middle + Vec3d{signs.x * d.x, signs.y * d.y, signs.z * d.z};
    }
    bool is_none() const { return signs == Vec3d{1, 1, 1}; }
    bool turns_over() const { return signs.z < 0; }
};

// The signs of the half turn from one set-up's coordinates to another's.
inline Vec3d turn_signs(Flip from, Flip to)
{
    constexpr std::array<Vec3d, 3> kSigns{Vec3d{1, 1, 1}, Vec3d{1, -1, -1}, Vec3d{-1, 1, -1}};
    const Vec3d a = kSigns[static_cast<std::size_t>(from)];
    const Vec3d b = kSigns[static_cast<std::size_t>(to)];
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}

// A program that was cut before, in a set-up whose stock lay otherwise.
struct SetupProgram {
    std::string file;
    SetupFlip turn;  // from its coordinates to those of the job
};

}  // namespace cusp::job
