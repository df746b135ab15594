"""The packages that the baseline needs, in an environment of its own."""

import pathlib
import subprocess
import sys

PACKAGES = ["numpy", "pillow", "scikit-image", "matplotlib"]


def run_with_packages(work):
    """The running script again in the environment of `work`, which is made where it is not there: its code; none if it runs in it."""
    home = work / "venv"
    python = home / "bin/python"
    if pathlib.Path(sys.prefix).resolve() == home.resolve():
        return None
    if not python.exists():
        subprocess.run([sys.executable, "-m", "venv", home], check=True)
        subprocess.run([python, "-m", "pip", "install", "-q", *PACKAGES], check=True)
    return subprocess.run([python, *sys.argv]).returncode
