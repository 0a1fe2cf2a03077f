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

struct RunPage {
    std::string html;
    simulate::SimulationResult run;
    bool good{false};  // the run ended well, and all bounds of the job hold
    std::uint64_t ticks{0};
    std::uint64_t refused{0};  // lines
    std::string verdict;       // one line
};

// Runs the program through the firmware's core, verifies it if there is a job, and makes one HTML
// file without external references.
//
// The page lists the lines that the controller refuses. If they prevent verification, the page has
// no stock.
//
// Throws InputError where the program can't be read, and where this build has no page.
RunPage run_page(const std::string& program, const RunPageOptions& options);

}  // namespace cusp::view
