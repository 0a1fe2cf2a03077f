#!/usr/bin/env python3
"""Shows that each proof of image.py fails on an image that breaks it. Needs the Arm compiler."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
TOP = HERE.parent.parent
FLAGS = ("-std=c++17 -O2 -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard -ffreestanding "
         "-fno-exceptions -fno-rtti -fno-math-errno -fcallgraph-info=su,da -ffunction-sections "
         "-nostartfiles -nostdlib -Wl,--emit-relocs").split()
LAYOUT = """MEMORY { VECTORS (r) : ORIGIN = 0x08000000, LENGTH = 16K
FLASH (rx) : ORIGIN = 0x0800C000, LENGTH = 512K  RAM (rw) : ORIGIN = 0x20000000, LENGTH = 128K }
REGION_ALIAS("STACK", RAM)
INCLUDE hal/stm32f4/sections.ld
"""
# Of an RP2350, whose images are copied to RAM.
COPIED_FLAGS = [{"-mcpu=cortex-m4": "-mcpu=cortex-m33", "-mfpu=fpv4-sp-d16": "-mfpu=fpv5-sp-d16"}.get(flag, flag) for flag in FLAGS]
COPIED_LAYOUT = """MEMORY { FLASH (rx) : ORIGIN = 0x10000000, LENGTH = 4M - 8K  RAM (rwx) : ORIGIN = 0x20000000, LENGTH = 512K }
INCLUDE hal/rp2350/sections.ld
"""
# An image in which all proofs hold; tests replace what one of its functions does.
SOURCE = """
{extra}
volatile int sink;
volatile float number;
volatile double wide;
__attribute__((noinline)) void leaf() {{ sink = sink + 1; }}
extern "C" {{
void cusp_reset() {{ {reset} leaf(); }}
void cusp_servo_tick() {{ number = number * 2.0F; {tick} leaf(); }}
void cusp_serial_interrupt() {{ {serial} leaf(); }}
void cusp_player_interrupt() {{ {player} leaf(); }}
void cusp_rest() {{ {rest} }}
int cusp_main() {{ return 0; }}
void cusp_board_stop() {{}}
__attribute__((section(".vectors"), used)) const unsigned vectors[2] = {{0x20020000u, 0x0800C001u}};
__asm(".global cusp_settings, cusp_settings_sector\\n.set cusp_settings, {settings}\\n.set cusp_settings_sector, 0x4000");
}}
"""


PARTS = {"extra": "", "reset": "", "tick": "", "serial": "", "player": "", "rest": ""}


class Proofs:
    """Proofs that hold of every image; prove(**parts) builds one and runs them."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.place = pathlib.Path(self.folder.name)

    def write(self, layout, **parts):
        (self.place / "bad.cpp").write_text(SOURCE.format(**{**PARTS, **parts}))
        (self.place / "bad.ld").write_text(layout)

    def check_image(self):
        run = subprocess.run([sys.executable, str(HERE / "image.py"), "bad.elf", "."], cwd=self.place, capture_output=True, text=True)
        return run.returncode, run.stdout + run.stderr

    def refuse(self, message, **parts):
        status, text = self.prove(**parts)
        self.assertEqual(status, 1, text)
        self.assertIn(message, text)

    def test_a_good_image_passes(self):
        status, text = self.prove()
        self.assertEqual(status, 0, text)

    def test_doubles_in_the_servo_tick_are_refused(self):
        self.refuse("double: cusp_servo_tick", tick="wide = wide * 3.0;")


