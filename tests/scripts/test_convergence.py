"""What scripts/convergence.py measures with, on samples of known statistics, and a run of it at its smallest. Exit code
77 without matplotlib.

Usage: test_convergence.py STOKES FOLDER    FOLDER is emptied first
"""

import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import types
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
sys.dont_write_bytecode = True
try:
    import numpy as np
    import matplotlib  # noqa: F401
except ImportError as missing:
    print(missing, file=sys.stderr)
    sys.exit(77)

from convergence_lib import analysis, drawing, pictures, plan, samplers, statistics  # noqa: E402
from figures_lib import exr, scenes  # noqa: E402

FOLDER = pathlib.Path(sys.argv.pop())
STOKES = pathlib.Path(sys.argv.pop()).resolve()
RGB_OF_XYZ = np.linalg.inv(pictures.XYZ_OF_RGB).T


class Distributions(unittest.TestCase):
    def test_f_has_its_closed_forms(self):
        # Two degrees of freedom above: (1 + 2 f/b)^(-b/2); one and one: Cauchy's distribution, squared.
        for f in (0.03, 0.7, 2.0, 40.0):
            for b in (1.0, 3.5, 12.0):
                self.assertAlmostEqual(statistics.f_exceeded(f, 2, b), (1 + 2 * f / b) ** (-b / 2), places=10)
            self.assertAlmostEqual(statistics.f_exceeded(f, 1, 1), 1 - 2 / math.pi * math.atan(math.sqrt(f)), places=10)

    def test_sigmas_are_those_of_a_normal_variable(self):
        for x in (0.1, 1, 3, 8):
            self.assertAlmostEqual(statistics.sigmas(math.erfc(x / math.sqrt(2))), x, places=8)

    def test_the_least_of_many_is_less_surprising(self):
        self.assertAlmostEqual(statistics.least_of([0.01, 0.5]), 1 - 0.99**2, places=12)
        self.assertEqual(statistics.least_of([]), 1)


class Means(unittest.TestCase):
    def share_below(self, scales, limit, offset=0.0, count=6, trials=1500):
        random, scales = np.random.default_rng(5), np.asarray(scales)
        found = [
            statistics.zero_mean(scales * (random.normal(size=(count, scales.size)) + offset)) for _ in range(trials)
        ]
        return float(np.mean(np.array(found) < limit))

    def test_one_value_is_student_t(self):
        self.assertAlmostEqual(self.share_below([3.0], 0.05), 0.05, delta=0.02)

    def test_samples_of_mean_zero_are_seldom_suspected(self):
        for scales in (np.ones(3), np.ones(300), [10, 5, *np.ones(300)], 1 / np.sqrt(np.arange(1, 300))):
            self.assertLess(self.share_below(scales, 0.05), 0.07)

    def test_a_mean_of_its_own_is_found(self):
        self.assertGreater(self.share_below(np.ones(300), 0.003, offset=1.0, trials=200), 0.95)

    def test_variance_of_a_mean_is_taken_off_without_bias(self):
        random = np.random.default_rng(6)
        squares = [statistics.own_square(0.3 + random.normal(size=(4, 50))) for _ in range(2000)]
        self.assertAlmostEqual(float(np.mean(squares)), 0.09, delta=4 * float(np.std(squares)) / math.sqrt(2000))

    def test_the_error_of_that_variance_fits_both_kinds_of_noise(self):
        random = np.random.default_rng(7)
        for common, own in ((1.0, 0.0), (0.0, 1.0)):
            misses, errors = [], []
            for _ in range(1500):
                samples = common * random.normal(size=(4, 1)) + own * random.normal(size=(4, 400))
                variance, error = statistics.variance_of_mean(samples)
                misses.append(variance - np.mean(samples.mean(axis=0) ** 2))
                errors.append(error)
            self.assertAlmostEqual(float(np.mean(misses)), 0, delta=4 * np.std(misses) / math.sqrt(1500))
            self.assertAlmostEqual(float(np.sqrt(np.mean(np.square(errors))) / np.std(misses)), 1, delta=0.35)

    def test_jackknife_of_a_mean(self):
        values = np.random.default_rng(8).normal(size=9)
        mean, error = statistics.jackknife(lambda chosen: [values[chosen].mean()], 9)
        self.assertAlmostEqual(mean[0], values.mean())
        self.assertAlmostEqual(error[0], values.std(ddof=1) / 3)

    def test_blocks_at_the_border_are_smaller(self):
        image = np.arange(5 * 7 * 3, dtype=float).reshape(5, 7, 3)
        found = pictures.blocks(image, 4)
        self.assertEqual(found.shape, (4, 3))
        np.testing.assert_allclose(found[0], image[:4, :4].mean(axis=(0, 1)))
        np.testing.assert_allclose(found[3], image[4:, 4:].mean(axis=(0, 1)))


