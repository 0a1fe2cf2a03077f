// Cuts a job's stock with a program: verify_example JOB.toml PROGRAM; exit status 1 if a bound does not hold.
#include <cstdio>
#include <exception>

#include "host_tools/cam/strategies/strategies.hpp"
#include "host_tools/job/import/import.hpp"
#include "host_tools/judge/verify/verify.hpp"
#include "host_tools/judge/verify/verify_statistics.hpp"

int main(int argc, char** argv)
try {
    if (argc != 3) {
        return 2;
    }
    const cusp::job::Job job = cusp::import::read_job(argv[1], cusp::strategies::all());
    const auto result = cusp::verify::verify(job, argv[2], {}, [](double) {});
    std::fputs(verification_text(result).c_str(), stdout);
    return result.broken.empty() ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}
