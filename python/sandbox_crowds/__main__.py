"""The program `sandbox`."""

import signal
import sys


def main() -> None:
    """Runs the program with the arguments of this process."""
    # The program has its own handlers, or wants to end.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    from sandbox_crowds import _native

    sys.exit(_native.main(sys.argv[1:]))


if __name__ == "__main__":
    main()
