#!/usr/bin/env python3
"""Executes the code blocks of documentation pages, in order, each page in an empty folder.

    docs/run_blocks.py                        # README.md and all pages but the notes
    docs/run_blocks.py docs/tutorials --keep pages/

What a fenced block is follows from its language:

sh        a bash script; it must succeed
python    statements in one namespace for each page; `hertzchain` must be installed for them
toml      saved under the name that a first line `# name.toml` gives, and checked by `hertzchain check`;
          without a name it is a part of such a file, checked after it has replaced the same keys of
          the last named one
output    what the block before it prints; `...` stands for anything, also for whole lines; a
          number may differ by one unit of its last printed digit, which instruction sets may round
          either way
text      not executed; neither are the site's directives, such as `{toctree}`

Comments before a block, invisible on the page, change this:

<!-- before: SCRIPT -->    a bash script that is run first, such as "$DOCS/record.py", which makes recordings
<!-- tested by: FILE -->   another test of this repository runs the next block
<!-- rust: FILE -->        that test compiles and runs the page's blocks of Rust
<!-- until: TEXT -->       each command of the next block is ended once it has printed TEXT
<!-- wheel: -->            the next block installs a wheel: executed with --wheel, beside a copy of it
<!-- not run: REASON -->   the next block is not executed
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
import tomllib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from shutil import copy

ROOT = Path(__file__).resolve().parent.parent
PAGES = ["README.md", "docs/tutorials", "docs/how-to", "docs/reference", "docs/explanation"]
PIECE = re.compile(
    r"^```(?P<language>[\w-]*|\{[\w-]+\})\n(?P<code>.*?)^```$|^<!--\s*(?P<kind>before|tested by|rust|until|wheel|not run):(?P<text>.*?)-->",
    re.MULTILINE | re.DOTALL,
)
NUMBER = re.compile(r"[-+−]?\d+(?:,\d{3})*(?:\.\d+)?(?:e[-+]?\d+)?")
# Beginnings of numbers before `...`, numbers, spaces, all else.
PIECES = re.compile(rf"[-+−]?\d[\d.]*\.{{3}}|\.{{3}}|{NUMBER.pattern}|\s+|.")
# A block that takes longer than this is no block for a reader to wait for.
LONGEST_S = 600
# The namespace of a page's Python blocks lives in one process, which gets a block at a time.
SESSION = """
import sys, traceback
space = {"__name__": "__main__"}
for line in sys.stdin:
    code = eval(line)
    try:
        exec(compile(code, "<page>", "exec"), space)
        done = "ok"
    except BaseException:
        traceback.print_exc(file=sys.stdout)
        done = "failed"
    print("\\0" + done, flush=True)