SHAPE = (24, 32, 3)
PASSES = 2 ** np.arange(7)
LIGHT = 2 + np.sin(np.arange(np.prod(SHAPE)) / 50).reshape(SHAPE)


class Synthetic:
    """Renders of LIGHT in every layer: a kernel's error, light of the whole picture that varies by seed (wavelengths)
    and grain (photons), whose variances fall as the passes."""

    def __init__(self, seed, kernel=0.0, common=0.3, grain=1.0, offset=0.0, seconds=1.0):
        self.random = np.random.default_rng(seed)
        self.kernel, self.common, self.grain, self.offset, self.seconds = kernel, common, grain, offset, seconds

    def image(self, passes, shared=None, photons=1):
        shared = self.random.normal() if shared is None else shared
        noise = self.common * shared * LIGHT + self.grain / math.sqrt(photons) * self.random.normal(size=SHAPE)
        return LIGHT + noise / math.sqrt(passes) + self.kernel / math.sqrt(passes) + self.offset

    def curves(self, truth, seeds):
        found = analysis.Curves([])
        found.passes = PASSES
        images = [[self.image(n) for n in PASSES] for _ in range(seeds)]
        square = np.array([[np.mean((i - truth.images["whole"]) ** 2) for i in seed] for seed in images])
        found.square = {layer: square for layer in pictures.LAYERS}
        found.images = [{layer: seed[-1] for layer in pictures.LAYERS} for seed in images]
        found.processor_s = found.wall_s = np.full(seeds, self.seconds)
        found.seconds = self.seconds * PASSES / PASSES[-1]
        return found


class NoFiles(analysis.Curves):
    def __init__(self, _):
        pass


def truth_of(count=4, passes=256):
    renders = Synthetic(99)
    image = [renders.image(passes) @ RGB_OF_XYZ for _ in range(count)]
    return analysis.Truth([{layer: one for layer in pictures.LAYERS.values()} for one in image])


