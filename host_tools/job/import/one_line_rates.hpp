// Feeds and speeds of a one-line call by its material, within the limits of its machine.
#pragma once

#include "host_tools/job/import/one_line_choice.hpp"

namespace cusp::import {

// Takes the rates of the call's material in place of those chosen, and lowers them to what its machine reaches; nothing
// without these.
//
// Errors: InputError where an option asks for more than the machine reaches, or a file can't be read.
void put_rates(const OneLineRequest& request, OneLineChoice& choice);

}  // namespace cusp::import
