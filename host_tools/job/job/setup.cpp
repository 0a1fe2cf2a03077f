// Programs of other set-ups, in the coordinates of a job.
#include "host_tools/job/job/setup.hpp"

#include <filesystem>

#include "host_tools/job/job/job.hpp"

#include "fmt/format.h"

namespace cusp::job {

void add_earlier_program(Job& job, const Setup& of, const std::string& file)
{
    SetupFlip turn{turn_signs(of.flip, job.setup ? job.setup->flip : Flip::kNone)};
    if (turn.is_none()) {
        job.stock_programs.push_back(file);
        return;
    }
    turn.middle = {((*job.stock_x)[0] + (*job.stock_x)[1]) / 2,
                   ((*job.stock_y)[0] + (*job.stock_y)[1]) / 2,
                   (*job.stock_bottom + job.stock_top) / 2};
    job.turned_programs.push_back({file, turn});
}

std::string description_of(const Setup& setup)
{
    const char* flip = setup.flip == Flip::kX   ? ", turned over about x"
                       : setup.flip == Flip::kY ? ", turned over about y"
                                                : "";
    return fmt::format("set-up {}, G{}{}", setup.name, setup.offset, flip);
}

std::string file_of_setup(const std::string& file, const Setup& setup)
{
    const std::filesystem::path path{file};
    return file.empty() ? file
                        : (path.parent_path() /
                           (path.stem().string() + "-" + setup.name + path.extension().string()))
                              .string();
}

}  // namespace cusp::job
