"""Runs images on QEMU's netduinoplus2, in virtual time that is the same in every run."""
import subprocess

MACHINE = ["qemu-system-arm", "-M", "netduinoplus2", "-display", "none", "-monitor", "none"]
# An instruction lasts 8 ns, about what one takes on a 168 MHz Cortex-M4 at 1.3 cycles.
EXACT_TIME = ["-icount", "shift=3,sleep=off"]


class RunFailed(Exception):
    """QEMU could not run the image, or did not come to its end in time."""


def semihosting(words):
    return ["-semihosting-config",
            ",".join(["enable=on", "target=native", *(f"arg={word}" for word in words)])]


def run_image(image, words=(), seconds=300, extra=()):
    """Runs to the image's end. Returns its exit status and what it wrote to the console."""
    command = [*MACHINE, "-serial", "none", *EXACT_TIME, *semihosting(words), *extra,
               "-kernel", str(image)]
    try:
        run = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                             errors="replace", timeout=seconds)
    except subprocess.TimeoutExpired as error:
        raise RunFailed(f"{image} did not end within {seconds} s") from error
    except OSError as error:
        raise RunFailed(f"qemu-system-arm: {error}") from error
    if run.returncode < 0 or "qemu" in run.stderr:
        raise RunFailed(f"{image}: status {run.returncode}: {run.stderr[-500:]}")
    return run.returncode, run.stdout
