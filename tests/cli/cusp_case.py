"""CuspCase: tests that run cusp, the program named first on the command line, in a folder of their own."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from property_cases import property_cases, share_of  # noqa: E402, F401 (for the tests)

CUSP = str(pathlib.Path(sys.argv[1]).resolve())


class CuspCase(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = pathlib.Path(scratch.name)

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def cusp(self, status, *arguments):
        """The output of cusp, which has to end with this status. Programs whose statistics nobody asks for aren't run for their times."""
        if arguments[0] == "plan" and not {"--stats", "--estimate-times"} & set(arguments):
            arguments = (*arguments, "--estimate-times")
        result = subprocess.run([CUSP, *arguments], cwd=self.folder, text=True, timeout=1200, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT)
        self.assertEqual(status, result.returncode, f"{arguments}: {result.stdout}")
        return result.stdout

    def write_job(self, printed):
        """Writes the job of --print-job as job.toml: it comes after what cusp says of its choices."""
        text = printed[printed.index("# The job"):]
        self.write("job.toml", text)
        return text
