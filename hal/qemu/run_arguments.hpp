// RunArguments: the command line of a run under QEMU.
#pragma once

#include <array>
#include <string_view>

#include "hal/qemu/semihosting.hpp"

namespace cusp::hal::qemu {

// Words as boards/mill3_f405_qemu/qemu_traits.hpp lists them. File names have no spaces.
class RunArguments {
public:
    RunArguments() noexcept
    {
        read_command_line(text_);
        char* word = text_.data();
        while (*word != '\0') {
            char* rest = cut_word(word);
            const std::string_view name{word};
            if (name == "real") {
                real_pace_ = true;
            } else if (name == "program") {
                program_ = rest;
            } else if (name == "script") {
                script_ = rest;
            } else if (name == "trace") {
                trace_ = rest;
            }
            word = rest;
        }
    }

    // Empty where there is none.
    const char* program() const noexcept { return program_; }
    const char* script() const noexcept { return script_; }
    const char* trace() const noexcept { return trace_; }
    bool real_pace() const noexcept { return real_pace_; }

private:
    // Ends the word that begins here; returns the start of the next one.
    static char* cut_word(char* word) noexcept
    {
        while (*word != '\0' && *word != ' ') {
            ++word;
        }
        if (*word == ' ') {
            *word = '\0';
            ++word;
        }
        return word;
    }

    std::array<char, 1024> text_{};
    const char* program_{""};
    const char* script_{""};
    const char* trace_{""};
    bool real_pace_{false};
};

}  // namespace cusp::hal::qemu
