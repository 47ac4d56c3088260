"""The array script of docs/how-to/many-machines.md, task by task as Slurm would run it."""

import os
import subprocess
from pathlib import Path

from conftest import ROOT, program

import hertzchain as hc

DOCS = ROOT / "docs/how-to/many-machines.md"


def script() -> str:
    """As it stands on the page."""
    (found,) = (block for block in DOCS.read_text(encoding="utf-8").split("```") if "#SBATCH" in block)
    return found.removeprefix("sh\n")


def shortened(text: str) -> str:
    """Three tasks of a short sweep, with this machine's instructions."""
    for long, short in (("SHARDS=64", "SHARDS=3"), (":100000", ":11"), ("=avx2", f"={hc.instruction_set()}")):
        assert text.count(long) == 1, long
        text = text.replace(long, short)
    return text


def test_the_array_script_is_sound_and_its_shards_are_the_whole(small, tmp_path):
    assert subprocess.run(["bash", "-n"], input=script(), text=True, check=False).returncode == 0
    (tmp_path / "my-row.toml").write_text(small.text)
    (tmp_path / "row.sh").write_text(shortened(script()))
    (tmp_path / "srun").write_text('#!/bin/sh\nexec "$@"\n')
    (tmp_path / "srun").chmod(0o755)
    (tmp_path / "hertzchain").symlink_to(program().resolve())
    environment = {**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}", "SLURM_CPUS_PER_TASK": "2"}

    def run(*command: str | Path, task: int = 0) -> str:
        own = {**environment, "SLURM_ARRAY_TASK_ID": str(task)}
        return subprocess.run(command, cwd=tmp_path, env=own, check=True, capture_output=True, text=True).stdout

    # In any order, and one of them twice: killed and requeued.
    for task in (2, 3, 1, 2):
        run("bash", "row.sh", task=task)
    run("hertzchain", "merge", "shards/", "--out", "whole/")
    command = ("hertzchain", "sweep", "my-row.toml", "--speeds", "log:0.1:1.2:11", "--accuracy", "1e-5", "--out", "one/")
    run(*command)
    assert (tmp_path / "whole/sweep.csv").read_bytes() == (tmp_path / "one/sweep.csv").read_bytes()