class Analysis(unittest.TestCase):
    def setUp(self):
        self.files, analysis.Curves = analysis.Curves, NoFiles
        self.truth = truth_of()

    def tearDown(self):
        analysis.Curves = self.files

    def test_the_error_and_the_slope_are_those_of_the_renders(self):
        curves = Synthetic(1).curves(self.truth, 12)
        found = analysis.curve(curves, self.truth, "whole")
        self.assertAlmostEqual(found["slope"], -0.5, delta=min(0.1, 4 * found["slope_error"]))
        expected = math.sqrt((1 + 0.09 * np.mean(LIGHT**2)) / PASSES[-1]) / np.mean(LIGHT)
        self.assertAlmostEqual(found["relative_rmse"][-1], expected, delta=4 * found["relative_rmse_error"][-1])
        self.assertLess(found["relative_rmse_error"][-1], 0.2 * expected)

    def test_efficiency_counts_error_and_time(self):
        plain = Synthetic(1, common=0, grain=2).curves(self.truth, 6)
        other = Synthetic(2, common=0, grain=1, seconds=1.6).curves(self.truth, 6)
        found = analysis.efficiency(plain, other, self.truth, "whole")
        self.assertAlmostEqual(found["passes_ratio"], 4, delta=max(0.1, 4 * found["passes_ratio_error"]))
        self.assertAlmostEqual(found["efficiency"], 4 / 1.6, delta=max(0.1, 4 * found["efficiency_error"]))
        self.assertAlmostEqual(found["time_ratio"], 1.6)
        self.assertLess(found["efficiency_error"], 0.5)

    def test_bias_is_found_where_it_is_and_nowhere_else(self):
        plain = Synthetic(1).curves(self.truth, 8)
        same = Synthetic(2, common=0.1).curves(self.truth, 8)
        self.assertLess(analysis.bias(plain, same, self.truth)["bias_sigma"], 3)
        bright = Synthetic(3, common=0.1, offset=0.5).curves(self.truth, 8)
        self.assertGreater(analysis.bias(plain, bright, self.truth)["bias_sigma"], 3)
        local = np.zeros(SHAPE)
        local[8:16, 8:16] = 0.3
        found = analysis.bias(plain, Synthetic(4, offset=local).curves(self.truth, 8), self.truth)
        self.assertGreater(found["bias_sigma"], 3)
        self.assertGreater(found["bias"]["whole"]["blocks_sigma"], found["bias"]["whole"]["mean_sigma"])

    def test_the_kernel_is_no_bias_of_a_sampler(self):
        plain, other = (Synthetic(s, kernel=2.0).curves(self.truth, 8) for s in (1, 2))
        self.assertLess(analysis.bias(plain, other, self.truth)["bias_sigma"], 3)

    def test_sources_are_told_apart(self):
        seeds, passes = 60, PASSES[-1]
        renders = Synthetic(5, kernel=1.5)
        curves = renders.curves(self.truth, 2)
        curves.images, twice = [], []
        for _ in range(seeds):
            shared = renders.random.normal()
            halves = [renders.image(passes, shared) for _ in range(2)]
            curves.images.append({layer: halves[0] for layer in pictures.LAYERS})
            layers = {layer: np.mean(halves, axis=0) @ RGB_OF_XYZ for layer in pictures.LAYERS.values()}
            twice.append(types.SimpleNamespace(picture=lambda layers=layers: exr.Picture(layers, {})))
        curves.processor_s = np.ones(seeds)
        found = analysis.sources(curves, twice, self.truth, True)["whole"]
        dependent = analysis.sources(curves, twice, self.truth, False)["whole"]
        parts = {"wavelengths_and_camera": 0.09 * np.mean(LIGHT**2), "photons": 1.0, "kernel": 1.5**2}
        for name, part in parts.items():
            error = found[name + "_error"]
            self.assertLess(error, 0.1)
            self.assertAlmostEqual(found[name], part / sum(parts.values()), delta=4 * error, msg=name)
            error = dependent[name + "_error"]
            self.assertLess(error, 0.2)
            self.assertAlmostEqual(dependent[name], part / sum(parts.values()), delta=4 * error, msg=name)
        for one in twice:  # other photons than those of the first render
            one.picture = lambda: exr.Picture({k: 0.1 * LIGHT @ RGB_OF_XYZ for k in pictures.LAYERS.values()}, {})
        self.assertIsNone(analysis.sources(curves, twice, self.truth, True))
        self.assertIsNotNone(analysis.sources(curves, twice, self.truth, False))


class Plan(unittest.TestCase):
    def test_samplers_that_the_program_has_not_are_left_out(self):
        known = samplers.known_flags(STOKES)
        self.assertEqual(known["--wavelengths"], ("paper", "conserving", "walk"))
        self.assertNotIn("--nothing", known)
        found, left_out = samplers.available({flag: known[flag] for flag in ("--sampling", "--wavelengths")})
        self.assertEqual(list(found), ["plain", "best", "wavelengths"])
        self.assertEqual(found["best"].flags("paper"), ("--sampling", "best", "--wavelengths", "importance"))
        self.assertEqual(found["wavelengths"].flags("paper"), ("--sampling", "plain", "--wavelengths", "importance"))
        self.assertEqual(set(left_out), {s.name for s in samplers.SINGLE} - {"wavelengths"})
        found, left_out = samplers.available({flag: known[flag] for flag in ("--sampling", "--wavelengths", "--radii")})
        self.assertEqual(list(found), ["plain", "best", "wavelengths", "radii"])
        self.assertEqual(found["best"].flags("paper"), ("--sampling", "best", "--wavelengths", "importance"))
        self.assertEqual(samplers.OTHER_KERNEL, {"radii"})

    def test_models_get_the_flags_that_they_take(self):
        known = samplers.known_flags(STOKES)
        found, _ = samplers.available({flag: known[flag] for flag in ("--sampling", "--branches", "--distances")})
        best = found["best"]
        self.assertEqual(best.flags("walk"), ("--sampling", "best"))
        self.assertEqual(best.flags("conserving"), ("--sampling", "best", "--branches", "both"))
        self.assertEqual(best.flags("paper")[-2:], ("--distances", "importance"))
        suited = {t: [name for name in found if found[name].suits(t)] for t in known["--sampling"]}
        self.assertEqual(suited["walk"], ["plain", "best"])
        self.assertEqual(suited["conserving"], ["plain", "best", "branches"])
        self.assertEqual(suited["paper"], list(found))
        every = list(samplers.available(known)[0])
        colours = drawing.colours_of({"a": (dict.fromkeys(every[2:]), {}), "b": (dict.fromkeys(every), {})})
        self.assertEqual(len(set(colours.values())), len(every))
        scene = scenes.load("sphere")
        job = plan.Case("sphere", scene, plan.TINY).job("x", best, 4, 1, (), transport="walk")
        self.assertNotIn("--branches", job.flags)

    def test_the_last_radius_is_the_renderers(self):
        scene = scenes.change(scenes.load("sphere"), {"render": {"radius_mm": 5.0}})
        case = plan.Case("sphere", scene, plan.TINY)
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "s.json").write_text(json.dumps(scene))
            subprocess.run(
                [STOKES, "render", folder / "s.json", "--passes", str(plan.TINY.passes), "--photons", "500", "--size"]
                + ["8x6", "--quiet", "--stats", folder / "t.json"],
                check=True,
            )
            stats = json.loads((folder / "t.json").read_text())
        self.assertAlmostEqual(case.last_radius(5.0), stats["radius_last_mm"], places=6)
        self.assertGreater(stats["processor_s"], 0)

    def test_pairs_differ_in_scattering_alone(self):
        for with_it, without in plan.scattering_pairs().values():
            self.assertEqual(with_it["lights"], without["lights"])
            self.assertEqual(len(with_it["shapes"]), len(without["shapes"]))

            def media(scene):
                used = {shape["material"] for shape in scene["shapes"]}
                materials = [scene["materials"][name] for name in used]
                return [material.get("medium") for material in materials if "fluorophore" in material]

            self.assertTrue(all(media(with_it)))
            self.assertFalse(any(media(without)))


