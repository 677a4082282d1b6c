"""What scripts/figures measures with: pictures of known content, curves of known slope. Exit code 77 without NumPy.

Usage: test_figures_lib.py STOKES
"""

import json
import pathlib
import subprocess
import sys
import tempfile
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

from figures_lib import (
    camera,
    exr,
    figure_masks,
    figure_sectors,
    figure_tiles,
    measure,
    page,  # noqa: E402
    renders,
    scenes,
)

STOKES = pathlib.Path(sys.argv.pop(1)).resolve()
EXPONENTIAL_WIDTH = 2 * np.log(5)  # 10-90 % width of a rise exp(x/s)/2, 1 - exp(-x/s)/2, in units of s


def exponential_edge(x, s):
    return np.where(x < 0, 0.5 * np.exp(-np.abs(x) / s), 1 - 0.5 * np.exp(-np.abs(x) / s))


class Edges(unittest.TestCase):
    def test_width_of_a_ramp(self):
        x = np.arange(-8, 8.05, 0.1)
        self.assertAlmostEqual(measure.edge_width(x, np.clip((x + 1.03) / 2.06, 0, 1), 6), 0.8 * 2.06, places=6)

    def test_width_of_exponentials_in_noise(self):
        random = np.random.default_rng(1)
        x, along = random.uniform(-8, 8, 40000), random.uniform(0, 20, 40000)
        light = 3 + 2 * exponential_edge(x, 0.7) + random.normal(0, 0.05, x.size)
        _, _, width, error = measure.edge(x, along, light, 8, 0.2, 6)
        self.assertGreater(error, 0)
        self.assertAlmostEqual(width, EXPONENTIAL_WIDTH * 0.7, delta=max(4 * error, 0.08))

    def test_width_does_not_depend_on_the_level(self):
        x = np.arange(-8, 8.05, 0.1)
        narrow = measure.edge_width(x, 0.001 * exponential_edge(x, 0.5), 6)
        self.assertAlmostEqual(narrow, EXPONENTIAL_WIDTH * 0.5, delta=0.02)

    def test_no_edge_has_no_width(self):
        x = np.arange(-8, 8.05, 0.1)
        self.assertTrue(np.isnan(measure.edge_width(x, np.ones_like(x), 6)))


class Curves(unittest.TestCase):
    def test_slope_of_a_power_law(self):
        passes = 2.0 ** np.arange(11)
        slope, error = measure.slope(passes, 7 * passes**-0.4)
        self.assertAlmostEqual(slope, -0.4, places=9)
        self.assertLess(error, 1e-9)

    def test_the_error_of_the_truth_is_taken_off(self):
        passes, own = 2.0 ** np.arange(11), 5.0
        true = own * passes**-0.35
        seen = np.sqrt(true**2 + (own * 4096**-0.35) ** 2)
        corrected, truth = measure.true_error(passes, seen, 4096)
        self.assertAlmostEqual(truth, own * 4096**-0.35, delta=0.001 * own)
        np.testing.assert_allclose(corrected, true, rtol=0.01)
        self.assertGreater(measure.slope(passes, seen)[0], -0.34)

    def test_passes_for_equal_error(self):
        passes = 2.0 ** np.arange(11)
        shared = np.exp(np.random.default_rng(2).normal(0, 0.4, passes.size))
        ratio, error = measure.pass_ratio(passes, 2 * passes**-0.5, passes**-0.5)
        self.assertAlmostEqual(ratio, 4, places=6)
        self.assertLess(error, 1e-6)
        ratio, error = measure.pass_ratio(passes, 2 * passes**-0.5 * shared, passes**-0.5 * shared)
        self.assertGreater(error, 0.01)
        self.assertAlmostEqual(ratio, 4, delta=4 * error)
        self.assertTrue(np.isnan(measure.pass_ratio(passes, 2 * passes, passes)[0]))

    def test_brightness_and_hue_of_the_whole_are_no_error_of_shape(self):
        random = np.random.default_rng(3)
        truth = random.uniform(0, 1, (20, 30, 3))
        scaled = (truth @ measure.XYZ_OF_RGB.T * [1.3, 0.8, 2]) @ np.linalg.inv(measure.XYZ_OF_RGB).T
        self.assertLess(measure.rmse_of_shape(scaled, truth), 1e-6)
        self.assertGreater(measure.rmse(scaled, truth), 0.1)
        self.assertGreater(measure.rmse_of_shape(truth + random.normal(0, 0.1, truth.shape), truth), 0.05)


