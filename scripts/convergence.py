#!/usr/bin/env python3
"""Measures how fast pictures converge with each sampler, beside the plain method.

Usage: scripts/convergence.py [SCENE..] [--quick] [-o FOLDER] ..
SCENE is the name of one in scenes/ or a scene file; default: prisms masks sectors glow sphere.
Writes FOLDER/convergence.json and FOLDER/convergence.png, and prints tables. What the numbers are:
scripts/README.md. A render that is there already for the same scene, settings and program is not made
again, so an interrupted run goes on where it was.
Needs python3-matplotlib (scripts/setup --plots; exit code 77 without it) and a build.
"""

import argparse
import dataclasses
import json
import math
import pathlib
import signal
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
sys.dont_write_bytecode = True

try:
    from convergence_lib import analysis, drawing, plan, samplers
    from figures_lib import page, scenes
    from figures_lib.renders import Renderer
except ImportError as missing:
    print(f"convergence: {missing}; scripts/setup --plots installs what is needed", file=sys.stderr)
    sys.exit(77)


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="SCENE", help="default: " + " ".join(plan.DEFAULT_SCENES))
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--quick", action="store_true", help="small pictures, plain and best alone, within two minutes")
    size.add_argument("--tiny", action="store_true", help="only to see that everything runs")
    parser.add_argument(
        "-o", "--output", type=pathlib.Path, metavar="FOLDER", help="default: build/convergence or .._quick"
    )
    parser.add_argument("--stokes", type=pathlib.Path, default=ROOT / "build/stokes", metavar="PROGRAM")
    parser.add_argument("--samplers", metavar="NAMES", help="beside plain, such as best,wavelengths; default: all")
    parser.add_argument("--transport", choices=("paper", "conserving", "walk"), help="in place of the scenes' own")
    parser.add_argument(
        "--truth",
        choices=("merged", "walk"),
        default="merged",
        help="plain and best merged, or walks, whose difference from the scene's model then counts as error",
    )
    parser.add_argument(
        "--pairs",
        metavar="NAMES",
        help="scattering against none, of prisms,masks; default: both with the default scenes, not in --quick",
    )
    parser.add_argument(
        "--sources", action=argparse.BooleanOptionalAction, help="the error by source; default: but for --quick"
    )
    parser.add_argument("--seeds", type=positive, metavar="N", help="all of them, however long it takes")
    for name in ("passes", "photons", "truth-passes"):
        parser.add_argument(f"--{name}", type=positive, metavar="N")
    parser.add_argument("--threads", type=positive, metavar="N", help="CPU threads of stokes")
    return parser.parse_args()


# What scattering costs, and where the error comes from, is asked of these alone.
TWO = (samplers.PLAIN, samplers.BEST)


def positive(text):
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"expected a number from 1 on, got {text}")
    return value


def fail(message, code=2):
    print(f"convergence: {message}", file=sys.stderr)
    sys.exit(code)


def chosen_size(options):
    size = plan.TINY if options.tiny else plan.QUICK if options.quick else plan.FULL
    given = {name: getattr(options, name) for name in ("passes", "photons", "seeds", "truth_passes")}
    size = dataclasses.replace(size, **{name: value for name, value in given.items() if value})
    if options.seeds:
        size = dataclasses.replace(size, limit_s=math.inf)
    if size.passes < 4 or size.passes & (size.passes - 1):
        fail(f"--passes: expected a power of two from 4 on, got {size.passes}")
    if size.seeds < plan.LEAST_SEEDS:
        fail(f"--seeds: expected {plan.LEAST_SEEDS} at least, got {size.seeds}")
    return size


def chosen_samplers(options):
    found, left_out = samplers.available(samplers.known_flags(options.stokes))
    for name in left_out:
        print(f"note: {options.stokes} knows no sampler {name}: left out")
    names = [samplers.BEST] if options.quick else [name for name in found if name != samplers.PLAIN]
    if options.samplers is not None:
        names = [name.strip() for name in options.samplers.split(",") if name.strip()]
    unknown = [name for name in names if name not in found]
    if unknown:
        fail(f"--samplers: expected some of {','.join(found)}, got {','.join(unknown)}")
    return found, [samplers.PLAIN] + [name for name in names if name != samplers.PLAIN]


def chosen_cases(options, size):
    cases = []
    for word in options.scenes or plan.DEFAULT_SCENES:
        path = pathlib.Path(word) if word.endswith(".json") else scenes.SCENES / f"{word}.json"
        try:
            cases.append(plan.Case(path.stem, scenes.load_file(path), size, options.transport))
        except (OSError, json.JSONDecodeError) as error:
            fail(f"{word}: {error}")
    names = [case.name for case in cases]
    if len(set(names)) < len(names):
        fail(f"expected scenes of different names, got {' '.join(names)}")
    return cases


