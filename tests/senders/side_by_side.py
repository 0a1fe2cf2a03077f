"""Runs the cases of a unittest file side by side, each in a process of its own: most of their time is waiting."""
import concurrent.futures
import subprocess
import sys
import unittest


def names_of(suite):
    for test in suite:
        if isinstance(test, unittest.TestSuite):
            yield from names_of(test)
        else:
            yield test.id().removeprefix("__main__.")


def run_case(name):
    return subprocess.run([sys.executable, *sys.argv[:2], name], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def main(at_once):
    """Runs the cases that argv names after CUSP; without names all, `at_once` at a time. Ends the program."""
    if len(sys.argv) > 2:
        unittest.main(argv=[sys.argv[0]] + sys.argv[2:])
    names = sorted(names_of(unittest.defaultTestLoader.loadTestsFromModule(sys.modules["__main__"])))
    if not names:
        sys.exit("no case")
    with concurrent.futures.ThreadPoolExecutor(at_once) as pool:
        runs = dict(zip(names, pool.map(run_case, names)))
    failed = [name for name, run in runs.items() if run.returncode != 0]
    for name in failed:
        print(f"{name}:\n{runs[name].stdout}")
    print(f"{len(names) - len(failed)} of {len(names)} cases passed")
    sys.exit(1 if failed else 0)