class ProofsOfTheImage(Proofs, unittest.TestCase):
    def build(self, settings="0x08004000", **parts):
        self.write(LAYOUT, settings=settings, **parts)
        return subprocess.run(
            ["arm-none-eabi-g++", *FLAGS, "-c", "bad.cpp", "-o", "bad.o"], cwd=self.place,
            capture_output=True, text=True, check=True) and subprocess.run(
            ["arm-none-eabi-g++", *FLAGS, "bad.o", "-T", "bad.ld", f"-L{TOP}", "-e", "cusp_reset",
             "-lgcc", "-o", "bad.elf"], cwd=self.place, capture_output=True, text=True)

    def prove(self, **parts):
        link = self.build(**parts)
        self.assertEqual(link.returncode, 0, link.stderr)
        return self.check_image()

    def test_settings_amid_the_code_are_refused(self):
        self.refuse("settings: .text lies in their sectors", settings="0x08008000")

    def test_settings_where_a_boot_loader_is_are_refused(self):
        self.refuse("settings: they lie before the vectors", settings="0x07FF8000")

    def test_a_file_for_a_boot_loader_that_is_not_behind_it_is_refused(self):
        self.build()
        (self.place / "firmware.bin").write_bytes(bytes(100))
        run = subprocess.run([sys.executable, str(HERE / "image.py"), "bad.elf", ".", "firmware.bin"], cwd=self.place,
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 1, run.stderr)
        for words in ("the vectors are at 0x8000000", "begins with 0x0 0x0", "has 100 bytes"):
            self.assertIn(words, run.stdout)

    def test_the_heap_does_not_even_link(self):
        self.assertNotEqual(self.build(reset="sink = *new int;").returncode, 0)

    def test_a_heap_of_ones_own_is_refused(self):
        self.refuse("symbols: malloc", extra='extern "C" void* malloc(unsigned) { return 0; }')

    def test_exceptions_and_type_information_are_refused(self):
        self.refuse("symbols: __cxa_throw", extra='extern "C" void __cxa_throw() {}')
        self.refuse("symbols: _ZTI", extra='extern "C" { extern const int _ZTI1A; const int _ZTI1A = 1; }')

    def test_stdio_is_refused(self):
        self.refuse("symbols: printf", extra='extern "C" int printf(const char*, ...) { return 0; }')

    def test_doubles_in_the_main_loop_are_allowed(self):
        status, text = self.prove(reset="wide = wide * 3.0;")
        self.assertEqual(status, 0, text)

    def test_floats_in_the_players_interrupt_are_refused(self):
        self.refuse("float: cusp_player_interrupt", player="number = number + 1.0F;")

    def test_floats_below_the_players_interrupt_are_refused(self):
        self.refuse("float: cusp_player_interrupt", player="deep();",
                    extra="__attribute__((noinline)) void deep() { extern volatile float number; "
                          "number = number * number; }")

    def test_recursion_is_refused(self):
        self.refuse("recursion", tick="again(sink);",
                    extra="__attribute__((noinline)) int again(int n) "
                          "{ return n < 2 ? n : again(n - 1) * again(n - 2); }")

    def test_a_call_by_pointer_is_refused(self):
        self.refuse("calls: cusp_servo_tick", extra="void (*volatile pointer)();",
                    tick="pointer(); sink = 2;")

    def test_a_virtual_call_is_refused(self):
        self.refuse("calls: cusp_serial_interrupt", serial="object->act(); sink = 2;",
                    extra="struct Base { virtual void act() = 0; }; Base* volatile object;")

    def test_a_stack_that_only_the_run_can_tell_is_refused(self):
        self.refuse("only the run can tell",
                    tick="volatile char* p = (char*)__builtin_alloca(sink); p[0] = 1;")

    def test_a_stack_that_is_too_deep_is_refused(self):
        self.refuse("bytes are needed", reset="volatile char a[9000]; a[sink] = 1;")

    KEPT = ("extern volatile int sink;\n"
            "__attribute__((noinline, used)) void deep() { volatile char a[5000]; a[sink] = 1; }\n"
            "__attribute__((noinline)) void plain() { sink = 2; }\n")

    def test_a_function_whose_address_is_kept_counts_where_a_pointer_is_called(self):
        self.refuse("bytes are needed", reset="pointer(); sink = 2; other();",
                    extra=self.KEPT + "void (*volatile pointer)() = deep; void (*volatile other)() = plain;")

    def test_a_number_that_equals_an_address_is_no_call(self):
        # The address of deep(), as the image without it has it, as a plain number.
        keep = "void (*volatile pointer)() = plain; volatile unsigned number_ = {};"
        reset = "pointer(); sink = 2; pointer();"
        self.build(extra=self.KEPT + keep.format("1"), reset=reset)
        names = subprocess.run(["arm-none-eabi-nm", "bad.elf"], cwd=self.place, capture_output=True, text=True,
                               check=True).stdout
        deep = next(line.split()[0] for line in names.splitlines() if "deep" in line)
        status, text = self.prove(extra=self.KEPT + keep.format(f"0x{deep}u + 1u"), reset=reset)
        self.assertEqual(status, 0, text)

    def test_a_constructor_counts_at_the_start_alone(self):
        made = ("extern volatile int sink; struct Made {{ __attribute__((noinline)) Made() {{ volatile char a[{}]; a[sink] = 1; }} }};\n"
                "Made made; void (*volatile pointer)() = nullptr;")
        loop = ("extern \"C\" {{ extern void (*cusp_constructors_begin[])(); "
                "extern void (*cusp_constructors_end[])(); }}")
        start = "for (auto c = cusp_constructors_begin; c != cusp_constructors_end; ++c) (*c)();"
        self.refuse("bytes are needed", reset=start, extra=made.format(5000) + loop.format())
        status, text = self.prove(reset=start + "elsewhere();", extra=made.format(3000) + loop.format()
                                  + "__attribute__((noinline)) void elsewhere() "
                                    "{ volatile char b[2000]; b[sink] = 1; pointer(); sink = 2; }")
        self.assertEqual(status, 0, text)

    def test_an_image_without_relocations_is_no_success(self):
        self.build()
        subprocess.run(["arm-none-eabi-objcopy", "--remove-relocations=.*", "bad.elf"], cwd=self.place, check=True)
        run = subprocess.run([sys.executable, str(HERE / "image.py"), str(self.place / "bad.elf"), str(self.place)],
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 2)
        self.assertIn("no relocations", run.stderr)

    def test_a_stack_that_leaves_less_than_a_kilobyte_is_refused(self):
        self.refuse("to spare", reset="volatile char a[5000]; a[sink] = 1;")

    def test_stacks_of_all_priorities_add_up(self):
        self.refuse("bytes are needed", reset="volatile char a[3000]; a[sink] = 1;",
                    tick="volatile char b[3000]; b[sink] = 1;",
                    serial="volatile char c[3000]; c[sink] = 1;")

    def test_too_much_ram_is_refused(self):
        self.refuse("bytes of RAM", extra="char large[100000];", reset="large[sink] = 1;")

    def test_too_much_flash_does_not_even_link(self):
        large = "extern const char large[600000]; const char large[600000] = {1};"
        self.assertIn("overflowed", self.build(extra=large).stderr)

    def test_a_missing_image_is_no_success(self):
        run = subprocess.run([sys.executable, str(HERE / "image.py"), "none.elf", str(self.place)],
                             capture_output=True, text=True)
        self.assertEqual(run.returncode, 2)

    def test_a_missing_call_graph_is_no_success(self):
        self.build()
        run = subprocess.run([sys.executable, str(HERE / "image.py"), str(self.place / "bad.elf"),
                              str(HERE)], capture_output=True, text=True)
        self.assertEqual(run.returncode, 2)


