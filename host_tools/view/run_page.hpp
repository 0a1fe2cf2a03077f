// The page of one run, what `cusp view` writes: one HTML file that shows a program as the controller
// runs it. The front door of `view`; web/ holds the page's own code.
//
//     RunPageOptions options;
//     options.simulation.settings = read_settings_file("mill.settings");
//     const RunPage page = run_page("part.ngc", options);
//     write_text("run.html", page.html);
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "host_tools/job/job.hpp"
#include "host_tools/simulate/simulation.hpp"
#include "host_tools/verify/verify.hpp"

namespace cusp::view {

struct RunPageOptions {
    simulate::SimulationOptions simulation;  // set_point is the page's
    const job::Job* job{nullptr};            // none: path and tool alone
    // Of the job and this program; none: run_page() verifies.
    const verify::Verification* verification{nullptr};
    // Called with the share of the verification that is done.
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

// Runs the program through the firmware's core, verifies it where there is a job, and makes one HTML
// file of it that asks for nothing from outside.
//
// Lines that the controller refuses are shown in the page; a program that can't be verified for them
// is shown without its stock.
//
// Throws InputError where the program can't be read, and where this build has no page.
RunPage run_page(const std::string& program, const RunPageOptions& options);

}  // namespace cusp::view
