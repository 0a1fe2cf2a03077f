// Reading and writing of settings files.
#include "host_tools/controller/simulate/settings_file.hpp"

#include <fmt/format.h>

#include "host_tools/base/input_error/input_error.hpp"
#include "host_tools/controller/dialect/line_source.hpp"
#include "host_tools/controller/program_run/settings_lines.hpp"

namespace cusp::simulate {

using dialect::LineSource;

namespace {

using machine::Settings;

std::string value_text(const Settings& settings, std::size_t index)
{
    return fmt::format("{:.{}f}", settings.value_at(index),
                       int{machine::setting_entry(index).decimals});
}

Settings settings_of(LineSource& source)
{
    Settings settings;
    if (const auto refusal = program_run::read_settings(source, settings)) {
        const std::string& name = source.name();
        const std::string place =
            refusal->line == 0 ? name : fmt::format("{}:{}", name, refusal->line);
        throw InputError{place + ": " + refusal->text, {name, refusal->line}};
    }
    return settings;
}

}  // namespace

Settings read_settings_file(const std::string& file)
{
    LineSource source{file};
    return settings_of(source);
}

Settings settings_of_text(const std::string& text, const std::string& name)
{
    LineSource source = LineSource::of_text(name, text);
    return settings_of(source);
}

std::string settings_text(const Settings& settings)
{
    std::string text;
    for (std::size_t i = 0; i < machine::kSettingCount; ++i) {
        text += fmt::format("${}={}\n", machine::setting_entry(i).number, value_text(settings, i));
    }
    return text;
}

std::vector<std::string> settings_commands(const Settings& settings)
{
    const Settings standard;
    std::vector<std::string> commands;
    for (std::size_t i = 0; i < machine::kSettingCount; ++i) {
        if (settings.value_at(i) != standard.value_at(i)) {
            commands.push_back(
                fmt::format("${}={}", machine::setting_entry(i).number, value_text(settings, i)));
        }
    }
    return commands;
}

}  // namespace cusp::simulate
