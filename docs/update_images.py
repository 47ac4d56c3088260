#!/usr/bin/env python3
"""Draws the figures of the pages anew, by running the pages: docs/update_images.py [--program PROGRAM]

With --paper also those that `reproduce` draws, which takes some minutes of a release build.
"""

import argparse
import subprocess
import tempfile
from pathlib import Path
from shutil import copyfile

from run_blocks import ROOT, run

# Image: the page's file.
PAGES = {
    "my-first-chain": {"first-chain-signals": "shot/signals.png", "first-chain-sweep": "lossy/sweep.png"},
    "from-a-recording": {"recording-picks": "measured/signals.png", "recording-curve": "curve/times-of-flight.png"},
    "fit-and-find-the-oil": {"fit": "fitted/fit.png", "gauge": "gauged/contacts.png"},
    "a-virtual-rig": {"rig-curves": "measured/times-of-flight.png"},
    "feel-a-specimen": {"specimen-signals": "probe/signals.png", "specimen-calibration": "calibration.png"},
    "dimers-and-long-chains": {"band-gap": "band-gap.png"},
    "a-lesson": {"cradle-contacts": "contacts.png"},
}
PAPER = {"figure2": [], "rig_gaps": ["--rig"], "rig_rebounds": ["--rig"]}
IMAGES = ROOT / "docs/images"


def main() -> None:
    parser = argparse.ArgumentParser(description="Draw the figures of the pages anew.")
    parser.add_argument("--program", type=Path, default=ROOT / "target/release/hertzchain", help="the program to run")
    parser.add_argument("--paper", action="store_true", help="also the figures of `reproduce`")
    options = parser.parse_args()
    program = options.program.absolute()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for page, images in PAGES.items():
            print(run(ROOT / f"docs/tutorials/{page}.md", program, folder), flush=True)
            for image, file in images.items():
                copyfile(folder / page / file, IMAGES / f"{image}.png")
        for image, words in PAPER.items() if options.paper else ():
            out = folder / "-".join(["paper", *words])
            if not out.exists():
                subprocess.run([program, "reproduce", *words, "--out", out], check=False, stdout=subprocess.DEVNULL)
            copyfile(next(out.rglob(f"{image}.png")), IMAGES / f"{image}.png")


if __name__ == "__main__":
    main()
