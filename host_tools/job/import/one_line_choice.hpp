// Chooses the values that a one-line job does not give, from the part and its tools.
#pragma once

#include <string>
#include <vector>

#include "host_tools/job/import/one_line_job.hpp"
#include "host_tools/job/import/part_extent.hpp"
#include "host_tools/job/import/tool_text.hpp"

namespace cusp::import {

// Lengths in `unit`, feeds in it a minute.
struct OneLineChoice {
    const char* unit;  // "mm" or "inch"
    double steps{};    // per unit: the stock is rounded outwards to these steps
    std::vector<NamedTool> tools;
    std::string strategy;
    double tolerance{};
    std::vector<double> feeds;  // a minute, of each tool
    std::vector<double> plunge_feeds;
    std::vector<double> spindles;    // rpm, of each tool
    std::vector<std::string> rated;  // by the material: of each tool, in words; else none
    double clearance{};
    PartExtent part;
    double top{};     // of the stock
    double bottom{};  // of the part
    bool roughs{};
    double max_depth{};
    double allowance{};

    // Rounded to the step of the stock.
    std::string words(double length) const;
    // All tools but the last; a single tool also roughs.
    std::vector<NamedTool> roughing_tools() const;
};

// Rounded to three significant digits.
double three_digits(double value);

// Tools, feeds, spindle and clearance alone. Errors: InputError that names the tool.
OneLineChoice choose_rates(const OneLineRequest& request);

// Places parts and loops as the options say, once; does nothing where none does. Errors: PlacingError.
void place_request(const OneLineRequest& request, PartFiles& parts);

// Errors: InputError that names the option or the file.
OneLineChoice choose(const OneLineRequest& request,
                     const job::Strategies& strategies,
                     PartFiles& parts);

}  // namespace cusp::import