def chosen_pairs(options, size):
    """Name -> (case with scattering, case without)."""
    every = plan.scattering_pairs()
    names = [] if options.quick or options.scenes else list(every)
    if options.pairs is not None:
        names = [name.strip() for name in options.pairs.split(",") if name.strip()]
    unknown = [name for name in names if name not in every]
    if unknown:
        fail(f"--pairs: expected some of {','.join(every)}, got {','.join(unknown)}")

    def cases(name):
        words = (f"{name} with", f"{name} without")
        return tuple(plan.Case(word, scene, size, options.transport) for word, scene in zip(words, every[name]))

    return {name: cases(name) for name in names}


class Measurement:
    """What has been rendered, by case and sampler; the pairs' cases have the samplers of TWO alone."""

    def __init__(self, options, size, known, names, folder):
        self.known, self.names, self.folder = known, names, folder
        self.walk = options.truth == "walk"
        self.renderer = Renderer(options.stokes, folder / "renders", options.threads)
        self.radii, self.truths, self.curves, self.twice = {}, {}, {}, {}

    def prepare(self, cases):
        """Radii and truths."""
        parts = {}
        for case in cases:
            radius = self.radii[case.name] = case.first_radius(self.renderer, self.known[samplers.PLAIN])
            parts[case.name] = case.truth_jobs(self.known, radius, self.walk)
        results = self.renderer.run([job for case in parts.values() for part in case for job in part])
        for case in cases:
            case.truth_file = (self.folder / f"truth_{case.name.replace(' ', '_')}.exr").resolve()
            of_case = [[results[job.name] for job in part] for part in parts[case.name]]
            self.truths[case.name] = analysis.Truth(plan.merge(of_case, case.truth_file))

    def round(self, cases, pair_cases, number, with_sources):
        """One more seed of every sampler, in another order each time."""
        seed, shift = plan.FIRST_SEED + number, number % len(self.names)
        jobs = []  # where the result belongs, and the job
        for case in cases + pair_cases:
            radius = self.radii[case.name]
            for name in self.names[shift:] + self.names[:shift]:
                sampler = self.known[name]
                if not sampler.suits(case.transport) or (case in pair_cases and name not in TWO):
                    continue
                jobs.append((self.curves, case.name, name, case.curve_job(sampler, seed, radius)))
                if with_sources and case in cases and name in TWO:
                    jobs.append((self.twice, case.name, name, case.twice_job(sampler, seed, radius)))
        results = self.renderer.run([job for *_, job in jobs])
        for where, case_name, name, job in jobs:
            where.setdefault(case_name, {}).setdefault(name, []).append(results[job.name])

    def curves_of(self, case):
        return {name: analysis.Curves(results) for name, results in self.curves[case.name].items()}

    def numbers(self, case):
        """All samplers of a case, plain first."""
        curves, truth = self.curves_of(case), self.truths[case.name]
        found = analysis.of_scene({name: curves[name] for name in self.names if name in curves}, truth)
        for name, results in self.twice.get(case.name, {}).items():
            found[name]["sources"] = analysis.sources(curves[name], results, truth, self.known[name].independent)
        return found


def scattering(measurement, pairs):
    """Passes for equal relative error, with subsurface scattering over without, by pair and sampler."""
    found = {}
    for name, (with_it, without) in pairs.items():
        a, b = (measurement.curves_of(case) for case in (with_it, without))
        truth_a, truth_b = (measurement.truths[case.name] for case in (with_it, without))
        for sampler in a:
            (ratio, error), *_ = analysis.against(a[sampler], b[sampler], truth_a, truth_b, "whole")
            entry = {"passes_ratio": ratio, "passes_ratio_error": error}
            for word, curves, truth in (("with", a, truth_a), ("without", b, truth_b)):
                entry[word] = analysis.curve(curves[sampler], truth, "whole")
            found.setdefault(name, {})[sampler] = entry
    return found


def plus(numbers, name, digits=2):
    value, error = numbers[name], numbers[name + "_error"]
    return f"{value:.{digits}f} ± {error:.{digits}f}"


