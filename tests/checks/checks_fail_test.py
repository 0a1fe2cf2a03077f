#!/usr/bin/env python3
"""Shows that each check of the tree fails where it should: a check that finds nothing is no check."""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
TABLE = "| firmware/base | |\n| firmware/path | firmware/base |\n"


class ChecksOfTheTree(unittest.TestCase):
    def setUp(self):
        self.top = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.top)
        self.write("docs/architecture.md", TABLE)

    def write(self, place, text):
        file = self.top / place
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def run_check(self, name, *arguments):
        program = [sys.executable] if name.endswith(".py") else ["sh"]
        run = subprocess.run([*program, str(HERE / name), str(self.top), *arguments],
                             capture_output=True, text=True)
        return run.returncode, run.stdout + run.stderr

    def test_includes_passes_an_allowed_arrow(self):
        self.write("firmware/path/line.hpp", '#include "firmware/base/vec.hpp"\n#include <array>\n')
        self.assertEqual(self.run_check("includes.py")[0], 0)

    def test_includes_refuses_an_arrow_that_is_not_in_the_table(self):
        self.write("firmware/base/vec.hpp", '\n#include "firmware/path/line.hpp"\n')
        status, text = self.run_check("includes.py")
        self.assertEqual(status, 1)
        self.assertIn("firmware/base/vec.hpp:2", text)

    def test_includes_refuses_a_folder_without_a_row(self):
        self.write("firmware/new/thing.hpp", "")
        self.assertEqual(self.run_check("includes.py")[0], 1)

    def test_includes_refuses_the_heap_in_firmware(self):
        self.write("firmware/base/vec.hpp", "#include <vector>\n")
        self.assertEqual(self.run_check("includes.py")[0], 1)

    def test_includes_refuses_a_path_that_does_not_start_at_the_top(self):
        self.write("firmware/base/vec.hpp", '#include "axis.hpp"\n')
        self.assertEqual(self.run_check("includes.py")[0], 1)

    def test_includes_refuses_an_arrow_that_nothing_uses(self):
        self.write("firmware/path/line.hpp", "#include <array>\n")
        status, text = self.run_check("includes.py")
        self.assertEqual(status, 1)
        self.assertIn("firmware/path includes nothing of firmware/base", text)

    def test_includes_follows_arrows_as_far_as_they_lead(self):
        rows = ["| hal | firmware/path |\n", "| boards | hal |\n"]
        self.write("docs/architecture.md", TABLE + "".join(rows))
        self.write("firmware/path/line.hpp", '#include "firmware/base/vec.hpp"\n')
        self.write("hal/pin.hpp", '#include "firmware/path/line.hpp"\n')
        self.write("boards/pins.hpp", '#include "firmware/base/vec.hpp"\n#include "hal/pin.hpp"\n')
        self.assertEqual(self.run_check("includes.py"), (0, "includes: 3 files keep to the arrows\n"))
        self.write("firmware/path/pins.hpp", '#include "boards/pins.hpp"\n')
        status, text = self.run_check("includes.py")
        self.assertEqual((status, text), (1, "firmware/path/pins.hpp:1: firmware/path may not include boards/pins.hpp\n"))

    def test_includes_refuses_an_arrow_that_others_imply(self):
        self.write("docs/architecture.md", TABLE + "| hal | firmware/base firmware/path |\n")
        self.write("firmware/path/line.hpp", '#include "firmware/base/vec.hpp"\n')
        self.write("hal/pin.hpp", '#include "firmware/base/vec.hpp"\n#include "firmware/path/line.hpp"\n')
        status, text = self.run_check("includes.py")
        self.assertEqual((status, text), (1, "docs/architecture.md: hal may include firmware/base by its other arrows\n"))

    def test_includes_refuses_a_target_whose_dependencies_are_not_its_row(self):
        self.write("firmware/path/line.hpp", '#include "firmware/base/vec.hpp"\n')
        self.write("firmware/base/CMakeLists.txt", "cusp_module(NAME base LINKS cusp::path)\n")
        self.write("firmware/path/CMakeLists.txt", "cusp_module(NAME path DEPENDS cusp::base)\n")
        self.assertEqual(self.run_check("includes.py"), (0, "includes: 1 files keep to the arrows\n"))
        self.write("firmware/path/CMakeLists.txt", "cusp_module(NAME path)  # cusp::base\n")
        status, text = self.run_check("includes.py")
        self.assertEqual(status, 1)
        self.assertIn("firmware/base is missing", text)
        self.write("firmware/path/CMakeLists.txt", "cusp_module(NAME path DEPENDS cusp::base)\n")
        self.write("firmware/base/CMakeLists.txt", "cusp_module(NAME base DEPENDS cusp::path)\n")
        status, text = self.run_check("includes.py")
        self.assertEqual(status, 1)
        self.assertIn("firmware/base includes nothing of firmware/path", text)

    def test_includes_refuses_a_second_user_of_import(self):
        self.write("docs/architecture.md", "| host_tools/job | |\n| host_tools/judge | host_tools/job |\n")
        self.write("host_tools/job/import/CMakeLists.txt", "cusp_module(NAME import)\n")
        self.write("host_tools/judge/view/page.hpp", '#include "host_tools/job/import/import.hpp"\n')
        status, text = self.run_check("includes.py")
        self.assertEqual(status, 1)
        self.assertIn("host_tools/job/import/import.hpp is for host_tools/job/ ", text)

    def test_includes_refuses_ways_round(self):
        self.write("docs/architecture.md", "| host_tools/job | host_tools/judge |\n| host_tools/judge | host_tools/job |\n")
        status, text = self.run_check("includes.py")
        self.assertEqual(status, 2)
        self.assertIn("a way round: host_tools/job -> host_tools/judge -> host_tools/job", text)
        self.write("docs/architecture.md", "| host_tools/job | |\n")
        for name, other in (("a", "b"), ("b", "a")):
            self.write(f"host_tools/job/{name}/CMakeLists.txt", f"cusp_module(NAME {name} DEPENDS cusp::{other})\n")
            self.write(f"host_tools/job/{name}/{name}.hpp", f'#include "host_tools/job/{other}/{other}.hpp"\n')
        status, text = self.run_check("includes.py")
        self.assertEqual(status, 1)
        self.assertIn("modules: a way round: host_tools/job/a -> host_tools/job/b -> host_tools/job/a", text)

    def test_includes_needs_a_table_and_sources(self):
        self.assertEqual(self.run_check("includes.py")[0], 2)
        self.write("docs/architecture.md", "none\n")
        self.assertEqual(self.run_check("includes.py")[0], 2)

    def test_strategy_names_refuses_a_name_outside_the_strategies(self):
        self.assertEqual(self.run_check("strategy_names.py")[0], 2)
        self.write("host_tools/cam/trace/trace.cpp", 'const Strategy kTrace{"trace", "..."};\nif (name == "trace") {}\n')
        self.write("host_tools/cam/plan/plan.cpp", 'if (strategy == nullptr) {}  // as "trace"\n')
        self.assertEqual(self.run_check("strategy_names.py")[0], 0)
        for line in ('const char* kName = "trace";', "if (operation.strategy == &trace::kTrace) {}",
                     "if (operation.strategy->name != word) {}", 'if (operation.name() == word) {}'):
            self.write("host_tools/cam/plan/plan.cpp", line)
            status, text = self.run_check("strategy_names.py")
            self.assertEqual((status, text.startswith("host_tools/cam/plan/plan.cpp:1: ")), (1, True), line)

    def test_format_refuses_a_badly_laid_out_file(self):
        shutil.copy(HERE.parent.parent / ".clang-format", self.top)
        self.write("firmware/base/vec.hpp", "#pragma once\nint  x ;\n")
        self.assertEqual(self.run_check("format.sh")[0], 1)
        self.assertEqual(self.run_check("format.sh", "--fix")[0], 0)
        self.assertEqual(self.run_check("format.sh")[0], 0)

    def test_format_needs_sources(self):
        shutil.copy(HERE.parent.parent / ".clang-format", self.top)
        self.assertEqual(self.run_check("format.sh")[0], 2)

    def test_doc_names_refuses_names_that_do_not_exist(self):
        self.write("firmware/base/vec.hpp", "int norm(int x);\n")
        self.write("docs/life.md", "`norm()` is in `firmware/base/vec.hpp`\n")
        self.assertEqual(self.run_check("doc_names.py", "docs/life.md")[0], 0)
        self.write("docs/life.md", "`norm()` then `Vec::dot()`\n")
        self.assertEqual(self.run_check("doc_names.py", "docs/life.md")[0], 1)
        self.write("firmware/base/vec.hpp", "int norm(int x);\nclass UnitVector;\n")
        self.write("docs/life.md", "`UnitVector::norm()` of a `UnitVector`\n")
        self.assertEqual(self.run_check("doc_names.py", "docs/life.md")[0], 0)
        self.write("docs/life.md", "`UnitVectors`\n")
        self.assertEqual(self.run_check("doc_names.py", "docs/life.md")[0], 1)
        self.write("docs/life.md", "in `firmware/base/vector.hpp`\n")
        self.assertEqual(self.run_check("doc_names.py", "docs/life.md")[0], 1)

    def test_doc_names_needs_the_document(self):
        self.assertEqual(self.run_check("doc_names.py", "docs/none.md")[0], 2)

    def test_line_lengths_refuses_a_long_line(self):
        self.assertEqual(self.run_check("line_lengths.py", "10", "docs/papers.md")[0], 2)
        self.write("docs/papers.md", "short\n" + "a" * 10 + "\n")
        self.assertEqual(self.run_check("line_lengths.py", "10", "docs/papers.md")[0], 0)
        status, text = self.run_check("line_lengths.py", "9", "docs/papers.md")
        self.assertEqual(status, 1)
        self.assertIn("docs/papers.md:2: 10 characters; limit 9", text)

    def test_front_doors_need_a_row_and_an_example(self):
        self.assertEqual(self.run_check("front_doors.py")[0], 2)
        self.write("firmware/base/vec.hpp", "// Vectors.\n//\n//   Vec3d v{1, 2, 3};\n#pragma once\n")
        self.write("docs/architecture.md", "| `firmware/base` | `vec.hpp` | its first type |\n")
        self.assertEqual(self.run_check("front_doors.py")[0], 0)
        self.write("firmware/path/line.hpp", "// Lines.\n")
        status, text = self.run_check("front_doors.py")
        self.assertEqual(status, 1)
        self.assertIn("firmware/path: has no path.hpp", text)
        self.write("docs/architecture.md", "| `firmware/base` | `vec.hpp` | its first type |\n| `firmware/path` | `line.hpp` | x |\n")
        status, text = self.run_check("front_doors.py")
        self.assertEqual(status, 1)
        self.assertIn("firmware/path/line.hpp:1: the opening comment of a front door needs an example", text)
        self.write("docs/architecture.md", "| `firmware/base` | `vec.hpp` | its first type |\n| `firmware/path` | `arc.hpp` | |\n")
        self.assertIn("firmware/path: has no arc.hpp", self.run_check("front_doors.py")[1])

    def test_front_doors_have_the_name_of_the_module_or_a_reason(self):
        text = "// Lines.\n//\n//   Line line;\n#pragma once\nclass LineSet final {\n};\n"
        self.write("firmware/path/line_set.hpp", text)
        for row, wrong in (("| `line_set.hpp` | |", "needs the name path.hpp"),
                           ("| `line_set.hpp` | class `Line` |", "does not define the class Line "),
                           ("| `line_set.hpp` | class `LineSet` |", None),
                           ("| `line_set.hpp` | the first of its types |", None)):
            self.write("docs/architecture.md", f"| `firmware/path` {row}\n")
            status, said = self.run_check("front_doors.py")
            self.assertEqual(status, 1 if wrong else 0, said)
            self.assertIn(wrong or "1 modules", said)
        self.write("firmware/path/path.hpp", text)
        self.assertIn("is not path.hpp, which exists", self.run_check("front_doors.py")[1])
        self.write("docs/architecture.md", "| `firmware/path` | `path.hpp` | a reason |\n")
        self.assertIn("it needs no row", self.run_check("front_doors.py")[1])

    def test_sizes_refuses_long_files_and_functions_and_private_parts_first(self):
        self.assertEqual(self.run_check("sizes.py")[0], 2)
        body = "\n".join(["    step();"] * 56)
        function = "namespace cusp {\n\n%sint cut(int a,\n        int b)\n{\n" + body + "\n%s}\n\n}  // namespace cusp\n"
        place = "host_tools/cam/clearing/cut.cpp"
        self.write(place, function % ("// Cuts.\n", ""))
        self.assertEqual(self.run_check("sizes.py")[0], 0)
        self.write(place, function % ("// Cuts.\n", "    step();\n"))
        status, text = self.run_check("sizes.py")
        self.assertEqual(status, 1)
        self.assertIn(f"{place}:4: a function of 61 lines", text)
        self.write(place, function % ("// Over 60 lines: a list of steps.\n", "    step();\n"))
        self.assertEqual(self.run_check("sizes.py")[0], 0)
        self.write("host_tools/cam/clearing/ring.hpp", "class Ring {\npublic:\n    int of() const;\n\nprivate:\n    int of_;\n};\n")
        self.assertEqual(self.run_check("sizes.py")[0], 0)
        self.write("host_tools/cam/clearing/ring.hpp", "class Ring {\n    int of_;\n\nprivate:\n    int at_;\n\npublic:\n};\n")
        status, text = self.run_check("sizes.py")
        self.assertEqual(status, 1)
        self.assertIn("host_tools/cam/clearing/ring.hpp:1: a class", text)
        self.write("host_tools/cam/clearing/ring.hpp", "// A ring.\n" * 501)
        self.assertIn("501 lines; limit 500", self.run_check("sizes.py")[1])

    def test_constants_refuses_other_names_for_nothing_and_for_the_inch(self):
        self.assertEqual(self.run_check("constants.py")[0], 2)
        place = "host_tools/cam/clearing/loops.cpp"
        for line, wrong in (("double least = kUnbounded;  // not 1e300", None), ("constexpr double kMost = 1e12;  // mm", None),
                            ('text("1e9");', None), ("double small = 1e-9;", None), ("double least = 1e300;", "1e300 is"),
                            ("box = {1e9, -1e9};", "1e9 is"), ("constexpr double kFar = kInfinite;", "a second name"),
                            ("constexpr double kFar{-kUnbounded};", "a second name"),
                            ("double least = std::numeric_limits<double>::max();", "numeric_limits<double>::max is"),
                            ("double left = std::nan(\"\");", "std::nan( is"), ("double unit = inch ? 25.4 : 1.0;", "25.4 is"),
                            ("double x = elementary::sin(angle) + cosine(2) + arc.cos(3);", None),
                            ("double x = radius * std::sin(angle);", "std::sin() is not the same"),
                            ("double x = 2 * atan2(way.y, way.x);", "atan2() is not the same"),
                            ("double x = std::pow(10.0, digits);", "std::pow() is not the same"),
                            ("out << stats.dump(1);", "dump() is json_text::written()")):
            self.write(place, f"\n{line}\n")
            status, said = self.run_check("constants.py")
            self.assertEqual(status, 1 if wrong else 0, said)
            self.assertIn(f"{place}:2: {wrong}" if wrong else "1 files", said)

    def test_headers_refuses_one_that_leans_on_its_reader(self):
        self.write("firmware/base/vec.hpp", "#pragma once\nstd::size_t size();\n")
        self.assertEqual(self.run_check("headers.py", "g++")[0], 1)

    def test_headers_refuses_two_of_one_name(self):
        self.write("firmware/base/vec.hpp", "#pragma once\n")
        self.write("firmware/path/vec.hpp", "#pragma once\n")
        self.assertEqual(self.run_check("headers.py", "g++")[0], 1)

    def test_unnamed_names_refuses_one_name_in_two_sources_of_a_folder(self):
        self.assertEqual(2, self.run_check("unnamed_names.py")[0])
        unnamed = "namespace {{\n{}\n}}  // namespace\n".format
        self.write("host_tools/cam/clearing/loops.cpp", unnamed("constexpr double kStep = 0.1;  // mm"))
        for place, text, status in (("host_tools/geometry/offset/rings.cpp", "constexpr int kStep{2};", 0),
                                    ("host_tools/cam/clearing/rings.cpp", "constexpr int kStep{2};", 1),
                                    ("host_tools/cam/clearing/rings.cpp", "struct Ring {\n};", 0),
                                    ("host_tools/cam/clearing/arcs.cpp", "struct Ring {\n};", 1),
                                    ("host_tools/cam/clearing/arcs.cpp", "double of(int a)\n{\n}", 0),
                                    ("host_tools/cam/clearing/loops.cpp", "double of(double a)\n{\n}", 0),
                                    ("host_tools/cam/clearing/loops.cpp", "double of(int a)\n{\n}", 1)):
            self.write(place, unnamed(text))
            self.assertEqual(status, self.run_check("unnamed_names.py")[0], (place, text))

    def test_examples_refuses_files_outside(self):
        self.assertEqual(2, self.run_check("examples.py")[0])
        self.write("examples/parts/floor.json", "")
        self.write("examples/a/job.toml", '[[operation]]\nfloor = "../parts/floor.json"\n')
        self.assertEqual(0, self.run_check("examples.py")[0])
        self.write("outside.json", "")
        for name in ("../../outside.json", "../parts/none.json"):
            self.write("examples/a/job.toml", f'[[operation]]\nislands = ["../parts/floor.json", "{name}"]\n')
            status, text = self.run_check("examples.py")
            self.assertEqual(1, status)
            self.assertIn(name, text)


if __name__ == "__main__":
    unittest.main()
