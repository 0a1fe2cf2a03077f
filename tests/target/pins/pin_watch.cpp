// A QEMU plugin that logs the time of every store to a port's set/reset register.
//
// QEMU's own log of accesses that it does not model (-d unimp) has the value, this one the
// instruction count; with -d unimp,plugin both are in one file, in order. Debian ships no
// qemu-plugin.h: the part of it that is used (API version 1, QEMU 7.2) is declared here.
#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <cstdio>

#define CUSP_EXPORT __attribute__((visibility("default")))

struct qemu_plugin_tb;
struct qemu_plugin_insn;
struct qemu_info_t;

extern "C" {
using MemoryCallback = void (*)(unsigned, std::uint32_t, std::uint64_t, void*);
using TranslationCallback = void (*)(std::uint64_t, qemu_plugin_tb*);
void qemu_plugin_register_vcpu_tb_trans_cb(std::uint64_t, TranslationCallback);
void qemu_plugin_register_vcpu_insn_exec_inline(qemu_plugin_insn*, int, void*, std::uint64_t);
void qemu_plugin_register_vcpu_mem_cb(qemu_plugin_insn*, MemoryCallback, int, int, void*);
std::size_t qemu_plugin_tb_n_insns(const qemu_plugin_tb*);
qemu_plugin_insn* qemu_plugin_tb_get_insn(const qemu_plugin_tb*, std::size_t);
void qemu_plugin_outs(const char*);

CUSP_EXPORT int qemu_plugin_version = 1;
CUSP_EXPORT int qemu_plugin_install(std::uint64_t id, const qemu_info_t*, int, char**);
}

namespace {

constexpr std::uint64_t kSetResetRegister = 0x40020818;  // GPIOC_BSRR
constexpr int kNoRegisters = 0;
constexpr int kStores = 2;
constexpr int kAdd = 0;

std::uint64_t instructions = 0;

void on_store(unsigned, std::uint32_t, std::uint64_t address, void*)
{
    if (address == kSetResetRegister) {
        char line[40];
        std::snprintf(line, sizeof line, "pin %" PRIu64 "\n", instructions);
        qemu_plugin_outs(line);
    }
}

void on_translation(std::uint64_t, qemu_plugin_tb* block)
{
    for (std::size_t k = 0; k < qemu_plugin_tb_n_insns(block); ++k) {
        qemu_plugin_insn* const instruction = qemu_plugin_tb_get_insn(block, k);
        qemu_plugin_register_vcpu_insn_exec_inline(instruction, kAdd, &instructions, 1);
        qemu_plugin_register_vcpu_mem_cb(instruction, on_store, kNoRegisters, kStores, nullptr);
    }
}

}  // namespace

int qemu_plugin_install(std::uint64_t id, const qemu_info_t*, int, char**)
{
    qemu_plugin_register_vcpu_tb_trans_cb(id, on_translation);
    return 0;
}