"""


class BlockError(Exception):
    """A block that fails or prints something else."""


class Page:
    """One page, its folder and its processes."""

    def __init__(self, path: Path, folder: Path, program: Path, wheel: Path | None) -> None:
        self.path, self.folder, self.wheel = path, folder, wheel
        search = f"{program.parent}{os.pathsep}{os.environ['PATH']}"
        self.environment = {**os.environ, "PATH": search, "MPLBACKEND": "Agg", "NO_COLOR": "1", "DOCS": f"{ROOT / 'docs'}"}
        self.printed: str | None = None
        self.experiment: str | None = None
        self.python: subprocess.Popen[str] | None = None
        self.rust_is_run = False
        self.until: str | None = None

    def run(self) -> int:
        """Executes all blocks; returns their number."""
        text = self.path.read_text(encoding="utf-8")
        count, skipped = 0, False
        for piece in PIECE.finditer(text):
            line = text.count("\n", 0, piece.start()) + 1
            try:
                if piece["kind"]:
                    skipped = self.comment(piece["kind"], piece["text"].strip())
                elif skipped:
                    skipped = False
                else:
                    count += self.block(piece["language"], piece["code"])
            except BlockError as error:
                raise BlockError(f"{self.path.relative_to(ROOT)}:{line}: {error}") from None
        if self.python:
            self.python.kill()
        return count

    def comment(self, kind: str, text: str) -> bool:
        """Obeys a comment; returns whether the next block is skipped."""
        if kind == "before":
            self.shell(text)
            return False
        if kind == "wheel":
            if self.wheel:
                copy(self.wheel, self.folder)
            return not self.wheel
        if kind == "until":
            self.until = text
            return False
        if kind != "not run" and self.path.name not in (ROOT / text).read_text(encoding="utf-8"):
            raise BlockError(f"{text} does not read this page")
        self.rust_is_run |= kind == "rust"
        return kind != "rust"

    def block(self, language: str, code: str) -> int:
        """Executes a block; returns 1 if it is one to execute."""
        match language:
            case "sh" if self.until:
                self.ended(code, self.until)
                self.until = None
            case "sh":
                self.printed = self.shell(code)
            case "python":
                self.printed = self.statements(code)
            case "toml":
                self.printed = self.toml(code)
            case "output":
                compare(code, self.printed)
            case "text" | "bibtex":
                return 0
            case _ if language.startswith("{"):
                return 0
            case "rust" if self.rust_is_run:
                return 1
            case _:
                raise BlockError(f"a block in '{language}' is not run: see {Path(__file__).name}")
        return 1

    def shell(self, code: str) -> str:
        done = subprocess.run(
            ["bash", "-euo", "pipefail", "-c", code],
            cwd=self.folder,
            env=self.environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=LONGEST_S,
        )
        if done.returncode:
            raise BlockError(f"exit code {done.returncode}\n{code}\n{done.stdout}")
        return done.stdout

    def ended(self, code: str, text: str) -> None:
        """Runs commands that go on until they are ended, one a line."""
        for command in code.splitlines():
            with subprocess.Popen(
                ["bash", "-c", f"exec {command}"],
                cwd=self.folder,
                env=self.environment,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
            ) as process:
                assert process.stdout
                printed = next((line for line in process.stdout if text in line), None)
                process.terminate()
            if printed is None:
                raise BlockError(f"{command}: ends without printing {text!r}")

    def statements(self, code: str) -> str:
        if not self.python:
            self.python = subprocess.Popen(
                [sys.executable, "-c", SESSION],
                cwd=self.folder,
                env=self.environment,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                # Libraries write there that a cache is built; a traceback goes to standard output.
                stderr=subprocess.DEVNULL,
                text=True,
            )
        assert self.python.stdin and self.python.stdout
        self.python.stdin.write(f"{code!r}\n")
        self.python.stdin.flush()
        lines: list[str] = []
        for line in self.python.stdout:
            text, end, done = line.partition("\0")
            lines.append(text)
            if end and done.strip() == "ok":
                return "".join(lines)
            if end:
                break
        raise BlockError(f"\n{code}\n{''.join(lines)}")

    def toml(self, code: str) -> str:
        try:
            keys = tomllib.loads(code)
        except tomllib.TOMLDecodeError as error:
            raise BlockError(f"no TOML: {error}") from None
        if named := re.match(r"# ([\w-]+\.toml)\n", code):
            self.experiment = named[1]
            (self.folder / named[1]).write_text(code, encoding="utf-8")
            return self.shell(f"hertzchain check {named[1]}")
        if self.experiment is None:
            raise BlockError("a part of an experiment file comes after a whole one, whose first line is # name.toml")
        whole = (self.folder / self.experiment).read_text(encoding="utf-8")
        (self.folder / "part.toml").write_text(replaced(whole, code, set(keys)), encoding="utf-8")
        return self.shell("hertzchain check part.toml")


def replaced(whole: str, part: str, keys: set[str]) -> str:
    """An experiment file without its own values of some keys, then with others."""
    head, bracket, tables = whole.partition("\n[")
    own, others = part.partition("[")[::2] if part.lstrip().startswith("[") else (part, "")
    statements = re.split(r"\n(?=[\w-])", head)
    chunks = re.split(r"\n(?=\[)", bracket + tables)
    kept = [text for text in statements if root(text) not in keys]
    kept += [own] + [text for text in chunks if root(text) not in keys]
    return "\n".join(kept) + (f"\n[{others}" if others else "")


def root(text: str) -> str:
    """The first name of a statement or a table's heading."""
    found = re.search(r"^\[*\s*([\w-]+)", text.lstrip("\n"))
    return found[1] if found else ""