def print_tables(found, pairs):
    heads = f"{'efficiency':>17} {'passes ratio':>17} {'time a pass':>13} {'bias':>6}  slope"
    print(f"\n{'scene':12} {'sampler':12} {heads}")
    for scene, samplers_of in found.items():
        for name, n in samplers_of.items():
            beside = f"{'1':>17} {'1':>17} {'1':>13} {'':>6}"
            if name != samplers.PLAIN:
                beside = f"{plus(n, 'efficiency'):>17} {plus(n, 'passes_ratio'):>17} {plus(n, 'time_ratio'):>13} "
                beside += f"{'-':>6}" if n["bias_sigma"] is None else f"{n['bias_sigma']:>6.2f}"
            print(f"{scene:12} {name:12} {beside}  {plus(n, 'slope')}")
        if any(math.isnan(n["slope_error"]) for n in samplers_of.values()):
            print(f"note: {scene}: the truth is too uncertain beside the curves: more --truth-passes")
    for scene, samplers_of in pairs.items():
        for name, n in samplers_of.items():
            print(f"{scene:12} {name:12} passes with scattering over without: {plus(n, 'passes_ratio')}")
    shown = False
    for scene, samplers_of in found.items():
        for name, n in samplers_of.items():
            if "sources" not in n:
                continue
            if n["sources"] is None:
                print(f"note: {scene}, {name}: photons are not among those of twice as many; no split by source")
                continue
            if not shown:
                print(f"\n{'share of the MSE by source':40} {'wavelengths, camera':>20} {'photons':>16} {'kernel':>16}")
                shown = True
            for layer, s in n["sources"].items():
                columns = (plus(s, key) for key in ("wavelengths_and_camera", "photons", "kernel"))
                print("{:12} {:12} {:14} {:>20} {:>16} {:>16}".format(scene, name, layer, *columns))


def interrupt(*_):
    raise KeyboardInterrupt


def measure(options, size, folder):
    start = time.monotonic()
    known, names = chosen_samplers(options)
    cases = chosen_cases(options, size)
    for case in cases:
        unsuited = [name for name in names if not known[name].suits(case.transport)]
        if unsuited:
            print(f"note: {case.name}: transport {case.transport} has no {', '.join(unsuited)}")
    with_sources = options.sources if options.sources is not None else not options.quick
    pairs = chosen_pairs(options, size)
    pair_cases = [case for pair in pairs.values() for case in pair]
    measurement = Measurement(options, size, known, names, folder)
    measurement.prepare(cases + pair_cases)
    seeds, longest_s = 0, 0.0
    for number in range(size.seeds):
        begin = time.monotonic()
        if seeds >= plan.LEAST_SEEDS and begin - start + longest_s > size.limit_s:
            print(f"note: {seeds} of {size.seeds} seeds: the time is up")
            break
        measurement.round(cases, pair_cases, number, with_sources)
        seeds += 1
        longest_s = max(longest_s, time.monotonic() - begin)
    found = {case.name: measurement.numbers(case) for case in cases}
    truths = {case.name: measurement.truths[case.name].numbers() for case in cases}
    compared = scattering(measurement, pairs)
    version = subprocess.run([str(options.stokes), "--version"], capture_output=True, text=True, check=True)
    numbers = {"settings": {**dataclasses.asdict(size), "seeds": seeds, "stokes": version.stdout.strip()}}
    numbers["settings"]["limit_s"] = None if math.isinf(size.limit_s) else size.limit_s
    for case in cases:
        width, height = case.pixels
        about = {"transport": case.transport, "width": width, "height": height, "truth": truths[case.name]}
        about["radius_first_mm"] = measurement.radii[case.name]
        about["radius_last_mm"] = case.last_radius(measurement.radii[case.name])
        about["radius_of_truth_mm"] = case.truth_radius(measurement.radii[case.name])
        numbers[case.name] = {"about": about, **found[case.name]}
    if compared:
        numbers["scattering_over_none"] = compared
    unfinished = folder / "convergence.json.tmp"
    unfinished.write_text(json.dumps(page.finite(numbers), indent=1) + "\n", encoding="utf-8")
    unfinished.replace(folder / "convergence.json")
    drawing.draw({name: (found[name], truths[name]) for name in found}, folder / "convergence.png")
    print_tables(found, compared)
    print(f"\n{folder / 'convergence.json'}   {time.monotonic() - start:.0f} s")


def main():
    options = parse_arguments()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, interrupt)
    if not options.stokes.exists():
        fail(f"{options.stokes}: no such program; scripts/build makes it", 1)
    options.stokes = options.stokes.resolve()
    size = chosen_size(options)
    folder = options.output or ROOT / "build" / ("convergence" if size.name == "full" else f"convergence_{size.name}")
    folder.mkdir(parents=True, exist_ok=True)
    try:
        measure(options, size, folder)
    except subprocess.CalledProcessError as error:
        sys.exit(error.returncode if error.returncode > 0 else 1)
    except KeyboardInterrupt:
        fail("interrupted; the same command goes on from here", 130)


if __name__ == "__main__":
    main()
