// SettingsKeeper: the stored state and the wishes to store it.
//
//   change(), restore()  ->  wants_store()  ->  the caller writes stored()  ->  store_done()
#pragma once

#include <cstdint>
#include <optional>

#include "firmware/base/error.hpp"
#include "firmware/machine/stored_state.hpp"
#include "firmware/protocol/reply_queue.hpp"

namespace cusp::machine {

// Context: main loop.
class SettingsKeeper {
public:
    //   factory  the settings where the store holds none, and after `$RST=$`; those of Grbl where
    //            it is null. Must outlive this.
    //   board    its capabilities: settings beyond them are refused
    SettingsKeeper(const Settings* factory, const BoardLimits& board) noexcept;

    StoredState& stored() noexcept { return stored_; }
    const StoredState& stored() const noexcept { return stored_; }
    const Settings& settings() const noexcept { return stored_.settings; }
    const BoardLimits& board() const noexcept { return board_; }

    // Replaces settings that this board can't have by those of the factory. True if there were any.
    bool mend() noexcept;
    // Changes one setting and wants it stored, or says why not in `out`.
    std::optional<Error> change(std::uint32_t number,
                                float value,
                                protocol::ReplyQueue& out) noexcept;
    void restore_settings() noexcept;
    void forget_texts() noexcept;
    // Offsets and tool lengths as they are in the program now. Lengths that were touched off hold until the
    // reset, as their reference does: of the table, only the length of `tool` is taken; 0: none.
    void keep_parameters(const gcode::Parameters& now, unsigned tool) noexcept;

    void want_store() noexcept { store_wanted_ = true; }
    bool wants_store() const noexcept { return store_wanted_; }
    void store_done(bool written) noexcept;
    // A line begins: a store that fails from now on is its error.
    void begin_line() noexcept { store_failed_ = false; }
    // The answer to a line that has stored something, or nothing.
    std::optional<Error> answer() const noexcept
    {
        return store_failed_ ? std::optional<Error>{Error::kSettingReadFail} : std::nullopt;
    }

private:
    StoredState stored_;
    const Settings* const factory_;  // may be null
    const BoardLimits board_;
    bool store_wanted_{false};
    bool store_failed_{false};
};

}  // namespace cusp::machine
