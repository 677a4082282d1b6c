"""Which renders there are, and how large."""

import dataclasses
import math

import numpy as np

from convergence_lib.pictures import LAYERS
from convergence_lib.samplers import BEST, PLAIN
from figures_lib import exr, scenes
from figures_lib.renders import Job


@dataclasses.dataclass(frozen=True)
class Size:
    """passes is a power of two; photons None: the scene's own. truth_passes: of each of the 2 truth_parts renders that
    the truth is the mean of. limit_s: no further seed begins that would take longer."""

    name: str
    passes: int
    photons: object
    pixels: int
    seeds: int
    truth_passes: int
    truth_parts: int
    limit_s: float = math.inf


FULL = Size("full", passes=256, photons=None, pixels=160 * 120, seeds=8, truth_passes=1024, truth_parts=4)
QUICK = Size("quick", 32, 16384, 64 * 48, seeds=4, truth_passes=96, truth_parts=3, limit_s=108)
TINY = Size("tiny", 8, 2048, 16 * 12, seeds=2, truth_passes=8, truth_parts=2)

LEAST_SEEDS = 2
PHOTONS = 262144  # of a scene that does not say
FIRST_SEED, TRUTH_SEED = 1, 100001
# Of the truth, beside the last of the curves: it does not shrink, so that its renders have one expectation.
TRUTH_RADIUS = 0.5
DEFAULT_SCENES = ("prisms", "masks", "sectors", "glow", "sphere")
ROWS = ("front", "back")
COLOURS = {"green": "545", "yellow": "585", "red": "655"}


class Case:
    """A scene as it is measured. transport None: its own."""

    def __init__(self, name, scene, size, transport=None):
        self.name, self.scene, self.size = name, scene, size
        self.transport = transport or scene.get("transport", "conserving")
        film = scene.get("film", {})
        aspect = film.get("width", 640) / film.get("height", 480)
        self.own_photons = scene.get("render", {}).get("photons_per_pass", PHOTONS)
        self.photons = size.photons or self.own_photons
        self.pixels = max(1, round(math.sqrt(size.pixels * aspect))), max(1, round(math.sqrt(size.pixels / aspect)))
        self.truth_file = None  # once there is one

    def job(self, name, sampler, passes, seed, flags, photons=None, transport=None, **more):
        transport = transport or self.transport
        return Job(
            name=f"{self.name} {name}",
            scene=self.scene,
            passes=passes,
            photons=photons or self.photons,
            size=self.pixels,
            transport=transport,
            seed=seed,
            flags=(*sampler.flags(transport), *flags),
            **more,
        )

    def first_radius(self, renderer, plain):
        """Of all curves [mm]: the scene's own; where it has none, what the renderer finds for its own photons."""
        render = self.scene.get("render", {})
        if "radius_mm" in render:
            return render["radius_mm"]
        job = self.job("first radius", plain, 1, FIRST_SEED, (), photons=self.own_photons)
        return renderer.run([job])[job.name].stats["radius_first_mm"]

    def last_radius(self, first):
        """As the renderer has it: r_(n+1)^2 = r_n^2 (n + alpha)/(n + 1)."""
        alpha = self.scene.get("render", {}).get("alpha", 2 / 3)
        n = np.arange(1, self.size.passes)
        return first * math.sqrt(np.prod((n + alpha) / (n + 1)))

    def truth_radius(self, first):
        return TRUTH_RADIUS * self.last_radius(first)

    def truth_jobs(self, samplers, first_radius, walk):
        """Parts of the truth, each a pair of plain and best; with walk, both are walks."""
        flags = ("--radius", repr(self.truth_radius(first_radius)), "--alpha", "1")
        transport = "walk" if walk else None
        return [
            [
                self.job(
                    f"truth {part + 1}, {kind}",
                    samplers[kind],
                    self.size.truth_passes,
                    TRUTH_SEED + 2 * part + (kind == BEST),
                    flags,
                    transport=transport,
                )
                for kind in (PLAIN, BEST)
            ]
            for part in range(self.size.truth_parts)
        ]

    def curve_job(self, sampler, seed, radius):
        flags = ("--radius", repr(radius), "--rmse-against", str(self.truth_file), "--csv", "CURVE")
        return self.job(
            f"{sampler.name}, seed {seed}", sampler, self.size.passes, seed, flags, references=(self.truth_file,)
        )

    def twice_job(self, sampler, seed, radius):
        """The same seed with twice the photons: the first half of them are those of the curve."""
        name = f"{sampler.name}, seed {seed}, twice the photons"
        return self.job(name, sampler, self.size.passes, seed, ("--radius", repr(radius)), photons=2 * self.photons)


def merge(parts, file):
    """Writes the mean of parts, all of as many passes, each a list of Results; returns each part's mean picture as
    layers of Rec. 709."""
    pictures = [[result.picture() for result in part] for part in parts]
    means = [
        {layer: np.mean([picture.layers[layer] for picture in part], axis=0) for layer in LAYERS.values()}
        for part in pictures
    ]
    exr.write(file, {layer: np.mean([mean[layer] for mean in means], axis=0) for layer in LAYERS.values()})
    return means


def scattering_pairs():
    """Name -> (scene with subsurface scattering in all of its fluorescent things, the same without in any)."""
    prisms = scenes.load("prisms")
    with_it, without = {}, {}
    for row in ROWS:
        for colour, dot in COLOURS.items():
            with_it[f"shapes.{row} {colour} prism.material"] = f"qdot{dot} subsurface"
            without[f"shapes.{row} {colour} prism.material"] = f"qdot{dot} surface"
    masks = scenes.load("masks")
    sheet = {"subsurface": False, "fluorescent_fraction": 1, "medium": None}
    bare = scenes.change(masks, {f"materials.sheet.{key}": value for key, value in sheet.items()})
    return {
        "prisms": (scenes.change(prisms, with_it), scenes.change(prisms, without)),
        "masks": (masks, bare),
    }
