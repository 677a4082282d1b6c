"""Runs scripts/figures at its smallest and checks what it writes. Exit code 77 where it lacks matplotlib.

Usage: check_figures.py STOKES FOLDER    FOLDER is emptied first
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FIGURES = (
    "fig1",
    "fig8",
    "fig9",
    "fig10",
    "fig11",
    "fig12",
    "fig13",
    "fig14",
    "fig15",
    "fig16",
    "fig17",
    "fig18",
    "fig19",
    "fig20",
)
NUMBERS = (
    "fig14.pass_ratio",
    "fig14.slope_with",
    "fig14.slope_without",
    "fig17.edge_width_mm.x1",
    "fig17.edge_width_mm.x2",
    "fig20.passes_with",
    "fig20.passes_without",
    "fig20.rmse_with_cd_m2",
    "fig20.rmse_without_cd_m2",
    "fig12.qdot545.paper.edge_width_mm",
    "fig15.c_0.25.paper.green.edge_width_mm",
)
POSITIVE = (
    "fig1.paper.mean_luminance_cd_m2",
    "fig8.F_30.at_1_mm",
    "fig9.qdot545.peak_nm",
    "fig11.light_without_over_with.qdot545",
    "fig14.mask.with.mean_luminance_cd_m2",
    "fig20.passes_without",
    "fig20.rmse_with_cd_m2",
)


def run(folder, *more):
    command = [sys.executable, str(ROOT / "scripts/figures"), "--tiny", "--stokes", sys.argv[1], "-o", str(folder), *more]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        print(done.stdout, done.stderr, file=sys.stderr)
        sys.exit(done.returncode)
    return done.stdout


def value_of(numbers, path):
    # Keys may have dots in them ("c_0.25"), so names are matched whole, the longest way.
    if not path:
        return numbers
    for key in numbers if isinstance(numbers, dict) else ():
        if path == key or path.startswith(key + "."):
            return value_of(numbers[key], path[len(key) + 1 :])
    sys.exit(f"figures.json: no {path}")


def main():
    folder = pathlib.Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    run(folder)
    numbers = json.loads((folder / "figures.json").read_text(encoding="utf-8"))
    for path in NUMBERS + POSITIVE:
        value = value_of(numbers, path)
        if path in POSITIVE and not value > 0:
            sys.exit(f"figures.json: {path} is {value}, expected more than 0")
    text = (folder / "index.html").read_text(encoding="utf-8")
    for figure in FIGURES:
        if f'id="{figure}"' not in text or figure not in numbers:
            sys.exit(f"no {figure} on the page or in figures.json")
    sources = re.findall(r'src="([^"]+)"', text)
    missing = [source for source in sources if source.startswith("/") or not (folder / source).is_file()]
    if missing or len(sources) < 40:
        sys.exit(f"index.html: {len(sources)} pictures, of which missing: {missing}")
    kept = {file: file.stat().st_mtime_ns for file in (folder / "renders").glob("*.exr")}
    run(folder, "--only", "fig15,fig20")
    if kept != {file: file.stat().st_mtime_ns for file in (folder / "renders").glob("*.exr")}:
        sys.exit("a second run rendered again")


if __name__ == "__main__":
    main()
