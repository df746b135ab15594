"""The command: ``python -m dvp fit picture.png --out out``."""

from __future__ import annotations

import signal
import sys

from . import _dvp


def main() -> int:
    """Runs the command with the program's arguments; returns its exit code."""
    # The command runs outside of the interpreter, which would hear of an interrupt only at its end.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.stdout.flush()
    return _dvp.run_command(["dvp", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
