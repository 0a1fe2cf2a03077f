// wasm: the C ABI of the WebAssembly module: what its files share.
//
//     CUSP_EXPORT(cusp_length) int cusp_length() { return wasm::text_of_caller().size(); }
#pragma once

#include <string>

#define CUSP_EXPORT(name) extern "C" __attribute__((export_name(#name), used))

namespace cusp::wasm {

// Filled through cusp_text().
std::string& text_of_caller();

}  // namespace cusp::wasm