def compare(expected: str, printed: str | None) -> None:
    """Holds what was printed against the page, line by line."""
    if printed is None:
        raise BlockError("output without a block that prints it")
    want, have = expected.splitlines(), [line.rstrip() for line in printed.splitlines()]
    if not matches(want, have):
        raise BlockError(f"prints something else\n--- the page\n{expected}\n--- the program\n{printed}")


def matches(want: list[str], have: list[str]) -> bool:
    """Whether lines are as wanted; a line ``...`` stands for any number of lines."""
    if not want:
        return not have
    if want[0].strip() == "...":
        return any(matches(want[1:], have[start:]) for start in range(len(have) + 1))
    return bool(have) and same(want[0], have[0]) and matches(want[1:], have[1:])


def same(want: str, have: str) -> bool:
    """Whether two lines agree but for spaces and the last digits of numbers."""
    numbers: list[str] = []

    def piece(found: re.Match[str]) -> str:
        text = found[0]
        if text.endswith("..."):
            return re.escape(text[:-3]) + ".*?"
        if text.isspace():
            return r"\s+"
        if not NUMBER.fullmatch(text):
            return re.escape(text)
        numbers.append(text)
        return f"({NUMBER.pattern})"

    pattern = PIECES.sub(piece, want.strip())
    found = re.fullmatch(rf"\s*{pattern}\s*", have)
    return found is not None and all(map(close, numbers, found.groups()))


def close(want: str, have: str) -> bool:
    """Whether two numbers agree within one and a half units of the last digit of the first."""
    value, other = (float(text.replace(",", "").replace("−", "-")) for text in (want, have))
    digits, _, power = want.replace(",", "").partition("e")
    unit = 10.0 ** (int(power or 0) - len(digits.partition(".")[2]))
    return value == other or ("." in digits and abs(value - other) <= 1.5 * unit)


def pages(names: list[str]) -> list[Path]:
    """The Markdown files behind names of files and folders."""
    paths = [(ROOT / name).resolve() for name in names]
    return [page for path in paths for page in (sorted(path.glob("*.md")) if path.is_dir() else [path])]


def run(page: Path, program: Path, keep: Path | None, wheel: Path | None = None) -> str:
    """Executes a page; returns a line for the report."""
    with tempfile.TemporaryDirectory() as folder:
        work = Path(keep or folder) / page.stem
        work.mkdir(parents=True, exist_ok=True)
        count = Page(page, work, program, wheel).run()
    return f"{count:3} blocks  {page.relative_to(ROOT)}"


def main() -> int:
    parser = argparse.ArgumentParser(description="Execute the code blocks of documentation pages.")
    parser.add_argument("pages", nargs="*", default=PAGES, help="files and folders")
    parser.add_argument("--program", type=Path, default=ROOT / "target/release/hertzchain", help="the program to run")
    parser.add_argument("--wheel", type=Path, help="this machine's wheel, for blocks that install it")
    parser.add_argument("--keep", type=Path, help="a folder that keeps what the blocks write")
    parser.add_argument("--jobs", type=int, default=2, help="pages at a time")
    options = parser.parse_args()
    program = options.program.absolute()
    if not program.exists():
        parser.error(f"{program} is not there: cargo build --release, or name another by --program")
    failed = 0
    with ThreadPoolExecutor(options.jobs) as pool:
        started = [(page, pool.submit(run, page, program, options.keep, options.wheel)) for page in pages(options.pages)]
        for _page, job in started:
            try:
                print(job.result(), flush=True)
            except BlockError as error:
                failed += 1
                print(f"FAILED {error}", flush=True)
    print(f"{len(started) - failed} passed, {failed} failed")
    return int(failed > 0)


if __name__ == "__main__":
    sys.exit(main())