class Places(unittest.TestCase):
    def test_a_crop_sees_what_the_whole_sees_there(self):
        whole = scenes.load("sectors")
        close = scenes.change(whole, {"camera.crop": {"left": 0.25, "top": 0.5, "width": 0.5, "height": 0.5}})
        x, z = camera.on_plane(whole, 80, 60, 10)
        close_x, close_z = camera.on_plane(close, 40, 30, 10)
        np.testing.assert_allclose(close_x, x[30:, 20:60], atol=1e-9)
        np.testing.assert_allclose(close_z, z[30:, 20:60], atol=1e-9)

    def test_the_middle_of_the_picture_is_the_target(self):
        x, z = camera.on_plane(scenes.load("sectors"), 3, 3, 10)
        self.assertAlmostEqual(x[1, 1], -8)
        self.assertAlmostEqual(z[1, 1], -8)
        self.assertGreater(z[2, 1], z[0, 1])
        self.assertGreater(x[1, 2], x[1, 0])

    def test_the_edge_of_the_shadow_lies_on_rays_that_graze_the_sphere(self):
        scene = scenes.load("sectors")
        light = np.array(scene["lights"][0]["direction"]) / np.linalg.norm(scene["lights"][0]["direction"])
        across = np.cross(light, [0, 0, 1])
        for offset in (across, -across, np.array([0.0, 0, 1])):
            start = np.array([-35, 60, 0]) + 13 * offset / np.linalg.norm(offset)
            end = start + light * (10 - start[1]) / light[1]
            there = figure_sectors.outside_shadow(scene, np.array([end[0]]), np.array([end[2]]))
            self.assertAlmostEqual(there[0], 0, places=6)

    def test_sectors_go_clockwise_from_the_bottom(self):
        # Places at the bottom, at the left and upward, and at the top right of the picture.
        angle = figure_sectors.clockwise(np.array([0.0, -1, 0.87]), np.array([1.0, -0.5, -0.5]))
        self.assertTrue(figure_sectors.sector(angle[:1], 0)[0])
        self.assertTrue(figure_sectors.sector(angle[1:2], 2)[0])
        self.assertTrue(figure_sectors.sector(angle[2:], 4)[0])

    def test_quantum_dots_are_told_apart(self):
        colours = np.array([[2 * figure_tiles.emission_rgb("545") + 3 * figure_tiles.emission_rgb("655")]])
        green, red = figure_tiles.unmixed(exr.Picture({"": colours, "fluorescence": colours}, {}))
        self.assertAlmostEqual(green[0, 0], 2)
        self.assertAlmostEqual(red[0, 0], 3)

    def test_contrast_of_a_star(self):
        scene = figure_masks.scene(type("S", (), {"radius_scale": 1}), "star", "545", True)
        x, z = camera.on_plane(scene, 300, 300, 0)
        light = np.where(np.cos(24 * np.arctan2(z, x)) > 0, 1.0, 0.0)[..., None] * np.ones(3)
        result = type("R", (), {"scene": scene, "picture": lambda self: exr.Picture({"": light}, {})})()
        periods, contrasts = figure_masks.star_contrast(result)
        np.testing.assert_allclose(contrasts[periods > 2], 1, atol=0.05)


class Files(unittest.TestCase):
    def test_reads_what_stokes_writes_and_renders_once(self):
        scene = scenes.change(scenes.load("sphere"), {"transport": "paper"})
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            jobs = [renders.Job("a", scene, 2, 2048, (19, 37), seed=seed) for seed in (1, 2, 1)]
            first, second = (renders.Renderer(STOKES, folder / "r") for _ in range(2))
            one = first.run(jobs[:1])["a"]
            when = one.exr.stat().st_mtime_ns
            again, other = second.run(jobs[2:])["a"], second.run(jobs[1:2])["a"]
            self.assertEqual(again.exr, one.exr)
            self.assertEqual(again.exr.stat().st_mtime_ns, when)
            self.assertNotEqual(other.exr, one.exr)
            a, b = one.picture(), other.picture()
            self.assertEqual((a.width, a.height), (19, 37))
            self.assertEqual(a.attributes["stokes.passes"], 2)
            np.testing.assert_allclose(sum(v for k, v in a.layers.items() if k), a.rgb, rtol=1e-4, atol=1e-7)
            compared = json.loads(
                subprocess.run(
                    [STOKES, "compare", one.exr, other.exr, "--json"], check=True, capture_output=True, text=True
                ).stdout
            )
            self.assertAlmostEqual(measure.rmse(a.rgb, b.rgb) / compared["layers"]["whole"]["rmse"], 1, places=4)

    def test_fingerprints_follow_values_and_files_but_not_comments(self):
        scene = scenes.load("masks")
        same = dict(scene, comment="another")
        other = scenes.change(scene, {"materials.sheet.fluorescent_fraction": 0.6})
        mask = scenes.change(scene, {"shapes.mask.file": str(scenes.SCENES / "textures/star.png")})
        self.assertEqual(scenes.fingerprint(scene), scenes.fingerprint(same))
        self.assertEqual(len({scenes.fingerprint(s) for s in (scene, other, mask)}), 3)
        self.assertEqual(scene["materials"]["sheet"]["fluorescent_fraction"], 0.5)

    def test_a_page_links_its_pictures_and_escapes_words(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            section = page.Section(
                "figX",
                "Figure X",
                "a < b",
                "m",
                "v",
                [[page.Picture(folder / "p" / "x.png", "c")]],
                {"a": {"b": float("nan")}},
            )
            page.write(folder, "T", [], [section], {"figX": section.numbers})
            text = (folder / "index.html").read_text()
            self.assertIn('src="p/x.png"', text)
            self.assertIn("a &lt; b", text)
            self.assertEqual(json.loads((folder / "figures.json").read_text()), {"figX": {"a": {"b": None}}})


if __name__ == "__main__":
    unittest.main()
