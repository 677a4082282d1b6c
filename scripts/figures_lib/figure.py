"""What the figures' modules share. A module has KEYS, jobs(settings) and report(run), which gives page.Sections."""

import dataclasses
import pathlib

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

from figures_lib import page, scenes  # noqa: E402
from figures_lib.renders import Job  # noqa: E402

TABLES = pathlib.Path(__file__).resolve().parent.parent.parent / "tables"
MODELS = ("paper", "conserving")
GREEN, RED, VIOLET = "#2a9d4b", "#c8324b", "#6a4bc8"


@dataclasses.dataclass
class Run:
    """settings: Settings; results: of all jobs, by name; folder: of the page; stokes: the program."""

    settings: object
    results: dict
    folder: pathlib.Path
    stokes: pathlib.Path

    def picture(self, name, caption):
        """A render for the page."""
        return page.Picture(page.keep(self.results[name], self.folder, name), caption)

    def plot(self, name, figure, caption, wide=True):
        """A plot for the page."""
        file = self.folder / "plots" / f"{name}.png"
        file.parent.mkdir(exist_ok=True)
        figure.savefig(file, dpi=110)
        pyplot.close(figure)
        return page.Picture(file, caption, rendered=False, wide=wide)


def axes(columns=1, width=6.4, height=4.0):
    return pyplot.subplots(1, columns, figsize=(width * columns, height), constrained_layout=True)


def base(name, settings):
    """scenes/NAME.json, by the paper's plain samplers, its radius suited to the photons."""
    scene = scenes.load(name)
    scene["render"]["sampling"] = "plain"
    if "radius_mm" in scene["render"]:
        scene["render"]["radius_mm"] *= settings.radius_scale
    return scene


def job(settings, name, scene, **changes):
    """A Job with the settings' passes, photons and size."""
    return Job(
        **{
            **dict(name=name, scene=scene, passes=settings.passes, photons=settings.photons, size=settings.size),
            **changes,
        }
    )


def exposure_of(name):
    """The exposure of an earlier job."""
    return lambda results: results[name].exposure_ev


def radius_note(result):
    return f"{result.stats['radius_last_mm']:.2f} mm"
