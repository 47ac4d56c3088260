"""The program ``hertzchain``, which a wheel puts on the path; also ``python -m hertzchain``."""

import sys

from ._hertzchain import run_program


def main() -> int:
    """Runs the program with this process' arguments; returns 0, 2 for a mistake of the user, or 1."""
    return run_program(["hertzchain", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
