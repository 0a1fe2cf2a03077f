// Builds a job from one command line: parts, tools and a scallop. The rest is chosen and reported.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/import/part_files.hpp"

namespace cusp::import {

// The request. Lengths in inches or mm, feeds in them a minute; no value: it is chosen.
struct OneLineRequest {
    std::vector<std::string> parts;  // files of surfaces
    std::vector<std::string> tools;  // as `tool_of_text` reads them; the last finishes
    std::optional<std::string> boundary;
    std::vector<std::string> islands;
    bool inch{false};
    std::optional<double> scallop;
    std::optional<double> tolerance;
    std::optional<double> max_depth;
    std::optional<double> allowance;
    std::optional<double> feed;
    std::optional<double> plunge_feed;
    std::optional<double> spindle;  // rpm
    std::optional<double> stock_top;
    std::optional<double> clearance;
    // As the keys of [placing]; all parts and loops together.
    std::optional<double> scale;
    std::string up;
    std::vector<double> rotate;  // degrees: about z, or about x, y, z
    std::string origin;
    std::vector<double> move;  // x, y, z
    bool roughing{true};
    std::string strategy;         // "": adaptive_isocurve, with a boundary contour_pocket
    std::string output{"lines"};  // "lines", "arcs", "nurbs"
};

struct OneLineJob {
    std::string toml;               // with paths as in the request
    std::vector<std::string> said;  // lines in words: the part, and what was chosen
};

// Stock: its top is the part's highest place (of a pocket: z = 0 where the floor lies below), its
// bottom the lowest. Where the part is deeper than half the diameter of the tools that rough, or
// several tools are given, all but the last rough in layers of at most that depth.
//
// parts  keeps the files read here for `read_job`
//
// Errors: InputError that names the option or the file.
OneLineJob one_line_job(const OneLineRequest& request, PartFiles& parts);

}  // namespace cusp::import
