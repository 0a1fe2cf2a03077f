// Changes of the stored state.
#include "firmware/machine/settings_keeper.hpp"

#include "firmware/machine/setting_messages.hpp"

namespace cusp::machine {

SettingsKeeper::SettingsKeeper(const Settings* factory, const BoardLimits& board) noexcept
    : factory_{factory}, board_{board}
{
    restore_settings();
}

void SettingsKeeper::restore_settings() noexcept
{
    stored_.settings = factory_ != nullptr ? *factory_ : Settings{};
}

bool SettingsKeeper::mend() noexcept
{
    return stored_.settings.mend(factory_ != nullptr ? *factory_ : Settings{}, board_);
}

std::optional<Error> SettingsKeeper::change(std::uint32_t number,
                                            float value,
                                            protocol::ReplyQueue& out) noexcept
{
    Settings changed = stored_.settings;
    if (const std::optional<Error> error = changed.put(number, value)) {
        tell_range(number, value, out);
        return error;
    }
    if (const std::optional<SettingFault> fault = changed.find_fault(board_)) {
        tell_fault(*fault, out);
        return fault->error;
    }
    stored_.settings = changed;
    store_wanted_ = true;
    return std::nullopt;
}

void SettingsKeeper::forget_texts() noexcept
{
    stored_.startup = {};
    stored_.build = {};
}

void SettingsKeeper::keep_parameters(const gcode::Parameters& now, unsigned tool) noexcept
{
    gcode::ToolTable tools = stored_.parameters.tools;
    stored_.parameters = now;
    if (tool != 0) {
        tools.enter(tool, stored_.parameters.tools.length_nm(tool));
    }
    stored_.parameters.tools = tools;
    stored_.parameters.coordinate_offset = {};
    stored_.parameters.tool_length_offset_nm = 0;
    store_wanted_ = true;
}

void SettingsKeeper::store_done(bool written) noexcept
{
    store_wanted_ = false;
    store_failed_ = store_failed_ || !written;
}

}  // namespace cusp::machine
