#!/usr/bin/env python3
"""Measures how fast the kernels are, and draws it.

Builds stokes_bench where that is needed, runs it, prints its table, and writes its figures as JSON and as a picture.

Usage: scripts/profile_throughput.py [--out PREFIX] [--build-dir DIR] [OPTIONS of stokes_bench]
       scripts/profile_throughput.py --plot-only FILE.json [--out PREFIX]
for example: scripts/profile_throughput.py --quick
             scripts/profile_throughput.py --only rays --mesh my.ply
Writes PREFIX.json and PREFIX.png, PREFIX being throughput in the current folder. How to read them: scripts/README.md.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent

# What must be reached, by the figure's key.
FLOORS = {"closest": 1.15, "closest_portable": 1.05, "any": 1.15, "camera": 1.0, "build": 0.9, "gather": 0.85}
GROUP_COLOURS = {"tracing": "#4477aa", "depositing": "#66ccee", "gathering": "#228833"}
OVERHEAD_COLOUR = "#ee6677"


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", default="throughput", metavar="PREFIX", help="of the files written")
    parser.add_argument("--build-dir", type=pathlib.Path, default=ROOT / "build", metavar="DIR")
    parser.add_argument("--plot-only", metavar="FILE.json", help="draw the figures of an earlier run")
    return parser.parse_known_args()


def build(folder):
    if not (folder / "build.ninja").exists():
        subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                        "--log-level=NOTICE"], check=True)
    subprocess.run(["cmake", "--build", folder, "--target", "stokes_bench"], check=True,
                   stdout=subprocess.DEVNULL)
    return folder / "tests" / "bench" / "stokes_bench"


def kernel_groups(figures):
    """Kernel -> group, as tests/bench/stages.cpp has it and the JSON repeats it."""
    return figures["pass"].get("group_of_kernel", {})


def draw_rays(axes, rays):
    sets = [("closest", "closest_vs_embree"), ("closest_portable", "closest_portable_vs_embree"),
            ("bounce", "bounce_vs_embree"), ("any", "any_vs_embree"), ("camera", "camera_vs_embree16")]
    scenes = list(rays)
    width = 0.8 / len(scenes)
    for s, scene in enumerate(scenes):
        places = [k + (s - (len(scenes) - 1) / 2) * width for k in range(len(sets))]
        axes.bar(places, [rays[scene].get(key, 0.0) for _, key in sets], width, label=scene)
    for k, (name, _) in enumerate(sets):
        if name in FLOORS:
            axes.plot([k - 0.45, k + 0.45], [FLOORS[name]] * 2, color="black", linewidth=1.5)
    axes.axhline(1.0, color="grey", linewidth=0.5)
    axes.set_xticks(range(len(sets)), [name.replace("_", "\n") for name, _ in sets])
    axes.set_ylabel("times as fast as Embree")
    axes.set_title("Rays (black: what must be reached)")
    axes.legend(fontsize="small")


def draw_map(axes, photon_map):
    names = list(photon_map)
    for s, step in enumerate(("build", "gather")):
        places = [k + (s - 0.5) * 0.4 for k in range(len(names))]
        axes.bar(places, [photon_map[name][f"{step}_vs_cpp"] for name in names], 0.4, label=step)
        for place in places:
            axes.plot([place - 0.2, place + 0.2], [FLOORS[step]] * 2, color="black", linewidth=1.5)
    axes.axhline(1.0, color="grey", linewidth=0.5)
    axes.set_xticks(range(len(names)), names)
    axes.set_ylabel("times as fast as C++")
    axes.set_title("Photon map")
    axes.legend(fontsize="small")


def draw_pass(axes, figures):
    groups = kernel_groups(figures)
    stages = sorted(figures["pass"]["stages"].items(), key=lambda item: item[1])[-16:]
    colours = [GROUP_COLOURS.get(groups.get(kernel, ""), OVERHEAD_COLOUR) for kernel, _ in stages]
    axes.barh([kernel for kernel, _ in stages], [1e3 * seconds for _, seconds in stages], color=colours)
    axes.tick_params(axis="y", labelsize="small")
    axes.set_xlabel("ms a pass")
    axes.set_title(f"Pass: {1e3 * figures['pass']['seconds']:.0f} ms, overhead "
                   f"{100 * figures['pass']['overhead_share']:.1f} %")
    for group, colour in {**GROUP_COLOURS, "overhead": OVERHEAD_COLOUR}.items():
        axes.barh([stages[0][0]], [0], color=colour, label=group)
    axes.legend(fontsize="small", loc="lower right")


def draw_growth(axes, growth):
    for key, cost, label in (("photons", "cpu_ns_per_photon", "ns of one core a photon"),
                             ("pixels", "ns_per_pixel", "ns a pixel"),
                             ("triangles", "build_ns_per_triangle", "ns a triangle, build")):
        entries = growth.get(key, [])
        axes.plot([e[key] for e in entries], [e[cost] for e in entries], marker="o", label=label)
    axes.set_xscale("log")
    axes.set_ylim(bottom=0.0)
    axes.set_xlabel("photons, pixels, triangles")
    axes.set_title("Growth: flat is linear")
    axes.legend(fontsize="small")


def draw(figures, picture):
    try:
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
    except ImportError:
        print("profile_throughput: no plot, matplotlib is not installed (scripts/setup --plots installs it)",
              file=sys.stderr)
        return
    panels = [("rays", lambda axes: draw_rays(axes, figures["rays"])),
              ("photon_map", lambda axes: draw_map(axes, figures["photon_map"])),
              ("pass", lambda axes: draw_pass(axes, figures)),
              ("growth", lambda axes: draw_growth(axes, figures["growth"]))]
    panels = [panel for key, panel in panels if key in figures]
    if not panels:
        print("profile_throughput: no plot, nothing that was measured has one", file=sys.stderr)
        return
    columns = min(2, len(panels))
    rows = (len(panels) + columns - 1) // columns
    figure, grid = pyplot.subplots(rows, columns, figsize=(7.0 * columns, 4.8 * rows), squeeze=False)
    for axes in grid.flat[len(panels):]:
        axes.remove()
    for panel, axes in zip(panels, grid.flat):
        panel(axes)
    machine = figures["machine"]
    figure.suptitle(f"{machine['processor']}, {machine['threads']} threads; {machine['platform']} {machine['driver']}",
                    fontsize="medium")
    figure.tight_layout()
    figure.savefig(picture, dpi=120)
    print(f"wrote {picture}")


def main():
    options, passed_through = parse_arguments()
    figures_file = options.plot_only
    try:
        if figures_file is None:
            if any(word == "--json" or word.startswith("--json=") for word in passed_through):
                sys.exit("profile_throughput: use --out PREFIX in place of --json")
            figures_file = options.out + ".json"
            program = build(options.build_dir.resolve())
            subprocess.run([program, *passed_through, "--json", os.path.abspath(figures_file)], check=True)
            print(f"\nwrote {figures_file}")
        with open(figures_file, encoding="utf-8") as file:
            figures = json.load(file)
    except subprocess.CalledProcessError as error:
        sys.exit(error.returncode if error.returncode > 0 else 1)
    except (OSError, json.JSONDecodeError) as error:
        sys.exit(f"profile_throughput: {error}")
    draw(figures, options.out + ".png")


if __name__ == "__main__":
    main()