class ProofsOfACopiedImage(Proofs, unittest.TestCase):
    def prove(self, layout=COPIED_LAYOUT, block="0x10210142", clocks="", settings="0x103FE000", **parts):
        self.write(layout, settings=settings, **parts)
        boot = (TOP / "hal/rp2350/boot.cpp").read_text()
        boot = boot.replace("0x10210142", block).replace("cusp_boot_clocks()\n{", f"cusp_boot_clocks()\n{{{clocks}")
        (self.place / "boot.cpp").write_text(boot)
        for name in ("boot", "bad"):
            subprocess.run(["arm-none-eabi-g++", *COPIED_FLAGS, f"-I{TOP}", "-c", f"{name}.cpp", "-o", f"{name}.o"], cwd=self.place, check=True)
        subprocess.run(["arm-none-eabi-g++", *COPIED_FLAGS, "boot.o", "bad.o", "-T", "bad.ld", f"-L{TOP}", "-e", "cusp_boot",
                        "-Wl,--no-warn-rwx-segments", "-lgcc", "-o", "bad.elf"], cwd=self.place, check=True)
        return self.check_image()

    def test_a_function_that_stays_in_the_flash_is_refused(self):
        self.refuse("stays runs at 0x10000", tick="stays();",
                    extra='__attribute__((noinline, long_call, section(".boot"))) void stays() { __asm volatile("nop"); }')

    def test_a_call_of_what_is_not_copied_yet_is_refused(self):
        self.refuse("cusp_boot_clocks calls __early_veneer", clocks="void early(); early();",
                    extra='extern "C" __attribute__((noinline)) void early() { __asm volatile("nop"); }')

    def test_what_rest_calls_and_is_copied_later_is_refused(self):
        self.refuse("leaf is called by cusp_rest, but copied later", rest="leaf();")

    def test_what_rest_reads_and_is_copied_later_is_refused(self):
        self.refuse("which is copied later", rest="sink = levels[sink];",
                    extra="extern volatile int sink; extern const int levels[4]; const int levels[4] = {1, 2, 3, 4};")

    def test_a_block_that_the_boot_rom_does_not_take_is_refused(self):
        self.refuse("copied: the image begins at 0x10000000 with", block="0x10210143")

    def test_settings_amid_the_code_are_refused(self):
        self.refuse("settings: .text lies in their sectors", settings="0x10000000")


if __name__ == "__main__":
    unittest.main()
