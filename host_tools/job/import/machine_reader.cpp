// The settings first; keys of the file replace them.
#include "host_tools/job/import/machine_reader.hpp"

#include <cstdint>
#include <sstream>

#include "host_tools/base/files/files.hpp"
#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/base/number_text/number_text.hpp"
#include "host_tools/job/import/job_key_tables.hpp"
#include "host_tools/job/import/job_table.hpp"
#include "host_tools/job/import/path_ending.hpp"

#include "fmt/format.h"

namespace cusp::import {

using job::AxisValues;
using job::MachineLimit;
using job::MachineTool;

namespace {

namespace fs = std::filesystem;

// The member that a setting fills; null: none of interest.
std::optional<MachineLimit>* member_of(MachineTool& machine, int setting)
{
    constexpr int kMostSpindle = 30;
    constexpr int kLeastSpindle = 31;
    constexpr int kRates = 110;
    constexpr int kAccelerations = 120;
    constexpr int kTravels = 130;
    if (setting == kMostSpindle || setting == kLeastSpindle) {
        return setting == kMostSpindle ? &machine.most_spindle : &machine.least_spindle;
    }
    for (const auto& [first, values] :
         {std::pair{kRates, &machine.max_rate}, std::pair{kAccelerations, &machine.acceleration},
          std::pair{kTravels, &machine.travel}}) {
        if (setting >= first && setting < first + 3) {
            return &(*values)[static_cast<std::size_t>(setting - first)];
        }
    }
    return nullptr;
}

// One line, such as "$110=5000.000 (x max rate, mm/min)".
void read_setting(const std::string& line,
                  const std::string& file,
                  std::uint64_t number,
                  MachineTool& machine)
{
    const std::size_t equals = line.find('=');
    if (line.empty() || line.front() != '$' || equals == std::string::npos) {
        return;
    }
    const auto setting = number_text::leading_number(line.substr(1, equals - 1));
    if (!setting || setting->size != equals - 1) {
        return;
    }
    std::optional<MachineLimit>* const member =
        member_of(machine, static_cast<int>(setting->value));
    if (member == nullptr) {
        return;
    }
    const std::string text = line.substr(equals + 1);
    const auto value = number_text::leading_number(text);
    const std::string name = line.substr(0, equals);
    if (!value || !(value->value >= 0) || value->value > job::kLargest) {
        throw InputError(fmt::format("{}:{}: {}: is \"{}\", a number from 0 to {:g} is needed",
                                     file, number, name, text, job::kLargest),
                         {file, number, name, text, ""});
    }
    *member = MachineLimit{value->value, fmt::format("{}:{}: {}", file, number, name)};
}

void read_controller(const std::string& file, MachineTool& machine)
{
    std::istringstream lines{files::text_of_file(file)};
    std::uint64_t number = 0;
    for (std::string line; std::getline(lines, line);) {
        read_setting(line, file, ++number, machine);
    }
    if (!machine.max_rate[0] && !machine.travel[0] && !machine.most_spindle) {
        throw InputError(fmt::format(
            "{}: has none of the settings $30, $110 and $130: it should hold the lines that the "
            "controller prints for $$",
            file));
    }
}

class MachineReader {
public:
    MachineReader(const toml::table& document, const std::string& file)
        : file_{file}, table_{document, file, "", machine_table().keys}
    {
    }

    MachineTool read()
    {
        const fs::path folder = fs::path{file_}.parent_path();
        table_.take_unit();
        table_.check();
        if (const auto settings = table_.text("settings")) {
            table_.blamed("settings",
                          [&] { read_controller((folder / *settings).string(), machine_); });
        }
        machine_.file = file_;
        machine_.name = table_.text("name").value_or("");
        take("travel", machine_.travel);
        take("max_rate", machine_.max_rate);
        take("acceleration", machine_.acceleration);
        take_spindle();
        machine_.post = table_.text("post").value_or("");
        if (path_ending(machine_.post) == ".toml") {
            machine_.post = fs::absolute(folder / machine_.post).string();
        }
        table_.check_all_read();
        return machine_;
    }

private:
    MachineLimit limit(const char* key, double value) const
    {
        return {value, table_.place_of(key)};
    }

    void take(const char* key, AxisValues& values)
    {
        const auto numbers = table_.numbers(key);
        for (std::size_t axis = 0; numbers && axis < values.size(); ++axis) {
            values[axis] = limit(key, (*numbers)[axis]);
        }
    }

    void take_spindle()
    {
        const auto range = table_.interval("spindle");
        if (range) {
            machine_.least_spindle = limit("spindle", (*range)[0]);
            machine_.most_spindle = limit("spindle", (*range)[1]);
        }
    }

    std::string file_;
    JobTable table_;
    MachineTool machine_;
};

}  // namespace

MachineTool read_machine(const std::string& name, const fs::path& folder)
{
    const std::string file = (folder / name).string();
    const toml::table document = parsed_toml(files::text_of_file(file), file);
    return MachineReader{document, file}.read();
}

}  // namespace cusp::import
