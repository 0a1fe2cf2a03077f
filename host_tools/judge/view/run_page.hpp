// The page of one run, written by `cusp view`: one HTML file that shows a program as the controller
// runs it. The front door of `view`; web/ is the code of the page.
//
//     RunPageOptions options;
//     options.simulation.settings = read_settings_file("mill.settings");
//     const RunPage page = run_page("part.ngc", options);
//     write_text("run.html", page.html);
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/controller/simulate/simulate.hpp"
#include "host_tools/job/job/job.hpp"
#include "host_tools/judge/verify/verify.hpp"

namespace cusp::view {

struct RunPageOptions {
    // set_point, path and measures_deviation are overwritten. The page does not show the sum of edges.
    simulate::SimulationOptions simulation;
    const job::Job* job{nullptr};  // null: only path and tool
    // Verification of this program against the job; null: run_page() verifies. Without engagement the
    // page has no chart of it.
    const verify::Verification* verification{nullptr};
    // Called with the fraction of the verification that is done.
    std::function<void(double share)> verifying;
};

// A binary part of what a page shows.
struct RunBlock {
    std::string id;  // of its element in the page
    std::string
        bytes;  // as the page's reader takes them: run_record.hpp, stock_frames.hpp, left_map.hpp
};

struct RunData {
    std::string facts;  // JSON
    std::vector<RunBlock> blocks;
    simulate::SimulationResult run;
    bool good{false};  // the run ended well, and all bounds of the job hold
    std::uint64_t ticks{0};
    std::uint64_t refused{0};  // lines
    std::string verdict;       // one line
};

struct RunPage : RunData {  // without blocks: they are in the page
    std::string html;
};

// Runs the program through the firmware's core, and verifies it if there is a job.
//
// The facts list the lines that the controller refuses. If they prevent verification, there is no stock.
//
// Throws InputError where the program can't be read.
RunData run_data(const std::string& program, const RunPageOptions& options);

// As above, in one HTML file without external references. Throws InputError, too, where this build has no page.
RunPage run_page(const std::string& program, const RunPageOptions& options);

}  // namespace cusp::view
