// Builds a job from a command line: parts, tools and a scallop height, or drawings, tools and a depth. Other
// values are chosen and reported.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/job/import/part_files.hpp"
#include "host_tools/job/job/strategy.hpp"

namespace cusp::import {

// Lengths in inches or mm, feeds in that unit per minute. A value that is absent is chosen.
struct OneLineRequest {
    std::vector<std::string> parts;  // files of surfaces, or drawings
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
    // A picture needs both.
    std::optional<double> width;
    std::vector<double> heights;  // z of black and of white
    // As the keys of [placing]; all parts and loops together.
    std::optional<double> scale;
    std::string up;
    std::vector<double> rotate;  // degrees: about z, or about x, y, z
    std::string origin;
    std::vector<double> move;  // x, y, z
    // These are for drawings alone (sheet_job.hpp).
    std::optional<double> depth;
    std::vector<std::string> layers;  // "NAME=OPERATION", "NAME=OPERATION:DEPTH"
    std::string tabs;                 // "COUNT", "COUNT:WIDTH:HEIGHT"
    std::string side;                 // "": outside; "inside", "on"
    std::optional<double> join_gaps;
    std::vector<double> copies;  // of all drawings together, or of each
    std::vector<double> sheet;   // width and height of the stock, on which copies lie
    std::optional<double> gap;   // between copies
    bool roughing{true};
    std::string strategy;         // "": the first for parts, with a boundary for pockets
    std::string output{"lines"};  // "lines", "arcs", "nurbs"
    std::string post;             // "": the default
    std::string machine;          // file of the machine; "": none
    std::string material;         // a name or a file; "": none
};

struct OneLineJob {
    std::string toml;               // with paths as in the request
    std::vector<std::string> said;  // lines in words: the part, and what was chosen
};

// The stock reaches from the part's lowest point to its highest (for a pocket: to z = 0 where the
// floor is below). If the part is deeper than half the diameter of the roughing tools, or several
// tools are given, all but the last rough in layers of at most that depth.
//
// Drawings are sorted as sheet_job.hpp says.
//
// strategies  that the job may name
// parts       caches the files read here for `read_job`
//
// Errors: InputError that names the option or the file.
OneLineJob one_line_job(const OneLineRequest& request,
                        const job::Strategies& strategies,
                        PartFiles& parts);

}  // namespace cusp::import
