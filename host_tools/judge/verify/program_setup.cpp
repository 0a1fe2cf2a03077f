// A program says by its work offset which set-up it is for.
#include "host_tools/judge/verify/program_setup.hpp"

#include <algorithm>
#include <utility>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/judge/verify/program_moves.hpp"

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace cusp::verify {

using job::Job;

namespace {

std::size_t place_of_program(const std::vector<Job>& setups, const std::string& program)
{
    const auto offsets =
        read_program(setups.front(), program, setups.front().stock_top + kStartHigh).offsets;
    if (offsets.size() > 1) {
        throw InputError(
            fmt::format("{}: has moves in {} work offsets, but {} has a program for each "
                        "set-up",
                        program, offsets.size(), setups.front().file));
    }
    const int offset = *offsets.begin();
    const auto found = std::find_if(setups.begin(), setups.end(),
                                    [&](const Job& job) { return job.setup->offset == offset; });
    if (found == setups.end()) {
        std::vector<std::string> known;
        std::transform(setups.begin(), setups.end(), std::back_inserter(known), [](const Job& job) {
            return fmt::format("{} has G{}", job.setup->name, job.setup->offset);
        });
        const std::string name =
            offset > 59 ? "a work offset over G59" : fmt::format("G{}", offset);
        throw InputError(fmt::format("{}: moves in {}, which is that of no set-up of {}: {}",
                                     program, name, setups.front().file, fmt::join(known, ", ")));
    }
    return static_cast<std::size_t>(found - setups.begin());
}

}  // namespace

Job job_of_program(std::vector<Job> setups,
                   const std::string& program,
                   const std::vector<std::string>& after)
{
    if (!setups.front().setup) {
        Job job = std::move(setups.front());
        job.stock_programs.insert(job.stock_programs.end(), after.begin(), after.end());
        return job;
    }
    const std::size_t place = place_of_program(setups, program);
    Job job = std::move(setups[place]);
    setups[place].setup = job.setup;
    setups[place].file = job.file;
    for (const std::string& file : after) {
        const std::size_t before = place_of_program(setups, file);
        if (before > place) {
            throw InputError(fmt::format("--after {}: the set-up {} comes after {}", file,
                                         setups[before].setup->name, job.setup->name));
        }
        add_earlier_program(job, *setups[before].setup, file);
    }
    return job;
}

}  // namespace cusp::verify
