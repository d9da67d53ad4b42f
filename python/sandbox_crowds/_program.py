"""The program in a process of its own: what it can do, the module need not do once more."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from typing import Any

from ._native import Error


def flags(options: dict[str, Any]) -> list[str]:
    """Keywords as the program's options: `debug_agents="17,42"` becomes `--debug-agents=17,42`.

    `True` gives a flag alone, `None` and `False` none. Tuples become values with commas, lists repeat the option.
    """
    given = []
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        if hasattr(value, "tolist"):  # of NumPy
            value = value.tolist()
            value = tuple(value) if isinstance(value, list) else value
        for one in value if isinstance(value, list) else [value]:
            if one is True:
                given.append(option)
            elif one is not None and one is not False:
                text = ",".join(map(str, one)) if isinstance(one, tuple) else str(one)
                given.append(f"{option}={text}")
    return given


def call(
    command: str,
    *arguments: str,
    options: dict[str, Any] | None = None,
    said: Callable[[str], None] = lambda line: None,
) -> str:
    """Runs a command and returns its output; `said` gets each line of its messages.

    Raises `Error` with the program's message if it fails.
    """
    words = [command, *flags(options or {}), "--", *arguments]
    words = [sys.executable, "-m", "sandbox_crowds", *words]
    lines: list[str] = []
    with tempfile.TemporaryFile("w+", encoding="utf-8") as output:
        program = subprocess.Popen(
            words,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.PIPE,
            text=True,
            encoding="utf-8",
            errors="replace",
            env=os.environ | {"PYTHONSAFEPATH": "1"},  # no module of the working directory
        )
        assert program.stderr is not None
        try:
            for line in program.stderr:
                lines.append(line)
                said(line)
            code = program.wait()
        except BaseException:
            program.terminate()
            program.wait()
            raise
        finally:
            program.stderr.close()
        output.seek(0)
        text = output.read()
    if code == 130:
        raise KeyboardInterrupt
    if code != 0:
        raise Error(_message("".join(lines)) or f"the program ended with code {code}")
    return text


def _message(text: str) -> str:
    """The error among the program's messages."""
    begin = text.rfind("error: ")
    return text[max(begin, 0) :].removeprefix("error: ").strip()
