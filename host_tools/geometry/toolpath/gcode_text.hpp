// Numbers of G-code as text.
#pragma once

#include <cstdint>
#include <string>

#include "host_tools/geometry/toolpath/toolpath.hpp"

namespace cusp::toolpath {

// A number in fixed point with at most `decimals`, without trailing zeros.
std::string fixed_point(double value, int decimals);

// The value with nine significant digits: a knot or a weight.
std::string nine_digits(double value);

// A feed with at most three decimals.
//
// point  whether a whole number gets a point too
std::string feed_text(double feed, bool point);

// Appends value / scale, exact.
//
// scale  a power of ten
// point  whether a whole number gets a point too
void add_scaled(std::string& text, std::int64_t value, std::int64_t scale, bool point);

// The comment on a tool: number, shape, all sizes and, after a colon, its name. Programs are read with
// the tools that their comments describe (verify/tool_comment.hpp), so sizes are written with 7 decimals
// at most, without trailing zeros.
//
// unit  mm; name: of the unit
std::string tool_text(const Toolpath& path, double unit, const char* name);

// The same without the tool's name.
std::string tool_sizes(const Tool& tool, double unit, const char* name);

}  // namespace cusp::toolpath
