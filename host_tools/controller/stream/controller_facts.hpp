// ControllerFacts: the answers of a controller to `$I`, `$$`, `$G` and `$#` before a transfer.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "firmware/gcode/modal_state.hpp"
#include "firmware/machine/settings.hpp"
#include "host_tools/controller/stream/transfer_record.hpp"

namespace cusp::stream {

class ControllerFacts {
public:
    // Parses a line of the controller; lines that answer none of the four commands are ignored.
    void take(std::string_view line);

    // Bytes of the receive buffer; none if the controller does not report it.
    std::optional<std::size_t> receive_buffer() const { return receive_buffer_; }

    // Unknown settings are left out; settings that the controller does not list have their
    // defaults.
    const machine::Settings& settings() const { return settings_; }
    // True if `$$` was answered.
    bool has_settings() const { return has_settings_; }

    // Words of `$G`: "G0 G54 G17 ...".
    const std::string& modal() const { return modal_; }

    // Offsets and stored positions as `$#` gives them: to a thousandth of a millimetre.
    gcode::Parameters parameters() const;

    // The state that a record keeps of a transfer that begins at this place of the machine.
    TransferStart start_at(Position machine) const;

private:
    void take_parameter(std::string_view name, std::string_view value);
    void take_tool(std::string_view value);

    std::optional<std::size_t> receive_buffer_;
    machine::Settings settings_;
    bool has_settings_{false};
    std::string modal_;
    gcode::Parameters parameters_;  // millimetres, or inches with $13, times a million
};

}  // namespace cusp::stream