class Script(unittest.TestCase):
    def run_script(self, *more):
        words = [sys.executable, ROOT / "scripts/convergence.py", "--tiny", "--stokes", STOKES, "-o", FOLDER, *more]
        return subprocess.run([str(word) for word in words], capture_output=True, text=True)

    def test_measures_and_goes_on_from_what_is_there(self):
        shutil.rmtree(FOLDER, ignore_errors=True)
        done = self.run_script("sphere", "--pairs", "masks", "--samplers", "best")
        self.assertEqual(done.returncode, 0, done.stderr)
        numbers = json.loads((FOLDER / "convergence.json").read_text(encoding="utf-8"))
        best = numbers["sphere"]["best"]
        for name in ("efficiency", "efficiency_error", "passes_ratio", "passes_ratio_error", "bias_sigma", "slope"):
            self.assertIn(name, best)
        self.assertGreaterEqual(best["bias_sigma"], 0)
        self.assertGreater(best["time_ratio"], 0)
        self.assertEqual(best["layers"]["whole"]["passes"], [1, 2, 4, 8])
        self.assertGreater(numbers["sphere"]["plain"]["layers"]["whole"]["relative_rmse"][0], 0)
        shares = numbers["sphere"]["plain"]["sources"]["whole"]
        self.assertAlmostEqual(sum(shares[k] for k in ("wavelengths_and_camera", "photons", "kernel")), 1)
        self.assertIn("passes_ratio", numbers["scattering_over_none"]["masks"]["best"])
        self.assertEqual(numbers["sphere"]["about"]["transport"], "conserving")
        self.assertTrue((FOLDER / "convergence.png").is_file())
        kept = {file: file.stat().st_mtime_ns for file in (FOLDER / "renders").glob("*.exr")}
        again = self.run_script("sphere", "--samplers", "best")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(kept, {file: file.stat().st_mtime_ns for file in (FOLDER / "renders").glob("*.exr")})

    def test_what_is_wrong_is_said(self):
        for words, expected in (
            (("--samplers", "worst"), "--samplers: expected some of plain,best"),
            (("nowhere",), "nowhere: "),
            (("sphere", "sphere"), "expected scenes of different names"),
            (("--passes", "12"), "--passes: expected a power of two"),
            (("--pairs", "sphere"), "--pairs: expected some of prisms,masks"),
            (("--seeds", "1"), "--seeds: expected 2 at least"),
        ):
            done = self.run_script(*words)
            self.assertEqual(done.returncode, 2)
            self.assertIn(expected, done.stderr)


if __name__ == "__main__":
    unittest.main()
